// What operators do on the page of a real server to which a suit streams: trials, recordings, clips, people, limits.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, mkdir, readFile, rename, rm, stat } from 'node:fs/promises';
import { get } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test as nodeTest } from 'node:test';
import { promisify } from 'node:util';
import { startLab } from './lab.mjs';
import { chooseTab, closeBrowser, drawNothing, openPage, PHONE, saveScreenshot } from './open_page.mjs';

drawNothing();

const run = promisify(execFile);
const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 600000 }, body);
let folder, recordings, lab, suit;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'kinescope-controls-'));
  recordings = join(folder, 'recordings');
  await mkdir(recordings);
  lab = await startLab({ folder, options: ['--recordings_folder', recordings] });
  suit = lab.stream(['demo:lift', '--rate_hz', '60', '--seconds', '900']);
});
after(async () => {
  await suit.stop();
  await lab.stop();
  await closeBrowser();
  await rm(folder, { recursive: true });
});

async function openControls(url, options = {}) {
  const visit = await openPage(url, options);
  const { page } = visit;
  await chooseTab(page, 'controls');
  await page.waitForFunction(() => document.getElementById('limits-note').textContent !== '', null, LONG);
  return visit;
}
const openLive = async (url = lab.operator, options = { viewport: { width: 1000, height: 700 } }) => {
  const visit = await openControls(url, options);
  await visit.page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live'
    && document.getElementById('person-name').value !== '', null, LONG);
  return visit;
};
const textIs = (page, id, pattern) => page.waitForFunction(([wanted, source]) =>
  new RegExp(source).test(document.getElementById(wanted).textContent), [id, pattern.source], LONG);
const sampleOf = (page) => page.evaluate(() => Number(document.getElementById('sample').textContent));
const waitSamples = async (page, count) => {
  const from = await sampleOf(page);
  await page.waitForFunction((least) => Number(document.getElementById('sample').textContent) >= least, from + count, LONG);
};
const marksOf = async (page) => (await page.evaluate(async () => (await fetch('api/v1/marks')).json())).marks;
const changesOf = async (page) => (await marksOf(page)).filter(({ kind }) => kind === 'change').map(({ text }) => text);
const inspect = async (file) => JSON.parse((await run(process.env.KINESCOPE, ['inspect', file, '--json'])).stdout);

/** Length of an MP4 file, s.
 *  @param {Buffer} bytes */
function lengthOfMp4(bytes) {
  const at = bytes.indexOf('mvhd');
  assert.ok(at > 0, 'an MP4 file');
  return bytes.readUInt32BE(at + 20) / bytes.readUInt32BE(at + 16);
}

