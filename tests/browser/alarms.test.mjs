// Alarms on the page: the line beside the lamp, acknowledging, sound, the list, both roles.
import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test as nodeTest } from 'node:test';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, openPage, PHONE, saveScreenshot, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const OPERATOR = '0perator-of-the-lab', VIEWER = 'v1ewer-of-the-lab';
const RULES = `lost_after: 1
rules:
  - {name: high <b>compression</b>, value: compression, above: 3400, for: 0.3, over_after: 0.3, priority: high}
  - {name: unsteady, value: margin, below: -1.9, priority: medium}
`;
let folder, rules;
const start = async () => {
  const site = await startFixture(['--token', OPERATOR, '--viewer_token', VIEWER, '--alarms', rules]);
  site.say('people 1');
  site.say('live');
  return site;
};
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'kinescope-alarms-'));
  rules = join(folder, 'rules.yaml');
  await writeFile(rules, RULES);
});
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true });
});

/** The first time of day in a text, s since midnight. */
const secsIn = (text) => {
  const [hours, minutes, secs] = text.match(/\d\d:\d\d:\d\d/)[0].split(':').map(Number);
  return 3600 * hours + 60 * minutes + secs;
};
/** When the oldest alarm of the list began. */
async function firstBeganAt(page) {
  await chooseTab(page, 'alarms');
  await page.waitForFunction(() => /^\d\d:/.test(document.querySelector('#alarm-list li:last-child small')?.textContent), null, LONG);
  return secsIn(await page.textContent('#alarm-list li:last-child small'));
}
const alarmIs = (page, state) => page.waitForFunction(
  (wanted) => document.getElementById('alarm').dataset.state === wanted, state, LONG);
const headIs = (page, pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('alarm-head').textContent), pattern.source, LONG);
const roleIs = (page, role) => page.waitForFunction(
  (wanted) => document.getElementById('role').dataset.role === wanted, role, LONG);
async function open(url, options) {
  const visit = await openPage(url, options);
  await visit.page.waitForFunction(() => !document.getElementById('alarm').hidden, null, LONG);
  return visit;
}

test('an alarm is shown with what, whose and how much, stays until an operator acknowledges, and is in the list', async () => {
  const site = await start();
  const { page, problems, close } = await open(site.url);
  await roleIs(page, 'operator');
  await alarmIs(page, 'none');
  assert.equal(await page.textContent('#alarm-head'), 'No alarm');
  await saveScreenshot(page, 'alarm_none_desktop');
  site.say('compression 3720');
  await alarmIs(page, 'on');
  assert.match(await page.textContent('#alarm-head'), /^\S.* 3\.72 kN compression$/);
  assert.match(await page.textContent('#alarm-detail'), /^high <b>compression<\/b>: limit 3\.40 kN · for \d+\.\d s$/);
  assert.equal(await page.textContent('#alarm-stars'), '***');
  assert.match(await page.textContent('#alarm-told'), /^Alarm, high: /);
  assert.equal(await page.locator('#alarm b').count(), 1, 'names are text, not markup');
  await saveScreenshot(page, 'alarm_on_desktop');
  site.say('compression 5000');
  await headIs(page, / 5\.00 kN compression$/);
  site.say('compression 2000');
  await alarmIs(page, 'over');
  await headIs(page, / 5\.00 kN compression$/);  // the worst
  await chooseTab(page, 'alarms');
  await page.waitForFunction(() => document.querySelectorAll('#alarm-list li').length === 1, null, LONG);
  assert.equal(await page.textContent('#tab-alarms'), 'Alarms (1)');
  assert.match(await page.textContent('#alarm-list small'), /lasted \d+\.\d s · .* · not acknowledged$/);
  await saveScreenshot(page, 'alarm_over_desktop');
  await page.keyboard.press('a');
  await alarmIs(page, 'none');
  await page.waitForFunction(() => /acknowledged by operator$/.test(document.querySelector('#alarm-list small')?.textContent), null, LONG);
  assert.match(await page.textContent('#alarm-detail'), /^last: .* 5\.00 kN compression, \d\d:\d\d:\d\d$/);
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
});

test('a click shows the moment when the alarm began, not the end of its delay', async () => {
  const site = await start();
  const { page, close } = await open(site.url);
  await page.waitForFunction(() => Number(document.getElementById('moment').min) < -1, null, LONG);
  site.say('compression 4000');
  await alarmIs(page, 'on');
  site.say('compression 2000');
  await alarmIs(page, 'over');
  const { began } = (await page.evaluate(async () => (await fetch('api/v1/alarms')).json())).alarms[0];
  await page.click('#alarm-show');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  await page.waitForFunction((micros) => Math.abs(1e6 * Number(new URL(location.href).searchParams.get('t')) - micros) < 10,
    began.micros, LONG);
  await page.waitForFunction(() => /4\.0/.test(document.getElementById('compression').textContent), null, LONG);
  await close();
  await site.stop();
});

