// Takes docs/page.png: the web page while a person lifts 8 kg with both hands.
// node docs/page.mjs [PROGRAM]   (needs npm ci --prefix web, npm ci --prefix tests/browser, and Chromium)
import { spawn } from 'node:child_process';
import { writeFile } from 'node:fs/promises';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { closeBrowser, DESKTOP, openPage } from '../tests/browser/open_page.mjs';

const fileOf = (path) => fileURLToPath(new URL(path, import.meta.url));
const program = process.argv[2] ?? fileOf('../build/dev/bin/kinescope');
const server = spawn(program, ['serve', 'demo:lift', '--hand_load', 'both:8', '--mass', '75', '--ros', 'off', '--http_port', '0'],
  { stdio: ['ignore', 'ignore', 'pipe'] });
try {
  const url = await urlOf(server);
  const visit = await openPage(`${url}?quality=fine`, { viewport: DESKTOP });
  await visit.page.waitForFunction(() => /\d %/.test(document.querySelector('.person .ratio')?.textContent ?? ''));
  await visit.page.waitForFunction(() => document.getElementById('latency-p95').textContent !== '');
  await straightening(url);
  server.kill('SIGSTOP');  // view and list then show the same sample
  await visit.page.waitForTimeout(250);  // the list is updated every 150 ms
  const png = await visit.page.screenshot();
  const status = await visit.page.textContent('#status-word');
  if (status !== 'Live') throw new Error(`the status is ${status}: the machine is too busy; try again`);
  if (visit.problems.length > 0) throw new Error(visit.problems.join('\n'));
  await writeFile(fileOf('page.png'), png);
} finally {
  await closeBrowser();
  server.kill('SIGKILL');
}

/** The address of the page, which the server logs. */
async function urlOf({ stderr }) {
  for await (const line of createInterface({ input: stderr })) {
    const [url] = line.match(/http:\S+/) ?? [];
    if (url) return url;
  }
  throw new Error(`${program} ended before it served the page`);
}

/** Resolves when L5/S1 is highly loaded and the person is straightening up.
 *  @param {string} url */
async function straightening(url) {
  for (;;) {
    const { people } = await fetch(new URL('api/v1/state', url)).then((answer) => answer.json());
    const back = people[0]?.loads.find(({ joint }) => joint === 'l5_s1');
    if (back?.class === 'high' && people[0].com[2] > 0.7) return;
  }
}
