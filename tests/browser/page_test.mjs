/** The page in a browser, against a real server. */
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { desktop, launch, openPage, phone, pixels, state, until } from './browser.mjs';
import { ask, eventually, startServer, withServer } from './server.mjs';

const pictures = process.env.HUESTEP_PICTURES ?? 'browser-pictures';
let browser;
before(async () => {
  mkdirSync(pictures, { recursive: true });
  browser = await launch();
});
after(() => browser?.close());

test('the page shows a session that is played, tick by tick, with the hashes of its journal', () =>
  withServer({ sandbox: 'sandbox' }, async (server) => {
    server.play('sandbox', 4);
    const page = await openPage(browser, server.url);
    assert.match(page.url(), /\?session=sandbox$/, 'the only session is chosen by itself');
    await until(page, (h) => h.players === 4 && h.contacts > 0 && h.drawn >= 120);
    const first = await state(page);
    assert.equal(await page.textContent('#state'), 'live');
    assert.match(await page.textContent('#root'), /^[0-9a-f]{16}$/);
    assert.ok(first.looks.player >= 4, 'players are marked');
    assert.ok(
      first.joints >= 14,
      'the rope, the swing, the see-saw and the paddle have their joints',
    );
    await until(page, (h) => h.tick >= first.tick + 60);

    const drawn = await pixels(page, ['canvas', 'awake-fill', 'player-fill', 'static-fill']);
    assert.ok(drawn.colours > 50, `the canvas has ${drawn.colours} colours`);
    for (const look of ['awake-fill', 'player-fill', 'static-fill']) {
      assert.ok(drawn[look] > 100, `${look}: ${drawn[look]} pixels`);
    }
    await page.screenshot({ path: join(pictures, 'desktop-light.png') });
    for (const [name, how] of Object.entries({
      'desktop-dark': { size: desktop, scheme: 'dark' },
      'phone-light': { size: phone, touch: true },
      'phone-dark': { size: phone, touch: true, scheme: 'dark' },
    })) {
      const other = await openPage(browser, server.url, how);
      await until(other, (h) => h.drawn >= 30);
      const wide = await other.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `${name} is ${wide} pixels wider than the screen`);
      await other.screenshot({ path: join(pictures, `${name}.png`) });
      assert.deepEqual(other.problems, []);
      await other.context().close();
    }

    const { history } = await state(page);
    assert.deepEqual(page.problems, []);
    await page.context().close();
    assert.equal(await server.stop(), 0, server.log());
    for (const seen of [history[0], history[history.length >> 1], history.at(-1)]) {
      const replay = ask('replay', join(server.data, 'sandbox'), '--to', String(seen.tick));
      assert.equal(replay.hash.motion, seen.root, `motion root after tick ${seen.tick}`);
    }
  }));

test('a session without players shows the hashes of the same scene run without a network', () =>
  withServer({ pile: 'pyramid:base=6' }, async (server) => {
    const page = await openPage(browser, server.url);
    await until(page, (h) => h.tick >= 200);
    const { history } = await state(page);
    const run = ask(
      'run',
      'pyramid:base=6',
      '--ticks',
      String(history.at(-1).tick),
      '--hash-every',
      '1',
    );
    const roots = new Map(run.hashes.map((each) => [each.tick, each.motion]));
    assert.ok(history.length >= 20);
    for (const { tick, root } of history)
      if (tick > 0) assert.equal(root, roots.get(tick), `tick ${tick}`);
  }));

