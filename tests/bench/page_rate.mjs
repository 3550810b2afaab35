// Pictures per second of the page's 3-D view in headless Chromium, which renders WebGL in software, and the processor
// time that each takes: of Chromium and, if its process is named, of the server.
//   node page_rate.mjs URL SECONDS [SERVER_PID]
import { readdirSync, readFileSync } from 'node:fs';
import { closeBrowser, openPage } from '../browser/open_page.mjs';

const TICKS_PER_SECOND = 100;
const [url, seconds, server] = process.argv.slice(2);
if (!(Number(seconds) > 0)) {
  console.error('page_rate.mjs URL SECONDS [SERVER_PID]');
  process.exit(2);
}

/** Of a process: its parent, and the processor seconds that it has taken.
 *  @param {number|string} pid */
function statOf(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
  return { parent: Number(fields[1]), secs: (Number(fields[11]) + Number(fields[12])) / TICKS_PER_SECOND };
}

/** Processor seconds of all processes that this one has started. */
function secsOfBrowser() {
  const all = new Map();
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      all.set(Number(pid), statOf(pid));
    } catch {
      continue;  // it has ended
    }
  }
  const isOurs = (pid) => all.has(pid) && (all.get(pid).parent === process.pid || isOurs(all.get(pid).parent));
  return [...all].filter(([pid]) => isOurs(pid)).reduce((sum, [, { secs }]) => sum + secs, 0);
}

const { page, close } = await openPage(url, {
  beforeLoad: (opened) => opened.addInitScript(() => {
    const { drawElements } = WebGL2RenderingContext.prototype;
    let hasDrawn = false;
    window.pictures = 0;
    WebGL2RenderingContext.prototype.drawElements = function draw(...all) {
      hasDrawn = true;
      return drawElements.apply(this, all);
    };
    const count = () => {
      window.pictures += hasDrawn ? 1 : 0;
      hasDrawn = false;
      requestAnimationFrame(count);
    };
    requestAnimationFrame(count);
  }),
});
const pictures = () => page.evaluate(() => window.pictures);
await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live', null, { timeout: 60000 });
await page.evaluate(() => { document.getElementById('picture-on').click(); });  // the live picture is another matter
await page.waitForTimeout(8000);  // until the page has chosen its quality
const before = { pictures: await pictures(), browser: secsOfBrowser(), server: server ? statOf(server).secs : 0, at: Date.now() };
await page.waitForTimeout(1000 * Number(seconds));
const count = await pictures() - before.pictures, passed = (Date.now() - before.at) / 1000;
const millis = (secs) => (1000 * secs / count).toFixed(1);
const canvas = await page.evaluate(() => { const { width, height } = document.querySelector('#view canvas'); return `${width}x${height}`; });
console.log(`${canvas}: ${(count / passed).toFixed(1)} pictures/s; ${millis(secsOfBrowser() - before.browser)} ms of Chromium each`
  + (server ? `; server ${(100 * (statOf(server).secs - before.server) / passed).toFixed(1)} % of a core` : ''));
await close();
await closeBrowser();
