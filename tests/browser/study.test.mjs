// The page of a study, used as a person does: 24 trials, 5,000 trials, a phone, print, and without scripts.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdir, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { closeBrowser, DESKTOP, openPage, PHONE, saveFile, saveScreenshot } from './open_page.mjs';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const run = promisify(execFile);
const CONDITIONS = ['6 kg', '14 kg'];
let folder = '';
/** @type {Record<string, any>} by condition, what `kinescope loads` says of a lift */
const lifts = {};

/** A trial like the lift of its condition, a little heavier or lighter. @param {number} number */
function trialOf(number, people) {
  const person = `P${String(number % people + 1).padStart(people > 99 ? 3 : 2, '0')}`;
  const condition = CONDITIONS[Math.floor(number / people) % 2];
  const trial = structuredClone(lifts[condition]);
  const factor = 0.8 + 0.4 * ((number * 0.618) % 1);
  for (const joint of trial.people[0].exposure) {
    const { samples } = joint;
    const moved = Math.min(samples.low, Math.round(samples.high * (factor - 0.8)));
    samples.low -= moved;
    samples.high += moved;
    for (const name of ['p10', 'p50', 'p90', 'peak_ratio']) if (joint[name] !== null) joint[name] *= factor;
  }
  return { person, condition, repetition: String(Math.floor(number / people / 2) + 1), trial };
}

/** Results of `count` trials as `batch` would have written them; every 7th has failed. */
async function writeStudy(name, count, people) {
  await mkdir(join(folder, name));
  const lines = [];
  for (let i = 0; i < count; ++i) {
    const { person, condition, repetition, trial } = trialOf(i, people);
    const id = `${person}-${condition.replace(' ', '')}-${repetition}`;
    const hasFailed = i % 7 === 6;
    if (!hasFailed) await writeFile(join(folder, name, `${id}.json`), JSON.stringify(trial));
    if (!hasFailed && count < 100) await writeFile(join(folder, name, `${id} <page>.html`), '');
    const stamp = { files: 1, bytes: 1, modified_ns: 1 };
    lines.push(JSON.stringify({
      id, state: hasFailed ? 'failed' : 'done', command: 'loads', labels: { person, condition, repetition }, seconds: 1, cpu_seconds: 1,
      reason: hasFailed ? `${id}.mvnx:${400 + i}: ${i % 14 === 6 ? 'file ends inside <frame>' : 'no such file'}` : '', peak_memory_bytes: 1,
      started: '2026-11-20T10:00:00.000Z', host: 'lab', attempts: 1, job_sha256: '',
      outputs: hasFailed ? [] : [{ option: 'json', kind: 'file', path: `${id}.json`, ...stamp, sha256: '' },
        { option: 'report', kind: 'file', path: `${id} <page>.html`, ...stamp, sha256: '' }],
      inputs: [{ path: `${id}.mvnx`, ...stamp }],
    }));
  }
  await writeFile(join(folder, name, 'trials.results.jsonl'), `${lines.join('\n')}\n`);
  const page = join(folder, name, 'study.html');
  const { stdout } = await run(process.env.KINESCOPE, ['study', join(folder, name, 'trials.results.jsonl'), '--report', page, '--csv',
    join(folder, name, 'study.csv'), '--title', 'Lifting 6 and 14 kg']).catch((error) => {
    assert.equal(error.code, 1, error.stderr);
    return error;
  });
  return { url: pathToFileURL(page).href, stdout };
}

let small = { url: '', stdout: '' }, large = small;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'kinescope-study-'));
  for (const condition of CONDITIONS) {
    const { stdout } = await run(process.env.KINESCOPE, ['loads', 'demo:lift', '--mass', '80', '--sex', 'male', '--hand_load',
      `both:${parseFloat(condition) / 2}`, '--samples', 'none', '--json', '-']);
    lifts[condition] = JSON.parse(stdout);
  }
  small = await writeStudy('small', 24, 4);
  large = await writeStudy('large', 5000, 80);
});
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true, force: true });
});

