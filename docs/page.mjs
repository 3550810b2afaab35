// Takes docs/page.png: the web page while a person lifts 8 kg with both hands.
// node docs/page.mjs [PROGRAM]   (needs npm ci --prefix web, npm ci --prefix tests/browser, and Chromium)
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { closeBrowser, DESKTOP, openPage } from '../tests/browser/open_page.mjs';

const fileOf = (path) => fileURLToPath(new URL(path, import.meta.url));
const program = process.argv[2] ?? fileOf('../build/dev/bin/kinescope');
const server = spawn(program, ['serve', 'demo:lift', '--hand', 'both:8', '--mass', '75', '--ros', 'off', '--http_port', '0'],
  { stdio: ['ignore', 'ignore', 'pipe'] });
try {
  const visit = await openPage(`${await urlOf(server)}?quality=fine`, { viewport: DESKTOP });
  await visit.page.locator('#picture-image').waitFor({ state: 'visible' });
  await visit.page.waitForFunction(isLifting, null, { polling: 'raf' });
  await visit.page.screenshot({ path: fileOf('page.png') });
  if (visit.problems.length > 0) throw new Error(visit.problems.join('\n'));
} finally {
  await closeBrowser();
  server.kill();
}

/** The address of the page, which the server logs. */
async function urlOf({ stderr }) {
  for await (const line of createInterface({ input: stderr })) {
    const [url] = line.match(/http:\S+/) ?? [];
    if (url) return url;
  }
  throw new Error(`${program} ended before it served the page`);
}

/** Runs in the page: L5/S1 was highly loaded a moment ago, so the person is straightening up; the latency is known. */
function isLifting() {
  const rows = [...document.querySelectorAll('#loads li')];
  const back = rows.find((row) => row.querySelector('.label').textContent === 'L5/S1');
  return back?.querySelector('.word').textContent === 'high' && parseInt(back.querySelector('.ratio').textContent, 10) < 55
    && document.getElementById('latency-p95').textContent !== '';
}