test('a study of eight trials is run from the page alone', async () => {
  // Not larger than needed, without the server's picture: the view is drawn in software here.
  const { page, problems, close } = await openLive(lab.operator, { viewport: { width: 900, height: 640 } });
  await chooseTab(page, 'picture');
  await page.uncheck('#picture-on');
  await chooseTab(page, 'controls');
  const study = ['S07', 'S08'].flatMap((person) => ['lift', 'carry far'].map((condition) => ({ person, condition })));
  for (const { person, condition } of study) {
    await page.fill('#trial-person', person);
    await page.fill('#trial-condition', condition);
    for (let number = 1; number <= 2; ++number) {
      const stem = `${person}_${condition.replace(' ', '_')}_00${number}`;
      assert.equal(await page.inputValue('#trial-number'), String(number), 'the next number is there');
      await page.click('#trial-run');
      await textIs(page, 'trial-note', new RegExp(`^Runs: ${person} · ${condition} · trial ${number}`));
      await waitSamples(page, 30);
      await page.click('#mark-buttons button:nth-child(2)');
      await waitSamples(page, 30);
      await page.click('#trial-run');
      await page.click(`#trial-list li[data-trial="${stem}"] button`, LONG);
    }
  }
  // Clips and reports have what the rest of the machine leaves: a busy one makes them late.
  await page.waitForFunction(() => document.querySelector('#job-list [data-state="failed"]') !== null
    || [...document.querySelectorAll('#trial-list li')].filter((item) => item.querySelectorAll('a').length === 3).length === 2 * 4,
  null, { timeout: 400000 });
  assert.equal(await page.locator('#job-list [data-state="failed"]').count(), 0, await page.textContent('#job-list'));
  await saveScreenshot(page, 'trials_desktop');
  const marks = await marksOf(page);
  for (const { person, condition } of study) {
    for (let number = 1; number <= 2; ++number) {
      const title = `${person} · ${condition} · trial ${number}`, stem = `${person}_${condition.replace(' ', '_')}_00${number}`;
      const span = marks.find(({ kind, text }) => kind === 'trial' && text === title);
      assert.ok(span?.end, title);
      const secs = (span.end.micros - span.at.micros) / 1e6;
      const inside = marks.filter(({ kind, at }) => kind === 'mark' && at.state >= span.at.state && at.state <= span.end.state);
      assert.deepEqual(inside.map(({ text }) => text), ['lift'], title);
      const about = JSON.parse(await readFile(join(recordings, `${stem}.json`), 'utf8'));
      assert.deepEqual([about.person, about.condition, about.number, about.recording_problem], [person, condition, number, '']);
      assert.ok(Math.abs(about.length_secs - secs) < 0.001, `${title}: ${secs} s, in its file ${about.length_secs} s`);
      const recorded = await inspect(join(recordings, `${stem}.pcapng`));
      // The recording has what arrives, the trial what has been processed: on a busy machine that is a little later.
      assert.ok(recorded.seconds > secs / 2 && recorded.seconds < secs + 2, `${title}: ${secs} s, recorded ${recorded.seconds} s`);
      const clip = lengthOfMp4(await readFile(join(recordings, `${stem}.mp4`)));
      assert.ok(Math.abs(clip - secs) < 0.1, `${title}: ${secs} s, clip of ${clip} s`);
      const report = await readFile(join(recordings, `${stem}.html`), 'utf8');
      assert.match(report, new RegExp(`${stem}\\.pcapng`));
      assert.match(report, /<b>Marks<\/b>.* \d lift \(\d/, 'what was marked, with its time');
      const capture = await readFile(join(recordings, `${stem}.pcapng`), 'latin1');
      assert.match(capture, /Kinescope mark: \{[^\n]*"text":"lift"/);
    }
  }
  const wait = page.waitForEvent('download');
  await page.click('#trial-list li[data-trial="S07_lift_001"] a:first-child');
  const file = await (await wait).path();
  assert.ok((await readFile(file)).equals(await readFile(join(recordings, 'S07_lift_001.mp4'))));
  assert.deepEqual(problems, []);
  await close();
});

test('a trial whose server was killed has its recording, and clip and report after the next start', async () => {
  const options = ['--recordings_folder', recordings];
  const first = await startLab({ folder, marks: 'crash.jsonl', options }), its = first.stream(['demo:lift', '--rate_hz', '60', '--seconds', '900']);
  const { page, close } = await openLive(first.operator);
  await page.fill('#trial-person', 'S20');
  await page.fill('#trial-condition', 'crash');
  await page.click('#trial-run');
  await textIs(page, 'trial-note', /^Runs: S20 · crash · trial 1/);
  await waitSamples(page, 60);
  await page.click('#mark-buttons button:nth-child(6)');
  await waitSamples(page, 120);
  await first.kill();
  await its.stop();
  await close();
  const second = await startLab({ folder, marks: 'crash.jsonl', options });
  const again = await openControls(second.operator);
  const entry = again.page.locator('#trial-list li[data-trial="S20_crash_001"]');
  await entry.waitFor(LONG);
  assert.match(await entry.textContent(), /the server ended before it was stopped/);
  await entry.getByRole('button').click();
  await again.page.waitForFunction(() => document.querySelectorAll('#trial-list li[data-trial="S20_crash_001"] a').length === 3
    || document.querySelector('#job-list [data-state="failed"]') !== null, null, LONG);
  assert.equal(await again.page.locator('#job-list [data-state="failed"]').count(), 0, await again.page.textContent('#job-list'));
  const recorded = await inspect(join(recordings, 'S20_crash_001.pcapng'));
  // 3 s, but for what was not written yet: the recorder writes five times a second, later on a busy machine.
  assert.ok(recorded.seconds >= 2.4, `${recorded.seconds} s recorded`);
  const clip = lengthOfMp4(await readFile(join(recordings, 'S20_crash_001.mp4')));
  assert.ok(Math.abs(clip - recorded.seconds) < 0.1, `recorded ${recorded.seconds} s, clip of ${clip} s`);
  assert.match(await readFile(join(recordings, 'S20_crash_001.html'), 'utf8'), /<b>Marks<\/b>.* \d slip \(\d/);
  await saveScreenshot(again.page, 'trial_after_crash');
  await again.close();
  await second.stop();
});

test('a recording begins with what the stream said before, and a viewer sees it and cannot stop it', async () => {
  const operator = await openLive(), viewer = await openControls(lab.viewer, { viewport: PHONE });
  await operator.page.fill('#recording-label', '../../warm up');
  await operator.page.click('#recording-run');
  await textIs(operator.page, 'recording-note', /^Recording warm_up_.*: 0:0[1-9], .* free, enough for/);
  await textIs(viewer.page, 'recording-note', /^Recording warm_up_/);
  for (const id of ['trial-run', 'recording-run', 'clip-last', 'person-mass', 'hands-right', 'limits-medium']) {
    assert.ok(await viewer.page.locator(`#${id}`).isDisabled(), id);
  }
  await viewer.page.waitForFunction(() => document.querySelectorAll('#file-list li').length > 0, null, LONG);
  assert.equal(await viewer.page.locator('#file-list a').count(), 0);
  await saveScreenshot(viewer.page, 'controls_viewer_phone');
  await operator.page.click('#recording-run');
  await textIs(operator.page, 'recording-note', /^Saved warm_up_/);
  const name = /Saved (\S+):/.exec(await operator.page.textContent('#recording-note'))[1];
  const [person] = (await inspect(join(recordings, name))).characters;
  assert.equal(person.name, 'Demo');
  assert.deepEqual([...operator.problems, ...viewer.problems], []);
  await operator.close();
  await viewer.close();
});

test('clips are of the last or the next seconds, or of a time that was looked at; longer than the history is refused', async () => {
  const { page, close } = await openLive();
  const ends = (count) => page.waitForFunction((wanted) =>
    [...document.querySelectorAll('#job-list li')].filter((item) => item.dataset.state === 'done'
      && item.textContent.startsWith('clip_')).length >= wanted, count, LONG);
  await page.fill('#clip-secs', '1.5');
  await page.click('#clip-last');
  await page.click('#clip-next');
  await ends(2);
  await page.keyboard.press('Escape');
  await page.click('#play');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  await page.click('#clip-begin');
  await textIs(page, 'clip-note', /^Begins at sample \d+/);
  const sample = await sampleOf(page);
  for (let step = 1; step <= 12; ++step) {
    await page.click('#step-back');
    await page.waitForFunction((wanted) => document.getElementById('sample').textContent === String(wanted), sample - step, LONG);
  }
  await page.click('#clip-end');
  await textIs(page, 'clip-note', /^Clip of 0:0\d\.\d$/);
  const marked = Number((await page.textContent('#clip-note')).slice(-3));  // s on the server's clock: on a busy machine not 12/60
  await ends(3);
  await page.fill('#clip-secs', '600');
  await page.click('#clip-last');
  await textIs(page, 'banner', /^Could not make the clip: the last 600 s are more than is kept/);
  await page.click('#clip-next');
  await page.click('#job-list button');
  await page.waitForFunction(() => document.querySelector('#job-list li')?.dataset.state === 'cancelled', null, LONG);
  const { files } = await page.evaluate(async () => (await fetch('api/v1/files')).json());
  const lengths = await Promise.all(files.filter(({ name }) => name.startsWith('clip_'))
    .map(async ({ name }) => lengthOfMp4(await readFile(join(recordings, name)))));
  const expected = [marked, 1.5, 1.5].sort(), rest = lengths.sort().map((secs, i) => Math.abs(secs - expected[i]));
  assert.ok(lengths.length === 3 && rest.every((secs) => secs < 0.1), `${lengths} for ${expected}`);
  await close();
});

test('the person, the hand loads and the class limits are changed for all, and each change is a mark', async () => {
  const { page, problems, close } = await openLive(), other = await openLive(lab.viewer);
  await textIs(page, 'person-note', /mass assumed · sex assumed/);
  await page.fill('#person-mass', '82.5');
  await page.selectOption('#person-sex', 'female');
  await page.fill('#person-name', '<b>Ann</b>');
  await page.click('#person-form button');
  await textIs(page, 'person-note', /Name set by an operator · mass set by an operator · sex set by an operator/);
  await other.page.waitForFunction(() => document.getElementById('person-mass').value === '82.5'
    && document.getElementById('person-name').value === '<b>Ann</b>', null, LONG);
  await page.fill('#person-height', '1.90');
  await page.click('#person-form button');
  await textIs(page, 'person-note', /stature as stated; the lengths .* give \d\.\d\d m$/);
  await page.fill('#hands-both', '10');
  await page.click('#hands-form button');
  await textIs(page, 'hands-note', /^Held now: 10 kg in both hands, since \d\d:\d\d:\d\d \(operator\)/);
  await page.fill('#hands-both', '0');
  await page.fill('#hands-right', '5');
  await page.click('#hands-form button');
  await textIs(other.page, 'hands-note', /^Held now: 5 kg right, since/);
  await page.fill('#hands-right', '0');
  await page.fill('#hands-left', '3');
  await page.click('#hands-form button');
  await textIs(other.page, 'hands-note', /^Held now: 3 kg left, since/);
  await page.fill('#limits-medium', '12.5');
  await page.fill('#limits-high', '40');
  await page.click('#limits-form button');
  await textIs(page, 'limits-note', /^Medium above 12\.5 %, high above 40 %.*set by an operator/);
  await textIs(other.page, 'legend', /12\.5 %[^]*40 %/);
  await page.fill('#limits-medium', '50');
  await page.click('#limits-form button');
  await textIs(page, 'banner', /class limits 0\.5,0\.4: expected MEDIUM,HIGH: two rising numbers/);
  await chooseTab(page, 'picture');
  await page.selectOption('#picture-camera', 'top');
  const wanted = ['mass of Demo: 75 kg → 82.5 kg', 'sex of Demo: male → female', 'name of person 0: Demo → <b>Ann</b>',
    'stature of <b>Ann</b>: 1.75 m → 1.9 m', 'hand load of <b>Ann</b>: unknown → 10 kg in both',
    'hand load of <b>Ann</b>: 10 kg in both → 5 kg right', 'hand load of <b>Ann</b>: 5 kg right → 3 kg left',
    'class limits: 30 % and 60 % → 12.5 % and 40 %', 'camera of the server picture: three_quarter → top'];
  await page.waitForFunction(async (count) => (await (await fetch('api/v1/marks')).json()).marks
    .filter(({ kind, text }) => kind === 'change' && !text.startsWith('recording')).length === count, wanted.length, LONG);
  assert.deepEqual((await changesOf(page)).filter((text) => !text.startsWith('recording')), wanted);
  await chooseTab(other.page, 'marks');
  await other.page.waitForFunction(() => document.querySelector('#mark-list li[data-kind="change"] kbd')?.textContent === '✎'
    && document.querySelector('#mark-list li[data-kind="change"] fieldset')?.hidden, null, LONG);
  await saveScreenshot(other.page, 'change_marks_desktop');
  assert.deepEqual([...problems.filter((line) => !line.includes('400')), ...other.problems], []);
  await close();
  await other.close();
});

test('a missing folder and a name that leads out of it are refused, and the stream stays live', async () => {
  const { page, close } = await openLive();
  await rename(recordings, `${recordings}.away`);
  await page.click('#recording-run');
  await textIs(page, 'banner', /^Could not start the recording: the folder of recordings, .*, is missing; make it, or connect/);
  await page.fill('#trial-person', 'S09');
  await page.fill('#trial-condition', 'lift');
  await page.click('#trial-run');
  await textIs(page, 'banner', /^Could not start the trial: the folder of recordings/);
  await rename(`${recordings}.away`, recordings);
  await textIs(page, 'status-word', /^Live$/);
  for (const path of ['../marks.jsonl', '..%2fmarks.jsonl', '%2e%2e/marks.jsonl', '..%252fmarks.jsonl', '/etc/passwd', '%2fetc%2fpasswd',
    '..%5cmarks.jsonl', 'x%00.pcap', '.hidden.pcap', '']) {
    const status = await new Promise((resolve) => {
      get(`${lab.page}api/v1/file/x`, { path: `/api/v1/file/${path}`, headers: { Authorization: `Bearer ${lab.token}` } },
        (answer) => resolve(answer.resume().statusCode));
    });
    assert.ok(status === 404 || status === 400, `${path}: ${status}`);
  }
  await close();
});

test('a full disk ends a recording with a reason, what was recorded stays, and the stream goes on', async (t) => {
  const disk = join(folder, 'disk');
  await mkdir(disk);
  const shell = (command) => `exec unshare --map-root-user --mount sh -c "mount -t tmpfs -o size=34m none ${disk} && ${command}"`;
  const isPermitted = await run('sh', ['-c', shell('true')]).then(() => true, () => false);
  if (!isPermitted) return t.skip('no file systems of our own here: unshare or mount is not permitted');
  const small = await startLab({ folder, marks: 'small.jsonl', options: ['--recordings_folder', disk], shell });
  const fast = small.stream(['demo:lift', '--rate_hz', '240', '--seconds', '300']);
  const { page, close } = await openLive(small.operator);
  await page.click('#recording-run');
  await textIs(page, 'recording-note', /: the disk is full: recording stopped while .* kept for marks; what was recorded is saved/);
  await textIs(page, 'status-word', /^(Live|Losing data.*)$/);
  const wait = page.waitForEvent('download');
  await page.click('#file-list a');
  const file = join(folder, 'full.pcap');
  await (await wait).saveAs(file);
  assert.ok((await stat(file)).size > 500000);
  assert.ok((await inspect(file)).seconds > 0.5);
  await page.click('#recording-run');
  await textIs(page, 'banner', /^Could not start the recording: the disk is full: .* MB are free/);
  await saveScreenshot(page, 'disk_full_desktop');
  await fast.stop();
  await small.stop();
  await close();
});

test('a source that is not a live stream is not recorded, and its trials have clips', async () => {
  const demo = await startLab({ source: 'demo:lift', folder, marks: 'demo.jsonl', options: ['--recordings_folder', recordings] });
  const { page, close } = await openLive(demo.operator);
  await textIs(page, 'recording-note', /^Not possible: the source demo:lift is not a live stream over UDP or TCP/);
  await page.fill('#trial-person', 'Nobody');
  await page.fill('#trial-condition', 'demo');
  await page.click('#trial-run');
  await textIs(page, 'trial-note', /^Runs: /);
  await waitSamples(page, 60);
  await page.click('#trial-run');
  await page.click('#trial-list li[data-trial="Nobody_demo_001"] button', LONG);
  await page.waitForFunction(() => document.querySelector('#trial-list li[data-trial="Nobody_demo_001"] a')?.textContent === 'clip',
    null, LONG);
  await demo.stop();
  await close();
});
