// The strip of time and the plots, on the real page.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test as nodeTest } from 'node:test';
import {
  chooseTab, closeBrowser, countPixels, drawNothing, keepWords, openPage, PHONE, pixelsOf, pixelsOfPng, saveFile, saveScreenshot, startFixture,
} from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
let site;
before(async () => {
  site = await startFixture();
  site.say('people 2');
  site.say('live');
});
after(async () => {
  await site.stop();
  await closeBrowser();
});

const isHigh = (r, g, b) => r > 150 && g < 60 && b < 60;
const statusIs = (page, pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('status-word').textContent), pattern.source, LONG);

/** The plots are drawn again with the readings. Two of these: the first may have been under way already. */
const isRedrawn = (page) => page.evaluate(() => new Promise((done) => {
  let left = 2;
  new MutationObserver((_, observer) => {
    left -= 1;
    if (left > 0) return;
    observer.disconnect();
    done(undefined);
  }).observe(document.getElementById('sample'), { childList: true, characterData: true, subtree: true });
}));

/** Live, with `seconds` of history on the strip. */
async function openLive(seconds, options) {
  const visit = await openPage(site.url, options);
  await statusIs(visit.page, /^Live$/);
  await visit.page.waitForFunction((least) => Number(document.getElementById('moment').min) < -least, seconds, LONG);
  await seeStrip(visit.page, isHigh, 200);
  return visit;
}

/** Until the strip has enough such pixels. */
async function seeStrip(page, isSuch, least) {
  const until = Date.now() + LONG.timeout;
  let count = 0;
  while (Date.now() < until) {
    count = countPixels(await pixelsOf(page, '#strip-rows'), isSuch);
    if (count >= least) return;
  }
  assert.fail(`${count} such pixels on the strip, expected at least ${least}`);
}

const lag = (page) => page.evaluate(() => -Number(document.getElementById('moment').value));
/** The columns of pixels that the playhead covers at half the height of the strip. */
async function playheadAt(page) {
  const { width, data } = await pixelsOf(page, '#strip-rows');
  const isBlue = (i) => data[i + 2] > 150 && data[i + 2] > data[i] + 90;
  return Array.from({ length: width }, (_, x) => x).filter((x) => isBlue(4 * (40 * width + x)));
}

