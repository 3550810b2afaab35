// Takes docs/golden_report.png: the report of a case to which a load in the hand was added.
// node docs/golden_report.mjs [PROGRAM]   (needs npm ci --prefix tests/browser, and Chromium)
import { execFile } from 'node:child_process';
import { appendFile, copyFile, mkdir, mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { closeBrowser, DESKTOP, openPage } from '../tests/browser/open_page.mjs';

const fileOf = (path) => fileURLToPath(new URL(path, import.meta.url));
const program = process.argv[2] ?? fileOf('../build/dev/bin/kinescope');
const folder = await mkdtemp(join(tmpdir(), 'kinescope-report-'));
const golden = (...words) => promisify(execFile)(program, ['golden', ...words], { cwd: folder, env: { ...process.env, CI: '' } });
try {
  await mkdir(join(folder, 'golden'));
  const file = join(folder, 'golden/lift_reach_iso.yaml');
  await copyFile(fileOf('../golden_images/lift_reach_iso.yaml'), file);
  await golden('update', 'golden');
  await appendFile(file, 'hand_load: right:3\n');
  const code = await golden('check', 'golden', '--out', 'run').then(() => 0, (error) => error.code);
  if (code !== 1) throw new Error(`the case must differ (exit code 1), but the exit code is ${code}`);
  const visit = await openPage(pathToFileURL(join(folder, 'run/report.html')).href, { viewport: DESKTOP });
  await visit.page.keyboard.press('j');
  await visit.page.screenshot({ path: fileOf('golden_report.png') });
  if (visit.problems.length > 0) throw new Error(visit.problems.join('\n'));
} finally {
  await closeBrowser();
  await rm(folder, { recursive: true, force: true });
}
