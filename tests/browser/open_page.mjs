// Real Chromium on the real page: starts a server program, opens its page, watches what goes wrong.
//   const site = await startFixture();                  // tests/server/http/page_fixture_server
//   const visit = await openPage(site.url, { viewport: DESKTOP });
//   ... visit.page is a Playwright page ...
//   await visit.close(); await site.stop();
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync } from 'node:fs';
import { mkdir, writeFile } from 'node:fs/promises';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { PNG } from 'pngjs';
import { blankWebGl } from './blank_webgl.mjs';

export const DESKTOP = { width: 1440, height: 900 };
export const PHONE = { width: 390, height: 844 };

// The headless shell opens a page in three quarters of the time of the whole program.
const SHELL = '/usr/bin/chromium-headless-shell';
const CHROMIUM = process.env.KINESCOPE_CHROMIUM ?? (existsSync(SHELL) ? SHELL : '/usr/bin/chromium');
// Draws WebGL in software; with KINESCOPE_ANGLE, on a GPU with that back-end of ANGLE (gl-egl, vulkan). Keeps quiet on the network.
const ANGLE = process.env.KINESCOPE_ANGLE;
const FLAGS = [
  '--no-sandbox', '--use-gl=angle', `--use-angle=${ANGLE ?? 'swiftshader'}`,
  ...(ANGLE ? ['--ignore-gpu-blocklist', '--enable-gpu'] : ['--disable-gpu', '--enable-unsafe-swiftshader']),
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--mute-audio',
];
const PATIENCE_MILLIS = 60000;  // only a failure takes so long
const SELDOM_MILLIS = 200, PICTURE_MILLIS = 500, BLANK_MILLIS = 80;

let browser = null;
let drawsNothing = false, isSeldom = false;

/** For tests of what stands beside the view: the pages that are opened from now on draw nothing in it, unless they say
 *  `isDrawn`, and then five times a second. Software WebGL takes most of two cores otherwise, and everything waits for it.
 *  With KINESCOPE_DRAWN all of them draw, for whoever wants to look at their screenshots. */
export function drawNothing() { drawsNothing = true; }

/** For tests of single pictures: the pages that are opened from now on draw twice a second. */
export function drawSeldom() { isSeldom = true; }

async function launch() {
  if (!existsSync(CHROMIUM)) {
    throw new Error(`${CHROMIUM} is missing: apt install chromium-headless-shell, or set KINESCOPE_CHROMIUM`);
  }
  const { chromium } = await import('playwright-core').catch(() => {
    throw new Error('playwright-core is missing: npm ci --prefix tests/browser');
  });
  return chromium.launch({ executablePath: CHROMIUM, args: FLAGS, timeout: PATIENCE_MILLIS });
}

