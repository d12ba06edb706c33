/** The page as a peer in a browser: it steps the world itself and compares every hash. */
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, openPage, phone, state, until } from './browser.mjs';
import { ask, eventually, startServer, withServer } from './server.mjs';

const pictures = process.env.HUESTEP_PICTURES ?? 'browser-pictures';
let browser;
before(async () => {
  mkdirSync(pictures, { recursive: true });
  browser = await launch();
});
after(() => browser?.close());

const as = (server, session, role) => `${server.url}?session=${session}&as=${role}`;

/** Every tick it has stepped was compared, in order and without a hole, and every hash agreed. */
function assertAgreement(seen, ticks) {
  assert.equal(seen.mismatches, 0);
  assert.equal(seen.difference, '');
  assert.ok(seen.hashesCompared >= ticks, `${seen.hashesCompared} hashes were compared`);
  const first = seen.history[0].tick;
  seen.history.forEach(({ tick }, i) => assert.equal(tick, first + i));
}

test('two pages and bots in one session agree for 3,000 ticks, one page loaded anew', () =>
  withServer({ sandbox: 'sandbox' }, async (server) => {
    server.play('sandbox', 1);
    const steady = await openPage(browser, as(server, 'sandbox', 'spectator'));
    const other = await openPage(browser, as(server, 'sandbox', 'player'), {
      size: phone,
      touch: true,
    });
    await until(steady, (h) => h.hashesCompared > 300 && h.players === 2);
    assert.equal((await state(steady)).lanes, 4);
    await steady.screenshot({ path: join(pictures, 'lockstep.png') });
    await until(other, (h) => h.hashesCompared > 300 && h.player > 0);
    await other.screenshot({ path: join(pictures, 'lockstep-phone.png') });
    assertAgreement(await state(other), 300);
    await other.reload();
    await until(other, (h) => h.hashesCompared > 300);
    await until(steady, (h) => h.hashesCompared >= 3000, 300);
    const seen = await state(steady);
    const seenToo = await state(other);
    assertAgreement(seen, 3000);
    assertAgreement(seenToo, 300);
    assert.match(await steady.textContent('#agreement'), /^(\d+) of \1$/);
    assert.equal(seen.snapshots, 1, 'it has stepped ever since');
    // Where both have been, they have been the same.
    const roots = new Map(seen.history.map(({ tick, root }) => [tick, root]));
    const both = seenToo.history.filter(({ tick }) => roots.has(tick));
    assert.ok(both.length > 100, `${both.length} ticks of both are known`);
    for (const { tick, root } of both) assert.equal(root, roots.get(tick), `tick ${tick}`);
    assert.deepEqual(steady.problems, []);
    assert.deepEqual(other.problems, []);
    await steady.context().close();
    await other.context().close();
    assert.equal(await server.stop(), 0, server.log());
    for (const { tick, root } of [seen.history[0], seen.history.at(-1)]) {
      const replay = ask('replay', join(server.data, 'sandbox'), '--to', String(tick));
      assert.equal(replay.hash.motion, root, `motion root after tick ${tick}`);
    }
  }));

test('a bit that flips in the page is found, named on both ends, and mended', () =>
  withServer({ pile: 'pyramid:base=10' }, async (server) => {
    const page = await openPage(browser, as(server, 'pile', 'spectator'));
    await until(page, (h) => h.hashesCompared > 60);
    await page.evaluate(() => {
      const motions = window.huestep.motions();
      new Uint32Array(motions.buffer, motions.byteOffset, motions.length)[8 * 9 + 5] ^= 1;
    });
    await until(page, (h) => h.difference !== '');
    const { difference } = await state(page);
    assert.match(difference, /^tick \d+: body 10 velocity\.y \S+ here, \S+ at the server$/);
    await page.screenshot({ path: join(pictures, 'lockstep-mended.png') });
    assert.ok((await page.textContent('#difference')).includes(difference));
    const { hashesCompared } = await state(page);
    await until(page, (h) => h.hashesCompared > hashesCompared + 60);
    const seen = await state(page);
    assert.equal(seen.mismatches, 1);
    assert.equal(seen.corrections, 1);
    await eventually('the server tells of it', () => /desync.*velocity\.y/.test(server.log()));
    assert.deepEqual(page.problems, []);
    await page.context().close();
  }));

