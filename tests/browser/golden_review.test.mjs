// `golden review` of a failing run, as a person does it: by keys, on the page that it serves.
import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { once } from 'node:events';
import { appendFile, cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, afterEach, before, beforeEach, test } from 'node:test';
import { promisify } from 'node:util';
import { closeBrowser, DESKTOP, endWithTests, openPage, PHONE, saveScreenshot } from './open_page.mjs';

const run = promisify(execFile);
const env = { ...process.env, CI: '' };
let failing = '', folder = '';  // a run that fails, and the copy of it that the test reviews
const golden = (...args) => run(process.env.KINESCOPE, ['golden', ...args], { cwd: folder, env });
const fileOf = (name) => readFile(join(folder, name));
const lock = async () => JSON.parse(await fileOf('golden.lock')).cases;

const newFolder = () => mkdtemp(join(tmpdir(), 'kinescope-review-'));
before(async () => {
  failing = folder = await newFolder();
  for (const name of ['bend', 'reach', 'same', 'title']) {
    await writeFile(join(folder, `${name}.yaml`), 'source: demo:lift\ntime: 2\ncamera: right\nsize: 320x180\n');
  }
  await golden('update', '.');
  await appendFile(join(folder, 'bend.yaml'), 'hide: cop\n');
  await appendFile(join(folder, 'reach.yaml'), 'class_limits: 0.3,0.85\n');
  await appendFile(join(folder, 'title.yaml'), 'title: new\n');
  await writeFile(join(folder, 'broken.yaml'), 'source: nowhere.mvnx\nwhy: "<img src=x onerror=alert(1)>"\n');
  await assert.rejects(golden('check', '.', '--out', 'run'), { code: 2 });
});
beforeEach(async () => {
  folder = await newFolder();
  await cp(failing, folder, { recursive: true });
});
afterEach(() => rm(folder, { recursive: true, force: true }));
after(async () => {
  await closeBrowser();
  await rm(failing, { recursive: true, force: true });
});

/** The command under way: the address of its page, and its end. */
async function startReview() {
  const child = spawn(process.env.KINESCOPE, ['golden', 'review', 'run'], { cwd: folder, env, stdio: ['ignore', 'pipe', 'inherit'] });
  endWithTests(child);
  const lines = [];
  const reader = createInterface({ input: child.stdout }).on('line', (line) => lines.push(line));
  const ended = once(child, 'close');
  await Promise.race([once(reader, 'line'), ended]);
  return {
    url: lines[0],
    /** Its exit code and what it has printed. */
    async end(signal) {
      if (signal) child.kill(signal);
      const [code] = await ended;
      return { code, text: lines.join('\n') };
    },
  };
}

/** Presses a key, and waits for what the page says then. */
async function press(page, key, said) {
  await page.keyboard.press(key);
  await page.waitForFunction((text) => document.getElementById('said').textContent.includes(text), said);
}
const here = (page) => page.textContent('section.case.here h2');
const outcomes = (page) => page.$$eval('section.case:has(.decide)', (all) => Object.fromEntries(
  all.map((each) => [each.dataset.name, each.querySelector('.outcome').textContent])));

test('by keys alone: accept, later, undo, reject, a reload, finish', async () => {
  const review = await startReview();
  const { page, problems, close } = await openPage(review.url);
  const before = { lock: await lock(), reach: await fileOf('reach.png'), bend: await fileOf('bend.png') };
  assert.equal(await page.locator('img').count(), 0, 'text from files stays text');

  await page.keyboard.press('a');
  assert.equal(await here(page), 'reach', 'a key decides about a marked case only; the first one marks it');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.name), 'reach');
  await press(page, 'a', 'reach: accepted');
  assert.deepEqual(await fileOf('reach.png'), await fileOf('run/reach.actual.png'), 'it is written at once');
  assert.notDeepEqual((await lock()).reach, before.lock.reach);
  assert.deepEqual((await lock()).bend, before.lock.bend, 'and no other');
  assert.equal(await here(page), 'bend');
  await press(page, 'l', 'bend: later');
  await press(page, 'r', 'title: rejected');
  assert.deepEqual(await outcomes(page), { reach: 'accepted', bend: 'later', title: 'rejected' });

  await page.reload();
  await page.waitForFunction(() => document.getElementById('decisions').textContent === '3 of 3 decided');
  assert.deepEqual(await outcomes(page), { reach: 'accepted', bend: 'later', title: 'rejected' });
  assert.deepEqual(await page.$$eval('td[data-decision-of]', (all) => all.map((each) => each.textContent)),
    ['accepted', 'later', 'rejected', '']);
  await page.keyboard.press('j');
  await press(page, 'u', 'reach: undecided');
  assert.deepEqual(await fileOf('reach.png'), before.reach, 'undo restores the picture');
  assert.deepEqual(await lock(), before.lock, 'and its part of golden.lock');
  assert.ok(await page.locator('#finish').isHidden(), 'not while a case is undecided');
  await page.keyboard.press('f');
  await press(page, 'a', 'reach: accepted');
  await press(page, 'f', 'The review has ended: 1 accepted, 1 rejected, 1 later.');
  assert.deepEqual(problems, []);
  await close();
  const { code, text } = await review.end();
  assert.equal(code, 1);
  assert.match(text, /bend +later\nreach +accepted\ntitle +rejected\nbroken +has no picture/);
  assert.deepEqual(await fileOf('bend.png'), before.bend);
});