/** `work`, or an error that names `what` when it takes longer than `millis`. */
async function within(millis, what, work) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what} took more than ${millis / 1000} s`)), millis);
  });
  try {
    return await Promise.race([work, late]);
  } finally {
    clearTimeout(timer);
  }
}

const running = new Set();  // programs that a test has not stopped

/** What a failed test leaves would keep Node from ending: it ends with `closeBrowser`.
 *  @param {import('node:child_process').ChildProcess} child */
export function endWithTests(child) {
  running.add(child);
  child.once('exit', () => running.delete(child));
}

/** Call once when all tests are through. */
export async function closeBrowser() {
  for (const child of running) child.kill('SIGKILL');
  if (browser) await within(PATIENCE_MILLIS, 'closing Chromium', browser.close());
  browser = null;
}

/** Starts `program`, whose first line on standard output is JSON with a "url".
 *  @param {string} program
 *  @param {string[]} args */
export async function startServer(program, args = []) {
  const child = spawn(program, args, { stdio: ['pipe', 'pipe', 'inherit'] });
  endWithTests(child);
  const lines = createInterface({ input: child.stdout });
  const timer = setTimeout(() => child.kill('SIGKILL'), PATIENCE_MILLIS);
  const [line] = await Promise.race([
    once(lines, 'line'),
    once(child, 'exit').then(() => { throw new Error(`${program} ended before it served`); }),
    once(child, 'error').then(([error]) => { throw error; }),
  ]);
  clearTimeout(timer);
  return {
    ...JSON.parse(line),
    pid: child.pid,
    /** @param {string} order  see the program */
    say(order) { child.stdin.write(`${order}\n`); },
    /** Stops it without any goodbye, as a crash would. */
    async kill() {
      child.kill('SIGKILL');
      if (child.exitCode === null && child.signalCode === null) await once(child, 'exit');
    },
    async stop() {
      child.stdin.end();
      if (child.exitCode !== null || child.signalCode !== null) return;
      try {
        await within(PATIENCE_MILLIS, `the end of ${program}`, once(child, 'exit'));
      } finally {
        child.kill('SIGKILL');
      }
    },
  };
}

/** @param {string[]} args */
export function startFixture(args = []) {
  const program = process.env.KINESCOPE_PAGE_FIXTURE;
  if (!program) {
    throw new Error('set KINESCOPE_PAGE_FIXTURE to the built page_fixture_server; ctest does it');
  }
  return startServer(program, args);
}

/** In the page, before its own programs. @param {number} millis */
function drawEvery(millis) {
  const nextFrame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => window.setTimeout(() => nextFrame(draw), millis);
}

/** @param {string} url
 *  @param {{viewport?: {width: number, height: number}, colorScheme?: 'light'|'dark', isDrawn?: boolean,
 *    context?: object, beforeLoad?: (page: any) => Promise<void>}} options  isDrawn: also after drawNothing()
 *  @returns `problems`: console errors, exceptions, failed and foreign requests, as lines */
export async function openPage(url, options = {}) {
  browser ??= await launch();
  const context = await within(PATIENCE_MILLIS, 'a new page', browser.newContext({
    viewport: options.viewport ?? DESKTOP, colorScheme: options.colorScheme ?? 'light', ...options.context,
  }));
  context.setDefaultTimeout(PATIENCE_MILLIS);
  const page = await context.newPage();
  const problems = [];
  const requests = [];
  const home = new URL(url).host;
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => problems.push(`exception: ${error.message}`));
  page.on('requestfailed', (request) => problems.push(`failed: ${request.url()}`));
  page.on('response', (response) => {
    if (response.status() >= 400) problems.push(`${response.status()}: ${response.url()}`);
  });
  page.on('request', (request) => {
    requests.push(request.url());
    const { protocol, host } = new URL(request.url());
    if (protocol !== 'blob:' && protocol !== 'data:' && host !== home) problems.push(`foreign request: ${request.url()}`);
  });
  if (drawsNothing) {
    const isDrawn = options.isDrawn || process.env.KINESCOPE_DRAWN;
    if (!isDrawn) await page.addInitScript(blankWebGl);
    await page.addInitScript(drawEvery, isDrawn ? SELDOM_MILLIS : BLANK_MILLIS);
  } else if (isSeldom) {
    await page.addInitScript(drawEvery, PICTURE_MILLIS);
  }
  await options.beforeLoad?.(page);
  await page.goto(url, { waitUntil: 'load' });
  return { page, problems, requests, close: () => context.close() };
}

/** A page that is about to be opened keeps every text that its element `id` has, also for a moment, in window.words.
 *  @param {any} page
 *  @param {string} id */
export const keepWords = (page, id) => page.addInitScript((wanted) => {
  window.words = [];
  addEventListener('DOMContentLoaded', () => {
    const element = document.getElementById(wanted);
    new MutationObserver(() => window.words.push(element.textContent))
      .observe(element, { childList: true, characterData: true, subtree: true });
  });
}, id);

/** Presses the tab `name`; a phone has some under "More".
 *  @param {any} page
 *  @param {string} name */
export async function chooseTab(page, name) {
  await page.waitForSelector('#tabs [aria-selected="true"][tabindex="0"]', { state: 'attached' });  // the page has chosen one
  const folded = await page.locator(`#tab-${name}`).evaluate((tab) => tab.getBoundingClientRect().width < 2);
  if (folded) await page.click('#tab-more');
  await page.click(`#tab-${name}`);
}

