// Marks: operators set them by key, button and text; each has the sample that was on the screen.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test as nodeTest } from 'node:test';
import { startLab } from './lab.mjs';
import { besidesOutage, chooseTab, closeBrowser, drawNothing, openPage, PHONE, saveScreenshot, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const MANY = 10_000;
const OPERATOR = '0perator-of-the-lab', VIEWER = 'v1ewer-of-the-lab';
let site, folder, file;
const start = async () => {
  site = await startFixture(['--token', OPERATOR, '--viewer_token', VIEWER, '--marks_file', file]);
  site.say('people 1');
  site.say('live');
};
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'kinescope-marks-'));
  file = join(folder, 'marks.jsonl');
  await start();
});
after(async () => {
  await site.stop();
  await closeBrowser();
  await rm(folder, { recursive: true });
});

async function open(url, options) {
  const visit = await openPage(url, options);
  await visit.page.waitForFunction(() => document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);
  await visit.page.waitForFunction(() => Number(document.getElementById('moment').min) < -1, null, LONG);
  await visit.page.waitForFunction(() => document.getElementById('role').dataset.role !== undefined, null, LONG);
  await visit.page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live', null, LONG);
  return visit;
}
const lines = async () => (await readFile(file, 'utf8')).trim().split('\n').map((line) => JSON.parse(line));
const textOf = (page, id) => page.evaluate((which) => document.getElementById(which).textContent, id);
async function textIs(page, id, pattern) {
  try {
    await page.waitForFunction(
      ([which, source]) => new RegExp(source).test(document.getElementById(which).textContent), [id, pattern.source], LONG);
  } catch (cause) {
    const [said, banner, status] = [await textOf(page, 'mark-said'), await textOf(page, 'banner'), await textOf(page, 'status-word')];
    throw new Error(`expected ${pattern}; the page says “${said}”, its banner “${banner}”, its lamp ${status}`, { cause });
  }
}
const saidIs = (page, pattern) => textIs(page, 'mark-said', pattern);
const bannerIs = (page, pattern) => textIs(page, 'banner', pattern);
const entries = (page) => page.$$eval('#mark-list .go', (all) => all.map((each) => each.querySelector('span').textContent));
const entriesAre = (page, texts) => page.waitForFunction((wanted) => JSON.stringify(
  [...document.querySelectorAll('#mark-list .go span')].map((each) => each.textContent)) === wanted, JSON.stringify(texts), LONG);

test('a key marks the sample on the screen, also of a viewer of former moments, and survives kill -9', async () => {
  const { page, problems, close } = await open(site.url);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  const sample = Number(await page.textContent('#sample'));
  await page.keyboard.press('2');
  await saidIs(page, new RegExp(`^Marked: “lift” at sample ${sample}`));
  await site.kill();
  const [mark] = await lines();
  assert.deepEqual([mark.button, mark.text, mark.role, mark.at.counter], [2, 'lift', 'operator', sample]);
  await page.waitForFunction(() => /Disconnected/.test(document.getElementById('status-note').textContent), null, LONG);
  await page.keyboard.press('3');
  await saidIs(page, /^1 mark waits for the server$/);
  await close();
  await start();  // also for the tests that follow
  assert.deepEqual(besidesOutage(problems), []);
});

/** A page whose marks take the way that way.of says. It is laid before the page is loaded: a request of the moment in which
 *  the browser takes such an order would still go its own way. */
async function openWithWay() {
  const way = { of: (route) => route.continue() };
  const visit = await open(site.url, { beforeLoad: (fresh) => fresh.route('**/api/v1/mark', (route) => way.of(route)) });
  return { ...visit, way };
}

