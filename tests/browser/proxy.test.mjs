// The page behind a reverse proxy, below a path of it, and over TLS.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test as nodeTest } from 'node:test';
import { promisify } from 'node:util';
import { closeBrowser, drawNothing, openPage, saveScreenshot, startFixture } from './open_page.mjs';
import { startProxy } from './proxy.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const TOKEN = '0perator-of-the-lab';
let folder;
before(async () => { folder = await mkdtemp(join(tmpdir(), 'kinescope-proxy-')); });
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true });
});

async function startSite(options) {
  const site = await startFixture(['--token', TOKEN, ...options]);
  site.say('people 1');
  site.say('live');
  return site;
}
const isLive = (page) => page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live'
  && document.querySelectorAll('#loads li').length === 15 && document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);

for (const strips of [true, false]) {
  test(`below a path of a proxy that ${strips ? 'takes the path off' : 'leaves the path'}`, async (t) => {
    const site = await startSite(['--base_path', '/lab3']);
    const proxy = await startProxy(site.url, { prefix: '/lab3', strips });
    t.after(() => proxy.stop());  // also after a failure: the process would not end
    const { page, problems, requests, close } = await openPage(`${proxy.url}?token=${TOKEN}`);
    await isLive(page);
    await page.keyboard.press('1');
    await page.waitForFunction(() => /^Marked/.test(document.getElementById('mark-said').textContent), null, LONG);
    assert.deepEqual(requests.filter((url) => !url.startsWith('blob:') && !url.startsWith(proxy.url)), []);
    const [cookie] = await page.context().cookies();
    assert.deepEqual([cookie.path, cookie.httpOnly, cookie.secure], ['/lab3/', true, false]);
    await page.reload();  // with the cookie alone
    await isLive(page);
    await saveScreenshot(page, `below_a_path_${strips}`);
    assert.deepEqual(problems.filter((line) => !line.startsWith('failed: ')), [], 'but for requests that the reload cut short');
    await close();
    await site.stop();
  });
}

test('over TLS', async () => {
  const [certificate, key] = [join(folder, 'page.pem'), join(folder, 'page.key')];
  await promisify(execFile)('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
    '-days', '30', '-subj', '/CN=localhost', '-addext', 'subjectAltName=IP:127.0.0.1', '-keyout', key, '-out', certificate]);
  const site = await startSite(['--tls_certificate', certificate, '--tls_key', key]);
  assert.match(site.url, /^https:/);
  const { page, problems, close } = await openPage(site.url, { context: { ignoreHTTPSErrors: true } });
  await isLive(page);
  assert.equal((await page.context().cookies())[0].secure, true);
  await page.waitForFunction(() => document.getElementById('moment').min < -1, null, LONG);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
});