test('a viewer sees and hears alarms, and cannot acknowledge them', async () => {
  const site = await start();
  const { page, close } = await open(site.viewer_url);
  await roleIs(page, 'viewer');
  site.say('compression 4000');
  await alarmIs(page, 'on');
  assert.ok(await page.locator('#acknowledge').isDisabled());
  await page.keyboard.press('a');
  const answer = await page.evaluate(async () => {
    const headers = { 'Content-Type': 'application/json' };
    return (await fetch('api/v1/acknowledge', { method: 'POST', headers, body: '{"id": 1}' })).status;
  });
  assert.equal(answer, 403);
  await alarmIs(page, 'on');
  await saveScreenshot(page, 'alarm_viewer_desktop');
  await close();
  await site.stop();
});

test('sound is blocked until a click, and says so; mute is silence with a countdown', async () => {
  const site = await start();
  // Playwright's questions count as gestures of the user: none may come before the page has tried to sound.
  let socket;
  const { page, close } = await openPage(site.url, { beforeLoad: (each) => { socket = each.waitForEvent('websocket', LONG); } });
  await socket;
  await page.waitForFunction(() => document.getElementById('alarm-sound').dataset.state === 'blocked', null, LONG);
  assert.equal(await page.textContent('#alarm-sound'), 'Sound blocked: click');
  const { x, y, width } = await page.locator('#alarm-sound').boundingBox();
  await page.mouse.move(x + width - 8, y + 8);  // the button stays there with its shorter text
  await page.mouse.down();
  await page.waitForFunction(() => document.getElementById('alarm-sound').dataset.state === 'on', null, LONG);
  await page.mouse.up();
  site.say('compression 4000');
  await page.waitForFunction(() => document.getElementById('alarm-sound').dataset.played === '1', null, LONG);
  await page.keyboard.press('s');
  await page.waitForFunction(() => /^Muted 1[12]\d s$/.test(document.getElementById('alarm-sound').textContent), null, LONG);
  await page.keyboard.press('s');
  await page.waitForFunction(() => document.getElementById('alarm-sound').dataset.state === 'on', null, LONG);
  await close();
  await site.stop();
});

test('a lost stream raises without a rule, on the phone, too, and ends by itself', async () => {
  const site = await start();
  const { page, close } = await open(site.url, { viewport: PHONE });
  await alarmIs(page, 'none');
  await saveScreenshot(page, 'alarm_none_phone');
  site.say('stale');
  await alarmIs(page, 'on');
  await headIs(page, /^Stream lost for \d+\.\d s$/);
  await saveScreenshot(page, 'alarm_lost_phone');
  site.say('live');
  await alarmIs(page, 'none');
  await close();
  await site.stop();
});

test('a page that is opened after the stream has stopped shows when an alarm began, as a page that was open then', async () => {
  const site = await start();
  const { page, close } = await open(site.url);
  site.say('compression 3720');
  await alarmIs(page, 'on');
  site.say('compression 2000');
  await alarmIs(page, 'over');
  const began = await firstBeganAt(page);
  site.say('stale');
  await page.waitForFunction(() => /last sample received ([5-9]|\d\d)/.test(document.getElementById('banner').textContent), null, LONG);
  const late = await open(site.url);
  const seen = await firstBeganAt(late.page);
  assert.ok(Math.abs(seen - began) <= 1, `${seen - began} s later`);
  await late.close();
  await close();
  await site.stop();
});

test('a server that is lost raises an alarm of the page itself, which sounds and ends by itself', async () => {
  const site = await start();
  const { page, close } = await open(site.url);
  await roleIs(page, 'operator');
  await page.keyboard.press('Shift');  // browsers sound only after a key or a click
  await alarmIs(page, 'none');
  process.kill(site.pid, 'SIGSTOP');
  await headIs(page, /^Alarms unknown$/);
  await alarmIs(page, 'on');
  await headIs(page, /^Server lost for \d+\.\d s$/);
  assert.equal(await page.getAttribute('#alarm', 'data-priority'), 'high');
  assert.equal(await page.textContent('#alarm-told'), 'Alarm, high: server lost');
  await page.waitForFunction(() => Number(document.getElementById('alarm-sound').dataset.played) === 1, null, LONG);
  await saveScreenshot(page, 'alarm_server_lost');
  await page.keyboard.press('a');
  await alarmIs(page, 'acknowledged');
  process.kill(site.pid, 'SIGCONT');
  await page.waitForFunction(() => !/^Server lost/.test(document.getElementById('alarm-head').textContent), null, LONG);
  await alarmIs(page, 'none');
  await close();
  await site.stop();
});

test('nothing of the page moves when an alarm begins', async () => {
  const site = await start();
  const { page, close } = await open(site.url, { viewport: DESKTOP });
  const places = () => page.evaluate(() => ['#view', '#transport', '#side', '#status', '#alarm', '#mark-buttons'].map((name) => {
    const { x, y, width, height } = document.querySelector(name).getBoundingClientRect();
    return [name, x, y, width, height].join(' ');
  }));
  await roleIs(page, 'operator');
  await page.waitForFunction(() => document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);
  const quiet = await places();
  site.say('compression 4000');
  await alarmIs(page, 'on');
  assert.deepEqual(await places(), quiet);
  await close();
  await site.stop();
});