test('sleeping bodies are dimmed', () =>
  withServer({ pile: 'small:n=12' }, async (server) => {
    const page = await openPage(browser, server.url);
    await until(page, (h) => h.looks.awake > 0);
    // While the page is paused its numbers and its picture are of one tick.
    await page.click('#pause');
    const early = await pixels(page, ['awake-fill', 'asleep-fill']);
    const { looks } = await state(page);
    assert.equal(early['awake-fill'] > 0, looks.awake > 0);
    assert.equal(early['asleep-fill'] > 0, looks.asleep > 0);
    await page.click('#pause');
    // The boxes sleep at tick 31 already, until the disc lands on them at 44; from 234 on for good,
    // while it rolls on.
    await until(page, (h) => h.tick >= 250 && h.asleep === 12);
    await page.click('#pause');
    const late = await pixels(page, ['awake-fill', 'asleep-fill']);
    assert.ok(late['asleep-fill'] > 1000, `${late['asleep-fill']} pixels asleep`);
    assert.ok(late['awake-fill'] < late['asleep-fill'] / 4, `${late['awake-fill']} pixels awake`);
    await page.screenshot({ path: join(pictures, 'asleep.png') });
  }));

test('frames of a scene of 1,000 bodies are drawn as they come', () =>
  withServer({ pile: 'pyramid:base=45' }, async (server) => {
    const page = await openPage(browser, server.url);
    await until(page, (h) => h.received >= 60);
    await page.evaluate(() => {
      window.turns = 0;
      const turn = () => {
        window.turns += 1;
        requestAnimationFrame(turn);
      };
      requestAnimationFrame(turn);
    });
    const before = await state(page);
    await until(page, (h) => h.received >= before.received + 300);
    const now = await state(page);
    const turns = await page.evaluate(() => window.turns);
    assert.ok(now.bodies > 1000, `${now.bodies} bodies`);
    const received = now.received - before.received;
    const drawn = now.drawn - before.drawn;
    const sorted = now.drawMs.toSorted?.() ?? [...now.drawMs].sort((a, b) => a - b);
    console.log(
      `${received} frames came, ${drawn} were drawn in ${turns} turns of the screen; ` +
        `median ${sorted[sorted.length >> 1].toFixed(1)} ms each`,
    );
    assert.ok(
      Math.abs(received - drawn - (now.overtaken - before.overtaken)) <= 2,
      'each frame is accounted for',
    );
    // On a busy machine the screen has fewer turns than the session has ticks; none may be wasted.
    assert.ok(
      drawn >= 0.75 * Math.min(received, turns),
      `${drawn} of ${received} frames were drawn in ${turns} turns`,
    );
    assert.equal(
      received + now.missed - before.missed,
      now.tick - before.tick,
      'each tick is accounted for',
    );
    // The server leaves frames out for a viewer that does not keep up; this one does.
    const ticks = now.tick - before.tick;
    assert.ok(received >= 0.7 * ticks, `${received} frames came in ${ticks} ticks`);
    await page.screenshot({ path: join(pictures, 'thousand.png') });
  }));

test('pan, zoom, fit and pause do what they say', () =>
  withServer({ sandbox: 'sandbox' }, async (server) => {
    const page = await openPage(browser, server.url);
    await until(page, (h) => h.drawn > 10);
    const ruler = () => page.evaluate(() => document.getElementById('scale').textContent);
    await eventually('the scale', ruler);
    const fitted = await ruler();
    await page.mouse.move(600, 400);
    for (let i = 0; i < 8; ++i) await page.mouse.wheel(0, -400);
    await eventually('a closer look', async () => parseFloat(await ruler()) < parseFloat(fitted));
    await page.mouse.down();
    await page.mouse.move(5000, 400, { steps: 4 });
    await page.mouse.up();
    await page.mouse.move(600, 400);
    for (let i = 0; i < 4; ++i) {
      await page.mouse.down();
      await page.mouse.move(600, 4000, { steps: 2 });
      await page.mouse.up();
      await page.mouse.move(600, 400);
    }
    await eventually(
      'nothing but the ground',
      async () => (await pixels(page, ['static-fill']))['static-fill'] === 0,
    );
    await page.click('#fit');
    await eventually(
      'the scene again',
      async () => (await pixels(page, ['static-fill']))['static-fill'] > 100,
    );

    await page.click('#canvas');
    await page.keyboard.press(' ');
    assert.equal(await page.textContent('#pause'), 'Resume');
    const stopped = await state(page);
    await until(page, (h) => h.tick >= stopped.tick + 30);
    assert.equal((await state(page)).drawn, stopped.drawn, 'nothing is drawn while paused');
    await page.click('#pause');
    await until(page, (h) => h.drawn > stopped.drawn + 10);
    assert.deepEqual(page.problems, []);
  }));

