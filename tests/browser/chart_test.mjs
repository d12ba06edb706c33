/** The page of `huestep chart`, from its file and without a network. */
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { desktop, launch, openPage, phone } from './browser.mjs';
import { ask } from './server.mjs';

const pictures = process.env.HUESTEP_PICTURES ?? 'browser-pictures';
const folder = mkdtempSync(join(tmpdir(), 'huestep-chart-'));
let browser;
let found;
before(async () => {
  mkdirSync(pictures, { recursive: true });
  found = ask('chart', '--out', folder, '--smoke');
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const address = pathToFileURL(join(folder, 'index.html')).href;

/** The page in a browser that reaches nobody, and what it asked for. */
async function open(how = {}) {
  const asked = [];
  const page = await openPage(browser, address, {
    ...how,
    prepare: async (it) => {
      await it.context().setOffline(true);
      it.on('request', (request) => asked.push(request.url()));
    },
  });
  page.asked = asked.filter((url) => !url.startsWith('data:') && url !== address);
  return page;
}

const paper = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
const brightness = (colour) => colour.match(/\d+/g).slice(0, 3).reduce((sum, x) => sum + Number(x), 0);

test('it opens without a network and without an error, as wide as the screen, in light and dark', async () => {
  for (const [name, how] of Object.entries({
    'chart-desktop-light': { size: desktop },
    'chart-desktop-dark': { size: desktop, scheme: 'dark' },
    'chart-phone-light': { size: phone, touch: true },
    'chart-phone-dark': { size: phone, touch: true, scheme: 'dark' },
  })) {
    const page = await open(how);
    assert.deepEqual(page.problems, [], name);
    assert.deepEqual(page.asked, [], name);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${name} is ${wide} pixels wider than the screen`);
    assert.equal(brightness(await paper(page)) < 300, how.scheme === 'dark', name);
    await page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });
    await page.context().close();
  }
});

test('every class of scenes has a diagram whose points answer the pointer with figures and hash', async () => {
  const page = await open();
  const classes = new Set(found.cases.map((each) => each.class));
  for (const each of classes) {
    const plot = page.locator(`[data-section="work-${each}"] .plot`);
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    const first = found.cases.find((one) => one.class === each);
    const point = await page.evaluate(
      ([section, name]) => window.huestepPage.placeOf(section, name),
      [`work-${each}`, 'soft-step, planned (Huestep)'],
    );
    // Another point may lie upon this one.
    const hashes = found.work_precision
      .filter((row) => row.case === first.id)
      .map((row) => row.hash);
    await page.mouse.move(box.x + point[0] - 30, box.y + point[1] - 30);
    await page.mouse.move(box.x + point[0], box.y + point[1], { steps: 3 });
    const shown = plot.getByText('hash', { exact: false });
    await shown.waitFor({ state: 'visible', timeout: 10_000 });
    assert.match(await plot.innerText(), new RegExp(hashes.join('|')), each);
  }
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('its switch turns light into dark and back, whatever the system says', async () => {
  const page = await open({ scheme: 'dark' });
  const dark = brightness(await paper(page));
  await page.click('#theme');
  assert.ok(brightness(await paper(page)) > dark + 300);
  await page.click('#theme');
  assert.equal(brightness(await paper(page)), dark);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('a box drawn with zoom on narrows the axes, and whole brings them back', async () => {
  const page = await open();
  const section = page.locator('[data-section="overall"]');
  await section.scrollIntoViewIfNeeded();
  const range = () => page.evaluate(() => window.huestepPage.rangeOf('overall'));
  const whole = await range();
  await section.getByRole('button', { name: 'zoom' }).click();
  const box = await section.locator('.plot').boundingBox();
  await page.mouse.move(box.x + 0.35 * box.width, box.y + 0.35 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.6 * box.height, { steps: 5 });
  await page.mouse.up();
  const near = await range();
  assert.ok(near[1] - near[0] < 0.5 * (whole[1] - whole[0]), `${whole} to ${near}`);
  await section.getByRole('button', { name: 'whole' }).click();
  assert.deepEqual(await range(), whole);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('all times are listed with their hashes once they are asked for', async () => {
  const page = await open();
  await page.click('#all-runs summary');
  const rows = page.locator('#all-runs tbody tr');
  const timed = ['work_precision', 'sizes', 'scenes', 'prices', 'effort'];
  const all = timed.reduce((sum, name) => sum + found[name].length, 0);
  await rows.nth(all - 1).waitFor();
  assert.equal(await rows.count(), all);
  for (const text of await rows.locator('td:last-child').allInnerTexts())
    assert.match(text, /^[0-9a-f]{16}/);
  await page.context().close();
});
