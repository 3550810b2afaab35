// Looking back: each viewer has a time of their own, while the stream goes on.
import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, before, test as nodeTest } from 'node:test';
import { promisify } from 'node:util';
import { decodeState, KIND } from '../../web/state_codec.js';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, endWithTests, keepWords, openPage, PHONE, pixelsOf, saveScreenshot, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
let site;
before(async () => {
  site = await startFixture();
  site.say('people 1');
  site.say('live');
});
after(async () => {
  await site.stop();
  await closeBrowser();
});

const text = (page, id) => page.textContent(`#${id}`);
const sampleOf = async (page) => Number(await text(page, 'sample'));
const statusIs = (page, pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('status-word').textContent), pattern.source, LONG);
const sampleIs = (page, number) => page.waitForFunction(
  (wanted) => document.getElementById('sample').textContent === String(wanted), number, LONG);

/** Until the server has `seconds` of history. */
async function openLive(seconds = 1, options = {}) {
  const visit = await openPage(site.url, options);
  await statusIs(visit.page, /^Live$/);
  await visit.page.waitForFunction(
    (least) => Number(document.getElementById('moment').min) < -least, seconds, LONG);
  return visit;
}

test('a paused page stays at its sample while the stream goes on, says so, and steps by samples', async () => {
  const { page, problems, close } = await openLive();
  await page.keyboard.press('Space');
  await statusIs(page, /^Behind −\d+\.\d s$/);
  const sample = await sampleOf(page);
  assert.equal(await page.getAttribute('body', 'data-time'), 'behind');
  await statusIs(page, /^Behind −[1-9]/);
  assert.equal(await sampleOf(page), sample);
  assert.match(await page.title(), /^Behind −/);
  await page.keyboard.press('ArrowLeft');
  await sampleIs(page, sample - 1);
  await page.keyboard.press('ArrowLeft');
  await sampleIs(page, sample - 2);
  await page.click('#step-forward');
  await sampleIs(page, sample - 1);
  await saveScreenshot(page, 'behind_desktop');
  await chooseTab(page, 'picture');
  await page.locator('#picture-image').waitFor({ state: 'visible', ...LONG });  // of this moment
  const asked = page.waitForRequest(/snapshot\.png\?state=\d+&.*width=1920/);
  await page.click('#save-picture');
  await asked;
  await page.keyboard.press('Escape');
  await statusIs(page, /^Live$/);
  await page.waitForFunction((n) => Number(document.getElementById('sample').textContent) > n + 60, sample, LONG);
  assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  assert.deepEqual(problems, []);
  await close();
});

test('Escape and the lamp return to live without waiting for the server', async () => {
  const { page, close } = await openLive();
  for (const act of [() => page.keyboard.press('Escape'), () => page.click('#status')]) {
    await page.click('#play');
    await statusIs(page, /^Behind/);
    await page.evaluate(() => {
      const word = document.getElementById('status-word');
      window.wordAfter = undefined;
      const look = () => { window.wordAfter = word.textContent; };
      // The window is asked last, after the page's own listeners, and before the next frame, timer or message.
      for (const kind of ['keydown', 'click']) addEventListener(kind, look, { once: true });
    });
    await act();
    await page.waitForFunction(() => window.wordAfter !== undefined, null, LONG);
    assert.equal(await page.evaluate(() => window.wordAfter), 'Live');
  }
  await close();
});

test('two viewers are at different moments, and a third is live', async () => {
  const [one, two, three] = [await openLive(), await openLive(2), await openLive()];
  await one.page.keyboard.press('Space');
  await statusIs(one.page, /^Behind/);
  await two.page.keyboard.press('Home');
  await statusIs(two.page, /^Behind/);
  const first = await sampleOf(one.page);
  await two.page.waitForFunction(
    (newer) => Number(document.getElementById('sample').textContent) < newer, first, LONG);
  await three.page.waitForFunction(
    (older) => Number(document.getElementById('sample').textContent) > older + 30, first, LONG);
  assert.equal(await sampleOf(one.page), first);
  assert.equal(await three.page.getAttribute('body', 'data-time'), 'live');
  for (const each of [one, two, three]) await each.close();
});