for (const touch of [false, true]) {
  test(`a player drags a body ${touch ? 'by touch' : 'with the mouse'}`, () =>
    withServer({ play: 'sandbox' }, async (server) => {
      const page = await openPage(browser, as(server, 'play', 'player'), { touch });
      await until(page, (h) => h.player > 0 && h.drawn > 30);
      // Where the player's own body is on the screen, once it lies still.
      let spot = null;
      let still = 0;
      await eventually('its body lies', async () => {
        const before = spot;
        spot = await page.evaluate(() => window.huestep.ownBody());
        const moved = before && spot ? Math.hypot(spot.x - before.x, spot.y - before.y) : 1;
        still = moved < 0.2 ? still + 1 : 0;
        return still >= 10;
      });
      const joints = (await state(page)).joints;
      const { left, top } = await page.locator('#canvas').boundingBox().then((box) => ({
        left: box.x,
        top: box.y,
      }));
      const session = touch ? await page.context().newCDPSession(page) : null;
      const point = { x: left + spot.x, y: top + spot.y };
      const away = { x: point.x + 80, y: point.y - 120 };
      const finger = (type, at) =>
        session.send('Input.dispatchTouchEvent', { type, touchPoints: at ? [at] : [] });
      if (touch) {
        await finger('touchStart', point);
        await finger('touchMove', away);
      } else {
        await page.mouse.move(point.x, point.y);
        await page.mouse.down();
        await page.mouse.move(away.x, away.y, { steps: 8 });
      }
      await until(page, (h) => h.joints === joints + 1);
      const goal = { x: spot.x + 80, y: spot.y - 120 };
      await eventually('the body follows the pointer', async () => {
        const now = await page.evaluate(() => window.huestep.ownBody());
        return Math.hypot(now.x - goal.x, now.y - goal.y) < 40;
      });
      await page.screenshot({ path: join(pictures, touch ? 'drag-touch.png' : 'drag-mouse.png') });
      if (touch) await finger('touchEnd', null);
      else await page.mouse.up();
      await until(page, (h) => h.joints === joints);
      assertAgreement(await state(page), 30);
      assert.deepEqual(page.problems, []);
      await page.context().close();
    }));
}

test('a page whose server stops and starts again steps on', async () => {
  const first = await startServer({ play: 'sandbox' });
  let second;
  try {
    const page = await openPage(browser, as(first, 'play', 'spectator'));
    await until(page, (h) => h.hashesCompared > 60);
    assert.equal(await first.stop(), 0, first.log());
    await until(page, (h) => h.state === 'waiting');
    const { tick } = await state(page);
    second = await startServer(
      { play: 'sandbox' },
      { data: first.data, web: new URL(first.url).host },
    );
    await until(page, (h) => h.state === 'live' && h.tick > tick + 60);
    const seen = await state(page);
    assert.equal(seen.mismatches, 0);
    assert.ok(seen.connections >= 2);
    await page.context().close();
  } finally {
    await first.stop();
    await second?.stop();
    first.forget();
  }
});

test('a page that cannot have a core watches, and says why', () =>
  withServer({ pile: 'pyramid:base=4' }, async (server) => {
    const prepare = (page) => page.route('**/*.wasm', (route) => route.fulfill({ status: 404 }));
    const page = await openPage(browser, as(server, 'pile', 'spectator'), { prepare });
    await until(page, (h) => h.drawn > 30);
    assert.match(await page.textContent('#difference'), /only watches: .* without a core/);
    assert.equal((await state(page)).hashesCompared, 0);
    await page.context().close();
  }));
