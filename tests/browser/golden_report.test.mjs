// The report of a failing `golden check`, used as a person does: by mouse, by keys, and without scripts.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { appendFile, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { closeBrowser, DESKTOP, openPage, PHONE, saveScreenshot } from './open_page.mjs';

const run = promisify(execFile);
let folder = '', url = '';
const golden = (...args) => run(process.env.KINESCOPE, ['golden', ...args], { cwd: folder, env: { ...process.env, CI: '' } });

before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'kinescope-golden-'));
  for (const name of ['bend', 'reach', 'same']) {
    await writeFile(join(folder, `${name}.yaml`), 'source: demo:lift\ntime: 2\ncamera: right\nsize: 320x180\n');
  }
  await golden('update', '.');
  await appendFile(join(folder, 'bend.yaml'), 'hide: cop\n');
  await appendFile(join(folder, 'reach.yaml'), 'class_limits: 0.3,0.85\n');
  await writeFile(join(folder, 'broken.yaml'), 'source: nowhere.mvnx\nwhy: "<img src=x onerror=alert(1)>"\n');
  await assert.rejects(golden('check', '.', '--out', 'run'), { code: 2 });
  url = pathToFileURL(join(folder, 'run/report.html')).href;
});
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true, force: true });
});

for (const [name, viewport, colorScheme] of [['desktop', DESKTOP, 'light'], ['desktop_dark', DESKTOP, 'dark'], ['phone', PHONE, 'light']]) {
  test(`it fits, needs nothing else and says the worst first, on ${name}`, async () => {
    const { page, problems, close } = await openPage(url, { viewport, colorScheme });
    assert.match(await page.textContent('h1'), /^2 of 4 pictures differ, 1 could not be compared$/);
    const names = await page.$$eval('section.case h2', (all) => all.map((each) => each.textContent));
    assert.deepEqual(names, ['reach', 'bend', 'broken'], 'a class, what is missing, what could not be compared');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is beside the page');
    assert.equal(await page.locator('img').count(), 0, 'text from files stays text');
    await page.locator('section.case').first().scrollIntoViewIfNeeded();
    await saveScreenshot(page, `golden_report_${name}`);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('its keys go through the cases and collect the command that accepts', async () => {
  const { page, problems, close } = await openPage(url);
  await page.keyboard.press('j');
  await page.keyboard.press('4');
  const shown = page.locator('section.case.here');
  assert.equal(await shown.locator('h2').textContent(), 'reach');
  assert.ok(await shown.locator('.big').isVisible());
  assert.equal(await shown.locator('.big .label').textContent(), 'Difference');
  await page.keyboard.press('3');
  await shown.locator('.slide').fill('20');
  assert.match(await shown.locator('.over').evaluate((over) => over.style.clipPath), /20%/);
  await page.keyboard.press('1');
  assert.ok(await shown.locator('.pictures').isVisible());
  await page.keyboard.press('a');
  assert.equal(await page.textContent('#command'), 'kinescope golden accept run reach');
  await page.keyboard.press('r');
  assert.equal(await page.textContent('#decisions'), '2 of 2 decided');
  await page.keyboard.press('k');
  await page.keyboard.press('u');
  assert.equal(await page.textContent('#decisions'), '1 of 2 decided');
  await page.locator('section.case [data-decision=accept]').nth(1).click();
  const command = await page.textContent('#command');
  assert.equal(command, 'kinescope golden accept run reach bend');
  for (const [name, quoted] of [['it\'s; x', "'it'\\''s; x'"], ['-a', "'-a'"], ['a@0030.b', 'a@0030.b'], ['=a', "'=a'"], ['a_b-2', 'a_b-2']]) {
    assert.equal(await page.evaluate((text) => word(text), name), quoted, 'a shell takes it for a name');
  }
  assert.deepEqual(problems, []);
  await close();
  const { stdout } = await golden(...command.split(' ').slice(2));
  assert.match(stdout, /reach +accepted\nbend +accepted/);
});

test('without scripts it has the words, the pictures and the commands', async () => {
  const { page, close } = await openPage(url, { context: { javaScriptEnabled: false } });
  assert.equal(await page.locator('svg.shot image').count(), 6);
  assert.ok(await page.getByText('centre of pressure: is missing').first().isVisible());
  assert.ok(await page.getByText('kinescope golden accept run bend').isVisible());
  assert.ok(await page.locator('footer').isHidden());
  await close();
});