for (const [name, viewport, colorScheme] of [['desktop', DESKTOP, 'light'], ['desktop_dark', DESKTOP, 'dark'], ['phone', PHONE, 'light']]) {
  test(`it fits, needs nothing else and can be read by everyone, on ${name}`, async () => {
    const { page, problems, close } = await openPage(small.url, { viewport, colorScheme });
    assert.equal(await page.textContent('h1'), 'Lifting 6 and 14 kg');
    assert.match(await page.textContent('header p'), /^24 trials of 4 people in 2 conditions: 21 with loads, 3 jobs failed$/);
    assert.equal(await page.locator('.panels button').count(), 15);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is beside the page');
    await saveScreenshot(page, `study_${name}`);
    if (name === 'phone') await saveFile('study_phone_whole.png', await page.screenshot({ fullPage: true }));
    await page.addScriptTag({ path: axe });
    const { violations } = await page.evaluate(() => globalThis.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa'] }));
    assert.deepEqual(violations.filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(' | ')}`), []);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('it filters, sorts, groups, and shows a trial with its files', async () => {
  const { page, problems, close } = await openPage(small.url);
  const ids = () => page.$$eval('.rows .row > b', (all) => all.map((each) => each.textContent));
  const hits = () => page.textContent('.hits');
  await page.keyboard.press('/');
  await page.keyboard.type('P02');
  await page.keyboard.press('Escape');
  assert.equal(await hits(), '6 of 24 trials');
  assert.deepEqual((await ids()).slice(0, 2), ['P02-6kg-1', 'P02-6kg-2'], 'numbers are sorted as numbers');
  await page.click('.filters .clear');
  await page.click('[data-choice=condition] [data-value="0"]');
  assert.equal(await hits(), '12 of 24 trials');
  await page.click('.filters .clear');
  assert.equal(await hits(), 'all 24 trials');

  // The joint that is most loaded first, with the number that the file has.
  await page.click('.panels [data-joint="0"]');
  const top = (await ids())[0];
  const { people: [loads] } = JSON.parse(await readFile(join(folder, 'small', `${top}.json`), 'utf8'));
  const share = 100 * loads.exposure[0].samples.high / loads.samples;
  assert.match(await page.locator('.rows .row').first().locator('.strip i').first().getAttribute('title'), new RegExp(`: ${share.toFixed(1)}$`));
  await page.locator('.rows .row > b').first().click();
  assert.match(await page.textContent('.trial h2'), new RegExp(`^${top} done$`));
  assert.match(await page.textContent('.trial dl'), /80 kg/);
  assert.equal(await page.locator('.trial .links a').nth(1).getAttribute('href'), `${top}%20%3Cpage%3E.html`);
  await page.keyboard.press('ArrowDown');
  assert.equal(await page.textContent('.trial h2'), `${(await ids())[1]} done`);

  await page.click('[data-tab=people]');
  assert.equal(await page.locator('.rows .row').count(), 8, 'four people with two conditions');
  await page.locator('.rows .row > b').first().click();
  assert.match(await hits(), /^3 of 24 trials$/);

  await page.click('.filters .clear');
  await page.click('[data-choice=state] [data-value=without]');
  assert.equal(await hits(), '3 of 24 trials');
  assert.match(await page.locator('.rows .row').first().textContent(), /failed.*\.mvnx:\d+: /);
  await page.click('.filters .clear');
  await page.locator('.failures li', { hasText: 'file ends inside' }).locator('button').click();
  assert.equal(await hits(), '2 of 24 trials', 'those of one reason');
  await page.fill('[type=search]', 'nobody');
  assert.match(await page.textContent('.rows'), /^No trial matches/);
  await page.click('.rows .clear');
  await page.fill('.least', '1e9');
  assert.equal(await hits(), '0 of 24 trials');
  assert.deepEqual(problems, []);
  await close();
});

test('of 5,000 trials it draws the rows in sight', async () => {
  const { page, problems, close } = await openPage(large.url);
  assert.match(await page.textContent('header p'), /^5000 trials of 80 people in 2 conditions: 4286 with loads, 714 jobs failed$/);
  const rows = () => page.locator('.rows .row').count();
  assert.ok(await rows() <= 60, `${await rows()} rows`);
  await page.locator('.scroll').evaluate((list) => { list.scrollTop = list.scrollHeight; });
  await page.getByText(/^P80-14kg-3[01]$/).first().waitFor();
  assert.ok(await rows() <= 60, `${await rows()} rows`);
  await page.click('[data-choice=measure] [data-value="1"]');
  await page.click('[data-tab=people]');
  await saveScreenshot(page, 'study_5000');
  assert.ok(await rows() <= 60, `${await rows()} rows`);
  assert.deepEqual(problems, []);
  await close();
});

test('it is printed with its tables, and has one without scripts', async () => {
  const { page, close } = await openPage(small.url, { context: { javaScriptEnabled: false } });
  assert.equal(await page.locator('noscript tbody tr').count(), 8);
  assert.match(await page.textContent('noscript'), /Left ankle/);
  await close();
  const printed = await openPage(small.url);
  const pdf = await printed.page.pdf({ preferCSSPageSize: true });
  await saveFile('study.pdf', pdf);
  await printed.close();
  await writeFile(join(folder, 'study.pdf'), pdf);
  const { stdout } = await run('pdftotext', ['-layout', join(folder, 'study.pdf'), '-']);
  assert.match(stdout, /P04-14kg-3/, 'the last trial, too');
  assert.match(stdout, /Conditions by joint/);
});