test('the strip shows the classes of each person, and a click on it goes to that moment', async () => {
  const { page, problems, close } = await openLive(4);
  const box = await page.locator('#strip-rows').boundingBox();
  const slider = await page.locator('#moment').boundingBox();
  assert.ok(Math.abs(slider.x + slider.width - (box.x + box.width - 8)) <= 2, 'its right end is now');
  const x = slider.x + slider.width / 2;
  await page.evaluate(() => document.getElementById('moment').addEventListener('input', ({ target }) => {
    window.clicked = Number(target.value) / Number(target.min);
  }, { once: true }));
  await page.mouse.click(x, box.y + 40);
  await statusIs(page, /^Behind −\d/);
  await page.waitForFunction(() => /^−\d.*Demo high, Demo 2 high$/.test(document.getElementById('moment').ariaValueText
    ?? document.getElementById('moment').getAttribute('aria-valuetext')), null, LONG);
  const clicked = await page.evaluate(() => window.clicked);
  assert.ok(Math.abs(clicked - 0.5) < 0.1, `at ${clicked} of what is kept`);
  const goOn = async () => {
    const before = await lag(page);
    await page.waitForFunction((least) => -Number(document.getElementById('moment').value) > least, before + 0.7, LONG);
    return page.textContent('#sample');
  };
  assert.equal(await goOn(), await goOn(), 'paused');
  await saveScreenshot(page, 'strip_behind');
  // Dragged to the right end, it does not become live; only a clear act does that.
  await page.mouse.move(x, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(slider.x + slider.width + 30, box.y + 40, { steps: 4 });
  await page.mouse.up();
  await statusIs(page, /^Behind −0/);
  await page.focus('#moment');
  await page.keyboard.press('PageUp');
  await statusIs(page, /^Behind −[1-9]/);
  await page.keyboard.press('Escape');
  await statusIs(page, /^Live$/);
  assert.deepEqual(problems, []);
  await close();
});

test('the playhead is where the slider is, and moves away from now while the page is paused', async () => {
  const { page, close } = await openLive(4);
  const box = await page.locator('#strip-rows').boundingBox(), slider = await page.locator('#moment').boundingBox();
  await page.mouse.click(slider.x + slider.width * 0.7, box.y + 40);
  await statusIs(page, /^Behind/);
  const slid = () => page.evaluate((left) => {
    const moment = document.getElementById('moment'), { min, value } = moment, place = moment.getBoundingClientRect();
    return place.left - left + place.width * (1 - Number(value) / Number(min));
  }, box.x);
  let before, at, after;
  do {  // the word changes at the click, the strip at the next frame
    before = await slid();
    at = await playheadAt(page);
    after = await slid();
  } while (at.length === 0);
  assert.ok(at.length <= 5, `${at.length} columns of the playhead`);
  assert.ok(at[0] <= before + 3 && at.at(-1) >= after - 3, `the playhead is at ${at}, the slider was from ${before} to ${after}`);
  while (await slid() >= before) continue;  // the test has a time limit
  await close();
});

test('a stop of the stream is a gap on the strip, and loads without data are unknown', async () => {
  const { page, close } = await openLive(2);
  site.say('stale');
  await statusIs(page, /^Stale$/);
  site.say('live');
  await statusIs(page, /^Live$/);
  const isLoss = (r, g, b) => r > 80 && r < 140 && g < 80 && b > 120;  // --loss
  await seeStrip(page, isLoss, 10);
  await saveScreenshot(page, 'strip_gap');
  await close();
});

test('a person who comes has a row of their own', async () => {
  site.say('people 1');
  const { page, close } = await openLive(1);
  site.say('people 3');
  await page.waitForFunction(() => document.querySelectorAll('.person').length === 3, null, LONG);
  site.say('people 2');
  await close();
});

test('the strip asks only for what is new, a few times a second, and not while the page is hidden', async () => {
  const { page, requests, close } = await openLive(3);
  const series = () => requests.filter((url) => url.includes('/api/v1/series'));
  const began = performance.now(), before = series().length;
  await page.waitForFunction(() => (window.framesSeen = (window.framesSeen ?? 0) + 1) > 60, null, { ...LONG, polling: 50 });
  const secs = (performance.now() - began) / 1000, asked = series().slice(before);
  assert.ok(asked.length >= 2 && asked.length <= 5.5 * secs + 2, `${asked.length} requests in ${secs} s`);
  // All of the strip only once, for each person and each width of columns: the strip becomes longer with the history.
  const seen = new Set();
  for (const url of series()) {
    const query = new URL(url).searchParams, columns = Number(query.get('columns'));
    const kind = `${query.get('person')} ${(query.get('to') - query.get('from')) / columns}`;
    assert.ok(columns < 150 || !seen.has(kind), url);
    seen.add(kind);
  }
  await page.evaluate(() => {
    Object.defineProperty(document, 'hidden', { value: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  const [first] = [series().length];
  await page.waitForFunction(() => (window.framesSeen += 1) > 100, null, { ...LONG, polling: 50 });
  assert.ok(series().length <= first + 2, `${series().length - first} requests of a hidden page`);
  await close();
});

async function openPlots(options) {
  const visit = await openLive(3, options);
  await chooseTab(visit.page, 'plots');
  await visit.page.waitForFunction(() => {
    const [value] = document.querySelectorAll('[data-plot="compression"] output');
    return value?.textContent === '2.15';
  }, null, LONG);
  return visit;
}

test('the plots show loads, compression, margin, rate and losses of the person on the screen', async () => {
  const { page, problems, close } = await openPlots();
  assert.equal(await page.textContent('[data-plot="margin"] output'), '8.3');
  assert.equal(await page.textContent('[data-plot="rate"] output'), '60.0');
  assert.deepEqual(await page.locator('[data-plot="loads"] li').allTextContents().then((all) => all.map((text) => text.replace(/[\d–]+$/, '').trim())),
    ['L5/S1', 'R shoulder', 'R knee']);
  assert.equal(await page.locator('.plot canvas').count(), 5);
  await page.click('#plot-window >> text=10 s');
  await saveScreenshot(page, 'plots_desktop');
  const isCom = (r, g, b) => r > 100 && g < 80 && b > 150;
  assert.ok(countPixels(await pixelsOf(page, '#floor-plan'), isCom) > 30, 'the centre of mass is on the floor plan');
  assert.deepEqual(problems, []);
  await close();
});

test('a click on a plot goes to that moment, and hovering shows the values of another one', async () => {
  const { page, close } = await openPlots({ beforeLoad: (fresh) => keepWords(fresh, 'status-word') });
  await page.click('#plot-window >> text=10 s');
  await isRedrawn(page);  // a click means a moment of the time that the plot shows
  const over = await page.locator('[data-plot="loads"] .u-over').boundingBox();
  await page.mouse.click(over.x + over.width * 0.9, over.y + 20);
  // Paused, it is ever longer ago.
  await page.waitForFunction(() => window.words.some((word) => /^Behind −[01]\.\d s$/.test(word)), null, LONG);
  const first = await page.textContent('#sample');
  await page.mouse.down();
  await page.mouse.move(over.x + over.width * 0.8, over.y + 20, { steps: 3 });
  await page.mouse.up();
  await page.waitForFunction((before) => document.getElementById('sample').textContent !== before, first, LONG);
  assert.ok(Number(await page.textContent('#sample')) < Number(first));
  // Of all plots, also those that the pointer is not over: before the stream began there is no value.
  await page.waitForFunction(() => document.querySelector('[data-plot="compression"] output')?.textContent === '2.15', null, LONG);
  await page.click('#plot-window >> text=10 min');
  await page.mouse.move(over.x + over.width * 0.02, over.y + 20);
  await page.waitForFunction(() => document.querySelector('[data-plot="compression"] output')?.textContent === '–', null, LONG);
  await page.mouse.move(5, 5);
  await page.waitForFunction(() => document.querySelector('[data-plot="compression"] output')?.textContent === '2.15', null, LONG);
  await close();
});

test('up to four joints of one of the people are plotted', async () => {
  const { page, close } = await openPlots();
  await page.click('#plots summary');
  const box = (name) => page.locator(`#plot-joints input[value="${name}"]`);
  await box('left_elbow').check();
  assert.equal(await page.locator('[data-plot="loads"] li').count(), 4);
  assert.equal(await box('left_hip').isDisabled(), true);
  await box('right_knee').uncheck();
  assert.equal(await box('left_hip').isDisabled(), false);
  assert.equal(await page.textContent('#plot-chosen'), 'L5/S1, R shoulder, L elbow');
  const asked = page.waitForRequest((request) => /api\/v1\/series\?person=1&keys=l5_s1%2Cright_shoulder%2Cleft_elbow/.test(request.url()));
  await page.click('.person[data-character="1"]');
  await asked;
  await page.waitForFunction(() => document.querySelector('[data-plot="compression"] output')?.textContent === '2.15', null, LONG);
  await close();
});

test('the plots are saved as CSV and as a picture with person and trial', async () => {
  const { page, problems, close } = await openPlots();
  const save = async (id) => {
    const [file] = await Promise.all([page.waitForEvent('download'), page.click(id)]);
    return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
  };
  const csv = await save('#plot-csv');
  assert.match(csv.name, /^kinescope_Demo_20\d\d-.*\.csv$/);
  const [head, ...rows] = csv.bytes.toString().trim().split('\r\n').map((line) => line.split(','));
  assert.deepEqual(head.slice(0, 8), ['person', 'source', 'time', 'seconds', 'samples', 'l5_s1_min', 'l5_s1_max', 'l5_s1_last']);
  const last = rows.filter((row) => Number(row[4]) > 0).at(-1);
  assert.equal(last[head.indexOf('compression_max')], '2150');
  assert.equal(last[0], 'Demo');
  assert.equal(last[1], 'udp://0.0.0.0:9763');
  const png = await save('#plot-png');
  await saveFile('plots_saved.png', png.bytes);
  assert.match(png.name, /^kinescope_Demo_20\d\d-.*\.png$/);
  const picture = pixelsOfPng(png.bytes);
  assert.ok(picture.width > 380 && picture.height > 380, `${picture.width} x ${picture.height}`);
  const isDark = (r, g, b) => r < 60 && g < 60 && b < 70;
  assert.ok(countPixels({ data: picture.data.subarray(0, 4 * picture.width * 30) }, isDark) > 60, 'the person is named at the top');
  assert.deepEqual(problems, []);
  await close();
});

test('tabs are reached by keys, and keys of the time do not reach them', async () => {
  const { page, close } = await openLive(1);
  await page.focus('#tab-loads');
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.getAttribute('#tab-body', 'aria-selected'), 'true');
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.getAttribute('#tab-plots', 'aria-selected'), 'true');
  assert.equal(await page.isVisible('#plots'), true);
  assert.equal(await page.isVisible('#loads'), false);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'tab-plots');
  assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  await page.keyboard.press('Home');
  assert.equal(await page.isVisible('#loads'), true);
  await close();
});

test('on a phone the strip is above the buttons, a finger moves the time, and the plots fit', async () => {
  const { page, problems, close } = await openPlots({ viewport: PHONE, colorScheme: 'dark', context: { hasTouch: true } });
  const strip = await page.locator('.strip').boundingBox(), play = await page.locator('#play').boundingBox();
  assert.ok(strip.y + strip.height <= play.y);
  assert.ok(strip.height >= 44 && strip.width > 330);
  const live = await page.locator('#go-live').boundingBox();
  assert.ok(Math.abs(live.y - play.y) < 2, 'the buttons are in one row');
  await page.touchscreen.tap(strip.x + strip.width * 0.7, strip.y + strip.height / 2);
  await statusIs(page, /^Behind/);
  await page.click('#go-live');
  await statusIs(page, /^Live$/);
  await page.locator('#plots').scrollIntoViewIfNeeded();
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.equal(wide, 390, 'nothing is wider than the screen');
  await saveScreenshot(page, 'plots_phone');
  assert.deepEqual(problems, []);
  await close();
});

test('a wide page shows plots beside loads or body', async () => {
  const { page, close } = await openLive(2, { viewport: { width: 1920, height: 1080 }, colorScheme: 'dark' });
  assert.equal(await page.isVisible('#plots'), true);
  assert.equal(await page.isVisible('#loads'), true);
  assert.equal(await page.isVisible('#tab-plots'), false);
  await page.waitForFunction(() => document.querySelector('[data-plot="compression"] output')?.textContent === '2.15', null, LONG);
  await chooseTab(page, 'body');
  assert.equal(await page.isVisible('#loads'), false);
  assert.equal(await page.isVisible('#body-map'), true);
  await saveScreenshot(page, 'plots_wide');
  await close();
});

test('the map of the body shows class, percent and exposure of each joint, and a press plots the joint', async () => {
  const { page, problems, close } = await openLive(2);
  await chooseTab(page, 'body');
  await page.waitForFunction(() => document.querySelectorAll('#body-map .joint-card').length === 15, null, LONG);
  const button = (name) => page.locator(`#body-map .joint-card[data-joint="${name}"]`);
  assert.equal(await button('l5_s1').getAttribute('data-class'), 'high');
  assert.match(await button('l5_s1').textContent(), /^L5\/S1, high, (8[89]|9[012]) %.*; plot$/);
  assert.match(await button('right_knee').textContent(), /^Right Knee, (low|medium), \d+ %.*; plot$/);
  assert.equal(await button('left_ankle').getAttribute('data-class'), 'unknown');
  assert.equal(await button('left_ankle').locator('.ratio').textContent(), '–');
  const hrefs = await page.locator('#body-marks use').evaluateAll((all) => all.map((use) => use.getAttribute('href')));
  assert.deepEqual([...new Set(hrefs)].sort(), ['#shape-high', '#shape-low', '#shape-medium', '#shape-unknown']);
  // The person's right is on the left.
  const [right, left] = [await button('right_knee').boundingBox(), await button('left_knee').boundingBox()];
  assert.ok(right.x < left.x);
  assert.equal(await button('left_knee').getAttribute('aria-pressed'), 'false');
  await button('left_knee').click();
  await page.waitForFunction(() => document.querySelector('[data-joint="left_knee"]')?.ariaPressed === 'true', null, LONG);
  assert.equal(await page.locator('#plot-chosen').textContent(), 'L5/S1, R shoulder, R knee, L knee');
  await button('l5_s1').click();
  await page.waitForFunction(() => document.querySelector('[data-joint="l5_s1"]')?.ariaPressed === 'false', null, LONG);
  await saveScreenshot(page, 'body_map');
  assert.deepEqual(problems, []);
  await close();
});
