// web/client.js as programs of others use it: the examples of the documents, against a real server.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeBrowser, endWithTests, openPage, startFixture } from './open_page.mjs';
import { startProxy } from './proxy.mjs';

const LONG = { timeout: 60000 };
const root = fileURLToPath(new URL('../../', import.meta.url));
let site;
before(async () => { site = await startFixture(); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

// Node 18 of Debian 12 has no WebSocket, Node 20 one behind a switch.
const major = Number(process.versions.node.split('.')[0]);
const switches = major >= 20 && major < 22 ? ['--experimental-websocket'] : [];

test('the example for Node prints the state of the server', { skip: major < 20 && 'this Node has no WebSocket' }, async () => {
  const child = spawn(process.execPath, [...switches, `${root}docs/watch.mjs`, site.url], { stdio: ['ignore', 'pipe', 'inherit'] });
  endWithTests(child);
  const lines = [];
  for await (const line of createInterface({ input: child.stdout })) {
    lines.push(line);
    if (/^ {2}person/.test(line)) break;
  }
  child.kill();
  assert.match(lines.at(-2), /^live, state \d+$/);
  assert.match(lines.at(-1), /^ {2}person 0: [A-Z][\w/ ()]+ (low|medium|high), \d+ %$/);
});

test('the example for a page of the same host shows state and picture', async (t) => {
  const [, example] = /```html\n([\s\S]*?)```/.exec(readFileSync(`${root}docs/http.md`, 'utf8'));
  const proxy = await startProxy(site.url, { pages: { '/mine.html': example, '/favicon.ico': '' } });
  t.after(() => proxy.stop());
  const { page, problems, close } = await openPage(`${proxy.url}mine.html`);
  await page.waitForFunction(() => /^live: 1 person$/.test(document.title), null, LONG);
  await page.waitForFunction(() => document.querySelector('img')?.naturalWidth > 100, null, LONG);
  assert.deepEqual(problems, []);
  await close();
});
