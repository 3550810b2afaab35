// The report of `kinescope loads`, opened and printed as a person would.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { closeBrowser, openPage, saveScreenshot } from './open_page.mjs';

let folder = '';
before(async () => { folder = await mkdtemp(join(tmpdir(), 'kinescope-report-')); });
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true, force: true });
});

test('the report of a person is one self-contained A4 page', async () => {
  const file = join(folder, 'report.html');
  await promisify(execFile)(process.env.KINESCOPE, ['loads', 'demo:lift', '--seconds', '8', '--hand_load', 'both:12',
    '--extra_mass', 'head:1.5,t8:8', '--mass', '82', '--sex', 'female', '--report', file]);
  const { page, problems, requests, close } = await openPage(`file://${file}`);
  await saveScreenshot(page, 'report');
  const pdf = join(folder, 'report.pdf');
  await page.pdf({ path: pdf, preferCSSPageSize: true, printBackground: true });
  const pages = (await readFile(pdf, 'latin1')).match(/\/Type\s*\/Page\b/g)?.length;
  assert.equal(pages, 1);
  assert.equal(requests.filter((url) => !url.startsWith('data:') && url !== `file://${file}`).length, 0);
  assert.deepEqual(problems, []);
  await close();
});