for (const [layout, viewport] of [['desk', DESKTOP], ['phone', PHONE], ['wall', { width: 1280, height: 720 }], ['kiosk', { width: 1280, height: 800 }]]) {
  test(`two viewers have times and cameras of their own, and a third is live, in the layout ${layout}`, async () => {
    const { page: past, close } = await openLive(2);
    await past.keyboard.press('Space');
    await past.waitForFunction(() => new URL(location.href).searchParams.has('t'), null, LONG);
    const t = Number(new URL(past.url()).searchParams.get('t')), first = await sampleOf(past);
    await close();
    const open = (query, isDrawn) => openPage(`${site.url}?view=${layout}&${query}`, { viewport, isDrawn });
    const viewers = [await open(`t=${t}&camera=front`, true), await open(`t=${t - 1}&camera=top`, true), await open('camera=front')];
    const [one, two, live] = viewers.map(({ page }) => page);
    for (const page of [one, two]) await statusIs(page, /^Behind −[1-9]/);
    await statusIs(live, /^Live$/);
    await sampleIs(one, first);
    // 60 samples in the mean; a busy machine makes them late, and then several at once. It is there with the server's answer.
    await two.waitForFunction((other) => Math.abs(other - Number(document.getElementById('sample').textContent) - 60) <= 20, first, LONG);
    const second = await sampleOf(two);
    await live.waitForFunction((n) => Number(document.getElementById('sample').textContent) > n + 30, first, LONG);
    assert.deepEqual([await sampleOf(one), await sampleOf(two)], [first, second]);
    const [front, top] = [await pixelsOf(one, '#view canvas'), await pixelsOf(two, '#view canvas')];
    let differ = 0;
    for (let i = 0; i < front.data.length; i += 4) if (Math.abs(front.data[i] - top.data[i]) > 40) ++differ;
    assert.ok(differ > 0.005 * front.data.length / 4, `${differ} pixels differ between two cameras`);
    await saveScreenshot(two, `two_viewers_${layout}`);
    for (const viewer of viewers) {
      assert.deepEqual(viewer.problems, []);
      await viewer.close();
    }
  });
}

test('playing goes on from the pause at the speed that is chosen, and catches up at 8 times', async () => {
  const { page, close } = await openLive(3);
  const live = await sampleOf(page);
  await page.keyboard.press('Home');
  // The status turns at once, the sample with the answer of the server.
  await page.waitForFunction((newest) => Number(document.getElementById('sample').textContent) < newest - 60, live, LONG);
  await statusIs(page, /^Behind/);
  const start = await sampleOf(page);
  await page.keyboard.press('Space');
  await page.waitForFunction((n) => Number(document.getElementById('sample').textContent) > n + 20, start, LONG);
  await statusIs(page, /^Behind/);
  await page.selectOption('#speed', '8');
  await statusIs(page, /^Live$/);
  assert.equal(await page.inputValue('#speed'), '1');
  await page.selectOption('#speed', '0.5');
  await statusIs(page, /^Behind −(0\.[3-9]|[1-9])/);
  await close();
});

/** What the page sends and receives over its WebSocket. */
function trafficOf(page) {
  const traffic = { looks: [], few: [], sent: [], former: 0, onSent() {} };  // sent: when the newest states were, µs of the server's clock
  page.on('websocket', (socket) => {
    socket.on('framesent', ({ payload }) => {
      const { look, few_states } = JSON.parse(payload);
      if (look) traffic.looks.push(look);
      if (few_states !== undefined) traffic.few.push(few_states);
    });
    socket.on('framereceived', ({ payload }) => {
      if (typeof payload === 'string') return;
      if (payload[0] === KIND.state) {
        traffic.sent.push(decodeState(new Uint8Array(payload).buffer).sentMicros);
        traffic.onSent();
      }
      if (payload[0] === KIND.past) traffic.former += payload.readUInt16LE(2);
    });
  });
  return traffic;
}
const sampleAfter = (page, number) => page.waitForFunction(
  (wanted) => Number(document.getElementById('sample').textContent) > wanted, number, LONG);

