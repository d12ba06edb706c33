/** A headless Chromium, and pages that keep what went wrong in them. */
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { eventually } from './server.mjs';

// The packages are installed in the build folder, so they are asked for from there.
const { chromium } = createRequire(join(process.env.HUESTEP_NODE_MODULES ?? '.', 'x.js'))(
  'playwright-core',
);

export function launch() {
  return chromium.launch({
    executablePath: process.env.HUESTEP_CHROMIUM ?? '/usr/bin/chromium',
    headless: true,
    args: [
      '--no-sandbox',
      '--disable-gpu',
      '--disable-quic',
      '--no-first-run',
      '--disable-component-update',
      '--disable-background-networking',
      '--disable-sync',
    ],
  });
}

export const desktop = { width: 1280, height: 800 };
export const phone = { width: 390, height: 844 };

/**
 * `prepare` is given the page before it is loaded.
 * @returns a page with `problems`: errors in the console, uncaught exceptions, failed requests
 */
export async function openPage(
  browser,
  url,
  { size = desktop, scheme = 'light', touch = false, prepare = undefined } = {},
) {
  const context = await browser.newContext({
    viewport: size,
    colorScheme: scheme,
    hasTouch: touch,
    isMobile: touch,
    deviceScaleFactor: touch ? 2 : 1,
  });
  const page = await context.newPage();
  page.problems = [];
  page.on('console', (message) => message.type() === 'error' && page.problems.push(message.text()));
  page.on('pageerror', (error) => page.problems.push(String(error)));
  page.on('requestfailed', (request) => page.problems.push(`failed: ${request.url()}`));
  await prepare?.(page);
  await page.goto(url);
  return page;
}

export const state = (page) => page.evaluate(() => ({ ...window.huestep }));

/** Waits until the page's state is as wanted. Its own policy forbids to hand it code as text. */
export const until = (page, wanted, seconds = 60) =>
  eventually(
    `${wanted} of ${page.url()}; problems: ${page.problems}`,
    async () => wanted(await state(page)),
    seconds,
  );

/** Pixels of the canvas in each of some colours of the style sheet, and how many colours it has. */
export function pixels(page, names) {
  return page.evaluate((wanted) => {
    const canvas = document.getElementById('canvas');
    const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    const counts = new Map();
    for (let i = 0; i < data.length; i += 4) {
      const colour = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
    }
    const style = getComputedStyle(document.documentElement);
    const of = (name) =>
      counts.get(parseInt(style.getPropertyValue(`--${name}`).trim().slice(1), 16)) ?? 0;
    return { colours: counts.size, ...Object.fromEntries(wanted.map((name) => [name, of(name)])) };
  }, names);
}