test('marks that are set while the server cannot be reached are set when it can be', async () => {
  const { page, way, close } = await openWithWay();
  const passes = way.of, isCut = (route) => route.abort();
  const before = (await lines()).length;
  way.of = isCut;
  const shown = await page.textContent('#sample');
  await page.keyboard.press('1');
  await saidIs(page, /^1 mark waits for the server$/);
  await page.waitForFunction((last) => document.getElementById('sample').textContent !== last, shown, LONG);
  const seen = Number(await page.textContent('#sample'));  // the text is older than the picture: the key was before this one
  await page.keyboard.press('Shift+Digit2');
  await saidIs(page, /^2 marks wait for the server$/);
  assert.equal((await lines()).length, before);
  way.of = passes;
  await saidIs(page, /^Set now: 2 marks that waited for the server$/);
  const set = (await lines()).slice(before);
  assert.deepEqual(set.map(({ text, is_open }) => [text, is_open]), [['grasp', false], ['lift', true]]);
  assert.ok(set[0].at.counter <= seen, 'the sample that was on the screen, not that of the sending');
  // A server that was started again does not have the moment, but may have another one with its number. The page sends no
  // mark while it waits for this answer, so it knows of the other start before the first mark that could be set.
  way.of = isCut;
  await page.keyboard.press('3');
  await saidIs(page, /^1 mark waits for the server$/);
  await page.route('**/api/v1/marks?**', async (route) => {
    const answer = await (await route.fetch()).json();
    way.of = passes;
    await route.fulfill({ json: { ...answer, run_micros: answer.run_micros + 1 } });
  });
  await bannerIs(page, /^Not set while the server was away: “.*”: the server was started again/);
  assert.equal((await lines()).length, before + 2);
  await close();
});

test('a mark to which the server does not answer says so, and is set when it answers', async () => {
  const { page, way, close } = await openWithWay();
  let letThrough;
  way.of = async (route) => {
    await new Promise((resolve) => { letThrough = resolve; });
    await route.continue();
  };
  await page.keyboard.press('1');
  await saidIs(page, /^The server has not answered yet$/);
  letThrough();
  await saidIs(page, /^Marked: “grasp” at sample/);
  await close();
});

test('a live mark is of the sample that is drawn, within one', async () => {
  const { page, close } = await open(site.url);
  // The text of the sample changes a few times a second: pressed with it, the key is of the same sample.
  const seen = await page.evaluate(() => new Promise((resolve) => {
    const sample = document.getElementById('sample');
    new MutationObserver((_, observer) => {
      observer.disconnect();
      document.body.dispatchEvent(new KeyboardEvent('keydown', { key: '1', code: 'Digit1', bubbles: true }));
      resolve(Number(sample.textContent));
    }).observe(sample, { childList: true, characterData: true, subtree: true });
  }));
  await saidIs(page, /^Marked: “grasp”/);
  const { at } = (await lines()).at(-1);
  assert.ok(Math.abs(at.counter - seen) <= 1, `marked ${at.counter}, seen ${seen}`);
  await close();
});

/** The next sample on the screen that is later than `number`. */
async function sampleAfter(page, number) {
  const later = await page.waitForFunction((least) => {
    const sample = Number(document.getElementById('sample').textContent);
    return sample > least && sample;
  }, number, LONG);
  return later.jsonValue();
}

test('a text marks the sample that was seen when it was begun, however long it takes to write', async () => {
  const { page, close } = await open(site.url);
  const seen = Number(await page.textContent('#sample'));
  await page.keyboard.press('m');
  await saidIs(page, /^This text marks sample \d+$/);
  const begun = await sampleAfter(page, Number(await page.textContent('#sample')));
  await sampleAfter(page, begun + 60);
  await page.keyboard.type('rope slipped');
  const meant = Number(/\d+$/.exec(await page.textContent('#mark-said'))[0]);
  assert.ok(meant >= seen && meant <= begun, `${meant}, seen ${seen} before and ${begun} after it was begun`);
  await page.keyboard.press('Enter');
  await saidIs(page, new RegExp(`^Marked: “rope slipped” at sample ${meant}`));
  assert.equal((await lines()).at(-1).at.counter, meant);
  // Without M, it is the first letter that counts, and what is given up counts no more.
  await page.locator('#mark-text').click();
  await page.keyboard.type('x');
  await saidIs(page, /^This text marks sample \d+$/);
  const given = Number(/\d+$/.exec(await page.textContent('#mark-said'))[0]);
  assert.ok(given > meant);
  await page.keyboard.press('Escape');
  assert.equal(await page.inputValue('#mark-text'), '');
  await sampleAfter(page, given + 30);
  await page.locator('#mark-text').click();
  await page.keyboard.type('y');
  await page.waitForFunction((last) => Number(/\d+$/.exec(document.getElementById('mark-said').textContent)?.[0]) > last, given, LONG);
  await page.keyboard.press('Escape');
  await close();
});