test('who plays the past asks for it twice a second, and is sent the newest state a few times a second', async () => {
  let traffic;
  const { page, problems, close } = await openLive(4, { beforeLoad: (fresh) => { traffic = trafficOf(fresh); } });
  await page.keyboard.press('PageUp');
  await statusIs(page, /^Behind/);
  await page.keyboard.press('Space');
  const first = await sampleOf(page), before = { ...traffic, looks: traffic.looks.length, sent: traffic.sent.length };
  const start = performance.now();
  await sampleAfter(page, first + 120);
  const seconds = (performance.now() - start) / 1000;
  assert.deepEqual(traffic.few, [true]);
  const looks = traffic.looks.slice(before.looks), ofRuns = looks.filter(({ until_micros: until }) => until !== undefined);
  assert.ok(looks.length <= 3 + 5 * seconds, `${looks.length} requests in ${seconds} s`);
  assert.ok(ofRuns.length > 0, `${looks.length} requests for single moments`);
  for (const run of ofRuns) {  // of half a second; with fewer states on a busy machine
    assert.equal(run.until_micros - run.micros, 500_000);
    assert.ok([12_000, 24_000, 48_000, 96_000].includes(run.every_micros), `${run.every_micros} µs`);
  }
  assert.ok(traffic.former - before.former > 0);
  // The server has those sent 60 times a second that it sends before it hears that few are wanted.
  const pauses = traffic.sent.slice(before.sent).map((micros, i, all) => (i === 0 ? 0 : (micros - all[i - 1]) / 1e6));
  const few = pauses.slice(pauses.findIndex((pause) => pause > 0.1));
  assert.ok(few.length >= 3 && few.every((pause) => pause > 0.1), `newest states after ${pauses} s`);
  // Single moments are asked for alone, also while it plays, which may ask for one more run before the key comes.
  const runs = traffic.looks.length;
  await page.keyboard.press('Home');
  await page.waitForFunction((older) => Number(document.getElementById('sample').textContent) < older, first + 60, LONG);
  const single = traffic.looks.slice(runs).find(({ until_micros: until }) => until === undefined);
  assert.deepEqual(Object.keys(single ?? {}).sort(), ['id', 'micros']);
  await page.keyboard.press('Escape');
  await statusIs(page, /^Live$/);
  const states = traffic.sent.length;
  await new Promise((resolve) => { traffic.onSent = () => { if (traffic.sent.length > states + 20) resolve(); }; });
  assert.deepEqual(traffic.few, [true, false]);
  const later = traffic.sent.slice(states).map((micros, i, all) => (i === 0 ? Infinity : (micros - all[i - 1]) / 1e6));
  assert.ok(later.some((pause) => pause < 0.1), `states after ${later} s since it is live`);
  assert.deepEqual(problems, []);
  await close();
});

test('the past plays at the speed that is chosen, with the states of each moment', async () => {
  const { page, close } = await openLive(16);
  await page.keyboard.press('Home');
  await statusIs(page, /^Behind/);
  for (const speed of ['0.1', '0.25', '1', '4']) {
    await page.selectOption('#speed', speed);
    await page.keyboard.press('Home');
    await page.click('#play');
    const [from, until] = await page.evaluate(async () => {
      const sample = () => Number(document.getElementById('sample').textContent);
      const changed = () => new Promise((resolve) => {
        new MutationObserver((_, observer) => { observer.disconnect(); resolve(undefined); })
          .observe(document.getElementById('sample'), { childList: true, characterData: true, subtree: true });
      });
      const at = [];
      await changed();  // the answers for the oldest moment and for the first run come late: what follows catches up
      await changed();
      while (at.length < 2) {
        await changed();  // with the readings, later on a busy machine
        if (at.length === 0 || performance.now() - at[0].millis > 2000) at.push({ millis: performance.now(), sample: sample() });
      }
      return at;
    });
    const rate = (until.sample - from.sample) / ((until.millis - from.millis) / 1000) / 60;
    assert.ok(Math.abs(rate / Number(speed) - 1) < 0.3, `${rate} instead of ${speed}`);
    await page.click('#play');
  }
  await close();
});

test('a link shows the same moment to another viewer', async () => {
  const { page, close } = await openLive();
  await page.keyboard.press('Space');
  await page.waitForFunction(() => new URL(location.href).searchParams.has('t'), null, LONG);
  const sample = await sampleOf(page);
  const other = await openPage(page.url());
  await statusIs(other.page, /^Behind/);
  await sampleIs(other.page, sample);
  await page.keyboard.press('End');
  await page.waitForFunction(() => !new URL(location.href).searchParams.has('t'), null, LONG);
  const late = await openPage(`${site.url}?t=99999999`);
  await late.page.waitForFunction(
    () => /not on this server/.test(document.getElementById('banner').textContent), null, LONG);
  for (const each of [{ close }, other, late]) await each.close();
});

test('who looks back is told that the live stream has stopped', async () => {
  const { page, close } = await openLive();
  await page.keyboard.press('Space');
  await statusIs(page, /^Behind/);
  site.say('stale');
  await page.waitForFunction(
    () => /^Live stream: Stale\./.test(document.getElementById('banner').textContent), null, LONG);
  site.say('live');
  await page.waitForFunction(() => document.getElementById('banner').hidden, null, LONG);
  await close();
});

test('keys that belong to a field or a button are left to it', async () => {
  const { page, close } = await openLive();
  await page.focus('#hand-kg');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Space');
  await page.focus('#step-back');
  await page.keyboard.press('Space');
  await statusIs(page, /^Behind/);
  const sample = await sampleOf(page);
  await page.keyboard.press('Space');
  await sampleIs(page, sample - 1);
  await close();
});

/** `kinescope serve` with this source on a port of its own. */
async function serve(source, args = []) {
  const child = spawn(process.env.KINESCOPE, ['serve', source, '--http_port', '0', '--pictures', 'off', '--ros', 'off',
    ...args], { stdio: ['ignore', 'ignore', 'pipe'] });
  endWithTests(child);
  for await (const line of createInterface({ input: child.stderr })) {
    const found = line.match(/page at (http:\S+)/);
    if (found) return { url: found[1], stop: () => { child.kill('SIGINT'); return once(child, 'exit'); } };
  }
  throw new Error('kinescope serve ended before it served a page');
}