test('by buttons, and another review goes on with what is left', async () => {
  const first = await startReview();
  const visit = await openPage(first.url);
  const button = (page, name, decision) => page.locator(`section[data-name=${name}] [data-decision=${decision}]`);
  await button(visit.page, 'bend', 'later').click();
  await visit.page.waitForSelector('section[data-name=bend] .outcome.later');
  assert.equal(await button(visit.page, 'bend', 'later').getAttribute('aria-pressed'), 'true');
  await visit.close();
  assert.equal((await first.end('SIGINT')).code, 1);

  const second = await startReview();
  const { page, problems, close } = await openPage(second.url);
  await page.waitForSelector('section[data-name=bend] .outcome.later');
  for (const name of ['bend', 'reach', 'title']) {
    await button(page, name, 'accept').click();
    await page.waitForSelector(`section[data-name=${name}] .outcome.accepted`);
  }
  await page.click('#finish');
  await page.waitForFunction(() => document.getElementById('said').textContent.startsWith('The review has ended'));
  assert.deepEqual(problems, []);
  await close();
  await second.end();
  await rm(join(folder, 'broken.yaml'));
  await golden('check', '.', '--strict', '--out', 'again');
});

test('a key that comes before what was decided earlier is known is not lost', async () => {
  const review = await startReview();
  const { page, close } = await openPage(review.url);
  let answer = () => {};
  const isPressed = new Promise((resolve) => { answer = resolve; });
  await page.route('**/decisions', async (route) => {
    if (route.request().method() === 'GET') await isPressed;
    await route.continue();
  });
  await page.reload({ waitUntil: 'commit' });
  await page.waitForFunction(() => document.readyState === 'complete');
  await page.keyboard.press('j');
  await page.keyboard.press('a');
  answer();
  await page.waitForFunction(() => document.getElementById('said').textContent.includes('reach: accepted'));
  await close();
  await review.end('SIGTERM');
});

test('a case says why it was not accepted, and the others go on', async () => {
  const review = await startReview();
  const { page, close } = await openPage(review.url);
  await appendFile(join(folder, 'reach.yaml'), 'mass: 90\n');
  await page.keyboard.press('j');
  await press(page, 'a', 'reach: not accepted: its case is not that of the run (mass: added, 90)');
  assert.equal(await here(page), 'reach', 'the case stays in view');
  await page.keyboard.press('j');
  await press(page, 'a', 'bend: accepted');
  assert.match((await outcomes(page)).reach, /^not accepted: its case is not that of the run/);
  await review.end('SIGTERM');
  await page.keyboard.press('k');
  await press(page, 'r', 'continue it with: kinescope golden review run');
  assert.equal((await outcomes(page)).bend, 'accepted');
  await close();
});

for (const [name, viewport, colorScheme] of [['desktop', DESKTOP, 'light'], ['desktop_dark', DESKTOP, 'dark'], ['phone', PHONE, 'light']]) {
  test(`it fits and can be read, on ${name}`, async () => {
    const review = await startReview();
    const { page, problems, close } = await openPage(review.url, { viewport, colorScheme });
    await saveScreenshot(page, `golden_review_${name}_start`);
    await page.keyboard.press('j');
    await press(page, 'a', 'reach: accepted');
    await press(page, 'l', 'bend: later');
    await saveScreenshot(page, `golden_review_${name}`);
    await press(page, 'r', 'All are decided');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is beside the page');
    const { violations, passes } = await page.evaluate(`${await readFile(createRequire(import.meta.url).resolve('axe-core'), 'utf8')};
      axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] })`);
    assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ failureSummary }) => failureSummary).join('; ')}`), []);
    assert.ok(passes.some(({ id }) => id === 'color-contrast'), 'it was looked at');
    await page.keyboard.press('k');
    await saveScreenshot(page, `golden_review_${name}_end`);
    assert.deepEqual(problems, []);
    await close();
    await review.end('SIGINT');
  });
}