test('marks of a recording are at its samples again when it is served again', async () => {
  const take = join(folder, 'take.mvnx'), options = { source: take, folder, marks: 'take.jsonl' };
  execFileSync(process.env.KINESCOPE, ['convert', 'demo:lift', '--seconds', '4', '--out', take], { stdio: 'ignore' });
  const openEnded = async (url) => {
    const visit = await openPage(url);
    await visit.page.waitForFunction(() => document.getElementById('status-note').textContent === 'ended', null, LONG);
    await visit.page.waitForFunction(() => document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);
    await chooseTab(visit.page, 'marks');
    return visit;
  };
  const first = await startLab(options);
  const { page, close } = await openEnded(first.operator);
  const last = Number(await page.textContent('#sample'));
  for (let i = 1; i <= 12; ++i) {
    await page.click('#step-back');
    await page.waitForFunction((wanted) => Number(document.getElementById('sample').textContent) === wanted, last - i, LONG);
  }
  await page.keyboard.press('2');
  await saidIs(page, /^Marked: “lift” at sample \d+/);
  const said = await page.textContent('#mark-list li small'), sample = Number(/sample (\d+)/.exec(said)[1]);
  assert.equal(sample, last - 12);
  await close();
  await first.stop();
  const second = await startLab(options);
  const again = await openEnded(second.operator);
  await again.page.waitForFunction((text) => document.querySelector('#mark-list li small')?.textContent.startsWith(text), said.split(' ·')[0], LONG);
  await again.page.locator('#mark-list .go').click();
  await again.page.waitForFunction((wanted) => Number(document.getElementById('sample').textContent) === wanted, sample, LONG);
  await saveScreenshot(again.page, 'marks_again');
  await again.close();
  await second.stop();
});

test('a mark of a moment that is gone, or that has not come, is refused in words, and live goes on', async () => {
  const { page, way, close } = await openWithWay();
  const passes = way.of;
  const count = (await lines()).length;
  for (const [state, sentence] of [[0, /^The mark was not set: state 0 is no longer kept \(--history_minutes\)$/],
    [1e9, /^The mark was not set: state 1000000000 has not come yet; the newest one is \d+$/]]) {
    way.of = (route) => route.continue({ postData: JSON.stringify({ ...route.request().postDataJSON(), state }) });
    await page.keyboard.press('1');
    await bannerIs(page, sentence);
    assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  }
  assert.equal((await lines()).length, count);
  way.of = passes;
  await page.keyboard.press('1');
  await saidIs(page, /^Marked: “grasp”/);
  await close();
});

test('with ten thousand marks the page lists the last 200, says how many are earlier, and goes on', async () => {
  let newest = 0;  // moment of the last real mark, µs
  const { page, problems, close } = await open(site.url, { beforeLoad: (fresh) => fresh.route('**/api/v1/marks?after=*', async (route) => {
    const answer = await (await route.fetch()).json(), after = Number(new URL(route.request().url()).searchParams.get('after'));
    if (after >= MANY) return route.fulfill({ json: { ...answer, marks: [] } });
    const like = { kind: 'mark', button: 1, text: 'grasp', role: 'operator', is_open: false, is_removed: false, behind_secs: 0,
      run_micros: answer.run_micros };
    newest ||= answer.marks.at(-1).at.micros;
    const marks = Array.from({ length: 2000 }, (_, i) => {
      const number = after + i + 1;
      const moment = { state: number, micros: newest - 300 * number, stamp_micros: number, time_code_millis: number, counter: number };
      return { ...like, id: 1_000_000 + number, revision: number, at: moment, end: number % 7 === 0 ? moment : null };
    });
    return route.fulfill({ json: { ...answer, revision: MANY, marks } });
  }) });
  await chooseTab(page, 'marks');
  await page.waitForFunction((text) => document.getElementById('mark-earlier').textContent === text,
    `${MANY - 200} earlier marks are in the file`, LONG);
  const { items, parts } = await page.evaluate(() => ({
    items: document.querySelectorAll('#mark-list li').length, parts: document.querySelectorAll('*').length }));
  assert.equal(items, 200);
  assert.ok(parts < 3500, `${parts} elements`);
  await saveScreenshot(page, 'marks_many');
  const sample = Number(await page.textContent('#sample'));
  await page.waitForFunction((n) => Number(document.getElementById('sample').textContent) > n + 60, sample, LONG);
  await page.click('#play');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  assert.deepEqual(problems, []);
  await close();
});