test('a recording is never called live: the page says where in it the viewer is, and stops at its end', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'kinescope-time-'));
  const file = join(folder, 'walk.mvnx');
  await promisify(execFile)(process.env.KINESCOPE, ['convert', 'demo:walk', '--seconds', '4', '--out', file]);
  const server = await serve(file);
  const { page, problems, close } = await openPage(server.url, { beforeLoad: (fresh) => keepWords(fresh, 'status-word') });
  await statusIs(page, /^Recording 0:04\.0 of 0:04$/);
  await page.waitForFunction(() => document.getElementById('play').dataset.act === 'play', null, LONG);
  // The loads of the last sample stay, although no more samples come.
  await page.waitForFunction(() => /low|medium|high/.test(document.getElementById('loads').textContent), null, LONG);
  const last = await sampleOf(page);
  await page.keyboard.press('ArrowLeft');
  await sampleIs(page, last - 1);
  await page.keyboard.press('Escape');
  await sampleIs(page, last);
  await page.keyboard.press('Space');
  await statusIs(page, /^Recording 0:0[1-3]\.\d of 0:04$/);
  await saveScreenshot(page, 'recording_desktop');
  await page.setViewportSize(PHONE);
  await saveScreenshot(page, 'recording_phone');
  await statusIs(page, /^Recording 0:04\.0 of 0:04$/);
  await sampleIs(page, last);  // also when it was at the end before
  const words = await page.evaluate(() => window.words);
  assert.deepEqual(words.filter((word) => !/^(Connecting|No data|Recording [\d:.]+( of 0:04)?)$/.test(word)), []);
  assert.deepEqual(problems, []);
  await close();
  await server.stop();
  await rm(folder, { recursive: true });
});

test('an address leads to a moment of a recording, also on another server', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'kinescope-at-'));
  const file = join(folder, 'walk.mvnx');
  await promisify(execFile)(process.env.KINESCOPE, ['convert', 'demo:walk', '--seconds', '4', '--out', file]);
  const [stopped, playing] = [await serve(file, ['--stop_at', '3']), await serve(file)];
  const placeIs = (page, place) => page.waitForFunction(
    (wanted) => Math.abs(Number(new URL(location.href).searchParams.get('at')) - wanted) < 0.0011, place, LONG);
  const settled = (page) => page.waitForSelector('body[data-settled]', LONG);
  for (const { url } of [stopped, playing]) {
    const { page, problems, close } = await openPage(`${url}?at=1.5`);
    await statusIs(page, /^Recording 0:01\.[3-7] of 0:04$/);
    await settled(page);
    // One that plays delivers samples as its machine has time: its first ones, from which it counts, up to 0.25 s late.
    const sample = await sampleOf(page);
    assert.ok(url === stopped.url ? sample === 180 : Math.abs(sample - 180) <= 30, `sample ${sample}`);
    await page.keyboard.press('ArrowRight');
    await sampleIs(page, sample + 1);
    await placeIs(page, (sample + 1) / 120);
    await settled(page);
    await page.keyboard.press('Space');  // plays
    await page.waitForFunction(() => !document.body.hasAttribute('data-settled'), null, LONG);
    assert.deepEqual(problems, []);
    await close();
  }
  const late = await openPage(`${stopped.url}?at=3.5`);
  await late.page.waitForFunction(
    () => /^The recording ends before/.test(document.getElementById('banner').textContent), null, LONG);
  await statusIs(late.page, /^Recording 0:03\.0 of 0:04$/);
  await late.close();
  for (const server of [stopped, playing]) await server.stop();
  await rm(folder, { recursive: true });
});

test('on a phone the transport is in reach and covers nothing of the person', async () => {
  const { page, close } = await openLive(1, { viewport: PHONE });
  await page.click('#play');
  await statusIs(page, /^Behind/);
  const boxes = await page.evaluate(() => ['play', 'step-back', 'step-forward', 'moment', 'go-live'].map((id) => {
    const { top, bottom, left, right } = document.getElementById(id).getBoundingClientRect();
    return { id, top, bottom, left, right };
  }));
  for (const { id, top, bottom, left, right } of boxes) {
    assert.ok(top > 422 && bottom <= 844 && left >= 0 && right <= 390, `${id}: ${[top, bottom, left, right]}`);
    if (id !== 'moment') assert.ok(bottom - top >= 44 && right - left >= 44, `${id} is too small for a finger`);
  }
  await saveScreenshot(page, 'behind_phone');
  await close();
});