test('the page comes back when its server does', async () => {
  const first = await startServer({ pile: 'pyramid:base=4' });
  let second;
  try {
    const page = await openPage(browser, first.url);
    await until(page, (h) => h.tick > 30);
    assert.equal(await first.stop(), 0, first.log());
    await until(page, (h) => h.state === 'waiting');
    assert.match(await page.textContent('#state'), /again in \d+ s/);
    await page.screenshot({ path: join(pictures, 'waiting.png') });
    const { tick } = await state(page);
    second = await startServer(
      { pile: 'pyramid:base=4' },
      { data: first.data, web: new URL(first.url).host },
    );
    await until(page, (h) => h.state === 'live' && h.tick > tick);
    assert.ok((await state(page)).losses >= 1);
  } finally {
    await first.stop();
    await second?.stop();
    first.forget();
  }
});

test('a server that falls silent is given up, and found again when it speaks', () =>
  withServer({ pile: 'pyramid:base=4' }, async (server) => {
    const page = await openPage(browser, server.url);
    await until(page, (h) => h.tick > 30);
    server.sleep();
    let sentence = '';
    try {
      await until(page, (h) => h.state === 'waiting');
      sentence = await page.textContent('#state');
    } finally {
      server.wake();
    }
    assert.match(sentence, /^the server is silent, again in \d+ s/);
    const { tick } = await state(page);
    await until(page, (h) => h.state === 'live' && h.tick > tick);
  }));

test('a session that stands still is no silence, and its repeated frames are counted once', () =>
  withServer({ pile: 'pyramid:base=4' }, async (server) => {
    let still = false;
    let repeats = 0;
    const prepare = (page) =>
      page.routeWebSocket(/\/view\?/, (toPage) => {
        const toServer = toPage.connectToServer();
        let newest = null;
        toServer.onMessage((frame) => {
          if (still) return;
          newest = frame;
          toPage.send(frame);
        });
        const timer = setInterval(() => {
          if (!still || !newest) return;
          repeats += 1;
          toPage.send(newest);
        }, 2000);
        timer.unref(); // the page's end does not always tell
        toPage.onClose(() => clearInterval(timer));
      });
    const page = await openPage(browser, server.url, { prepare });
    // Not the first frame, which brings all shapes: a server does not repeat that one.
    await until(page, (h) => h.tick > 30 && h.received > 5);
    still = true;
    await eventually('standing still', async () => {
      return (await page.textContent('#state')) === 'standing still';
    });
    const before = await state(page);
    await eventually('repeats for longer than silence may last', () => repeats >= 7);
    const now = await state(page);
    assert.equal(await page.textContent('#state'), 'standing still');
    assert.equal(now.losses, 0);
    assert.equal(now.received, before.received);
    still = false;
    await until(page, (h) => h.tick > before.tick);
    assert.equal((await state(page)).losses, 0);
    await page.context().close();
  }));

test('several sessions are listed, and unknown ones named as such', () =>
  withServer({ one: 'pyramid:base=4', two: 'sandbox' }, async (server) => {
    const page = await openPage(browser, server.url);
    assert.equal(await page.locator('nav a').count(), 2);
    await page.screenshot({ path: join(pictures, 'sessions.png') });
    await page.click('text=two');
    await until(page, (h) => h.session === 'two' && h.drawn > 0);
    assert.deepEqual(page.problems, []);
    const reply = await page.goto(`${server.url}?session=three`);
    assert.equal(reply.status(), 404);
    assert.match(await page.textContent('h1'), /No such session/);
    await page.screenshot({ path: join(pictures, 'no-session.png') });
  }));