test('spans, free text, undo, and a list in which a click shows the moment', async () => {
  const { page, problems, close } = await open(site.url);
  await chooseTab(page, 'marks');
  const earlier = await entries(page);
  await page.keyboard.press('Shift+Digit5');
  await saidIs(page, /^Span begins: “step”/);
  await page.waitForFunction(() => document.querySelector('#mark-buttons button:nth-child(5)')?.classList.contains('open'), null, LONG);
  await page.keyboard.press('Shift+Digit5');
  await saidIs(page, /^Span: “step” at sample \d+ to \d+/);
  await page.keyboard.press('m');
  await page.keyboard.type('<b>belt</b> slipped 1');
  await page.keyboard.press('Enter');
  await saidIs(page, /belt/);
  await entriesAre(page, ['<b>belt</b> slipped 1', 'step', ...earlier]);
  await page.keyboard.press('4');
  await saidIs(page, /^Marked: “release”/);
  await page.keyboard.press('Control+z');
  await saidIs(page, /^Removed: “release”/);
  await entriesAre(page, ['<b>belt</b> slipped 1', 'step', ...earlier]);
  await page.keyboard.press('3');
  await saidIs(page, /^Marked: “place”/);
  await page.click('#mark-undo');
  await saidIs(page, /^Removed: “place”/);
  await entriesAre(page, ['<b>belt</b> slipped 1', 'step', ...earlier]);
  const marked = (await lines()).find(({ text }) => text.includes('belt'));
  await page.click('#mark-list li:first-child .go');
  await page.waitForFunction((n) => document.getElementById('sample').textContent === String(n), marked.at.counter, LONG);
  await page.keyboard.press('[');
  const span = (await lines()).findLast(({ text, end }) => text === 'step' && end !== null);
  await page.waitForFunction((n) => document.getElementById('sample').textContent === String(n), span.at.counter, LONG);
  await saveScreenshot(page, 'marks_desktop');
  assert.deepEqual(problems, []);
  await close();
});

test('a viewer sees marks as they are set, and cannot set one', async () => {
  const operator = await open(site.url), viewer = await open(site.viewer_url);
  await chooseTab(viewer.page, 'marks');
  await operator.page.click('#mark-buttons button:nth-child(8)');
  await viewer.page.waitForFunction(
    () => document.querySelector('#mark-list .go span')?.textContent === 'pain', null, LONG);
  const count = (await lines()).length;
  assert.ok(await viewer.page.locator('#mark-buttons button').first().isDisabled());
  assert.ok(await viewer.page.locator('#mark-list fieldset button').first().isDisabled());
  await viewer.page.keyboard.press('6');
  await viewer.page.waitForFunction(
    () => /^The mark was not set: .*operator/.test(document.getElementById('banner').textContent), null, LONG);
  assert.equal((await lines()).length, count);
  await operator.close();
  await viewer.close();
});

test('on a phone the buttons of marks are in reach of a thumb', async () => {
  const { page, close } = await open(site.url, { viewport: PHONE });
  await chooseTab(page, 'marks');
  const button = page.locator('#mark-buttons button').first();
  await button.scrollIntoViewIfNeeded();
  const { width, height } = await button.boundingBox();
  assert.ok(width >= 44 && height >= 44, `${width} x ${height}`);
  await button.click();
  await saidIs(page, /^Marked: “grasp”/);
  await saveScreenshot(page, 'marks_phone');
  await close();
});