/** The lines of `problems` that the end of the server does not explain: each request under way fails,
 *  refused, cut off or answered with nothing, as the moment has it.
 *  @param {string[]} problems */
export const besidesOutage = (problems) => problems.filter(
  (line) => !/WebSocket|net::ERR_(CONNECTION_(REFUSED|RESET|CLOSED|ABORTED)|EMPTY_RESPONSE|SOCKET_NOT_CONNECTED)|^failed: /.test(line));

/** Writes a picture of the page into out/browser of the build or the folder KINESCOPE_SCREENSHOTS. */
export const saveScreenshot = async (page, name) => saveFile(`${name}.png`, await pictureOf(page));

/** Into the same folder.
 *  @param {string} name
 *  @param {Buffer} bytes */
export async function saveFile(name, bytes) {
  const folder = process.env.KINESCOPE_SCREENSHOTS
    ?? fileURLToPath(new URL('../../out/browser', import.meta.url));
  await mkdir(folder, { recursive: true });
  await writeFile(`${folder}/${name}`, bytes);
}

const sessions = new WeakMap();

/** PNG of what is drawn in `selector`, or of the whole window. Overlays that lie on it are on the picture too, as a person
 *  would see them. Asked of Chromium itself, since Playwright's waits for several pictures of a page take seconds while
 *  that draws in software.
 *  @param {any} page
 *  @param {string|null} selector */
export async function pictureOf(page, selector = null) {
  if (!sessions.has(page)) sessions.set(page, await page.context().newCDPSession(page));
  const clip = await page.evaluate((wanted) => {
    const element = wanted === null ? null : document.querySelector(wanted);
    element?.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    const box = element?.getBoundingClientRect() ?? { x: 0, y: 0, width: innerWidth, height: innerHeight };
    const [left, top] = [Math.floor(box.x), Math.floor(box.y)];  // whole pixels
    return { x: left + scrollX, y: top + scrollY, width: Math.ceil(box.x + box.width) - left, height: Math.ceil(box.y + box.height) - top };
  }, selector);
  const { data } = await sessions.get(page).send('Page.captureScreenshot', { format: 'png', optimizeForSpeed: true, clip: { ...clip, scale: 1 } });
  return Buffer.from(data, 'base64');
}

/** The same as pixels: {width, height, data} with RGBA bytes.
 *  @param {any} page
 *  @param {string} selector */
export const pixelsOf = async (page, selector) => pixelsOfPng(await pictureOf(page, selector));

/** @param {Buffer} png */
export const pixelsOfPng = (png) => PNG.sync.read(png);

/** Pixels of `selector` once two pictures in a row are equal: the camera has arrived and the skin is there.
 *  @param {any} page
 *  @param {string} selector */
export async function settled(page, selector = '#view') {
  let last = await pictureOf(page, selector);
  for (;;) {
    await page.evaluate(() => new Promise((drawn) => { requestAnimationFrame(() => requestAnimationFrame(drawn)); }));
    const next = await pictureOf(page, selector);
    if (next.equals(last)) return pixelsOfPng(next);
    last = next;
  }
}

/** How many pixels pass `test`.
 *  @param {{data: Uint8Array}} pixels
 *  @param {(r: number, g: number, b: number) => boolean} test */
export function countPixels({ data }, test) {
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (test(data[i], data[i + 1], data[i + 2])) ++count;
  return count;
}

/** Names of the cameras whose button is pressed: one, or none. */
export const pressedCameras = (page) =>
  page.$$eval('#cameras [aria-pressed="true"]', (all) => all.map((button) => button.dataset.camera));
