// The page in real Chromium, against the real HTTP server with a made-up person.
import assert from 'node:assert/strict';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test as nodeTest } from 'node:test';
import { chooseTab, closeBrowser, countPixels, DESKTOP, drawNothing, keepWords, openPage, PHONE, pixelsOf, pressedCameras, saveScreenshot, startFixture }
  from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
// A test that hangs ends by name instead of taking all the others with it.
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
let site;
before(async () => { site = await startFixture(); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

const statusIs = (page, word) =>
  page.waitForFunction((w) => document.getElementById('status-word').textContent === w, word, LONG);
const text = (page, selector) => page.locator(selector).textContent();
const isRed = (r, g, b) => r > 150 && g < 90 && b < 90;
const isGreen = (r, g, b) => g > 90 && r < 0.75 * g && b < 0.93 * g;  // through the body, too
const isOrange = (r, g, b) => r > 200 && g > 90 && g < 190 && b < 110;

/** Waits until the view has settled on a picture that `test` accepts. */
async function seePixels(page, name, test, least) {
  const until = Date.now() + LONG.timeout;
  let count = 0;
  while (Date.now() < until) {
    count = countPixels(await pixelsOf(page, '#view'), test);
    if (count >= least) return count;
  }
  assert.fail(`${count} ${name} pixels in the view, expected at least ${least}`);
}

async function openLive(options) {
  site.say('people 1');
  site.say('live');
  const visit = await openPage(site.url, options);
  await statusIs(visit.page, 'Live');
  return visit;
}

test('the page shows the person in the colours of the load classes', async () => {
  const visit = await openLive({ isDrawn: true });
  await seePixels(visit.page, 'red', isRed, 300);
  await seePixels(visit.page, 'orange', isOrange, 200);
  await seePixels(visit.page, 'green', isGreen, 100);
  // The body: light grey, darker than the background, on a part of the view that a person fills.
  const { width, height } = await pixelsOf(visit.page, '#view');
  const isBody = (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) < 30 && g > 90 && g < 215;
  const count = await seePixels(visit.page, 'body', isBody, 0.015 * width * height);
  assert.ok(count < 0.5 * width * height, `${count} pixels are no single person`);
  await saveScreenshot(visit.page, 'live_desktop');
  assert.deepEqual(visit.problems, []);
  await visit.close();
});

test('the page works in a browser without a locale, as in containers and kiosks', async () => {
  const visit = await openLive({ beforeLoad: (page) => page.addInitScript(() => {
    Object.defineProperty(navigator, 'language', { value: 'en-US@posix', configurable: true });  // Chromium's own word
  }) });
  assert.deepEqual(visit.problems, []);
  await visit.close();
});

test('the readings show the values of the stream', async () => {
  const { page, close } = await openLive();
  await page.waitForFunction(() => /^\d+(\.\d)? ms$/.test(document.getElementById('latency').textContent), null, LONG);
  assert.equal(await text(page, '#rate'), '60.0 Hz');
  assert.match(await text(page, '#latency-p95'), /^p95 \d+(\.\d)? ms$/);
  assert.match(await text(page, '#time-code'), /^\d\d:\d\d:\d\d\.\d{3}$/);
  assert.equal(await text(page, '#source'), 'udp://0.0.0.0:9763');
  const sample = Number(await text(page, '#sample'));
  await page.waitForFunction((n) => Number(document.getElementById('sample').textContent) > n, sample, LONG);
  await page.waitForFunction(() => document.title === 'Live · Kinescope', null, LONG);
  await close();
});

test('the highest loads are listed first, as words and numbers', async () => {
  const { page, close } = await openLive();
  await page.waitForFunction(() => {
    const notes = [...document.querySelectorAll('#loads .note')].map((note) => note.textContent);
    return notes.length === 15 && notes.every((note) => note !== '');
  }, null, LONG);
  const rows = await page.$$eval('#loads li', (items) => items.map((item) => ({
    label: item.querySelector('.label').textContent, word: item.querySelector('.word').textContent,
    ratio: item.querySelector('.ratio').textContent, note: item.querySelector('.note').textContent,
  })));
  const rank = { high: 0, medium: 1, low: 2, unknown: 3 };
  const ranks = rows.map(({ word }) => rank[word]);
  assert.deepEqual(ranks, [...ranks].sort());
  assert.deepEqual(new Set(ranks).size, 4, 'the made-up person has every class');
  assert.equal(rows[0].label, 'L5/S1');
  assert.match(rows[0].ratio, /^\d+ %$/);
  assert.match(rows[0].note, /^now \d+ of 40 N·m, flexion$/);
  assert.deepEqual(rows.at(-1),
    { label: 'Left ankle', word: 'unknown', ratio: '–', note: 'left foot is not on the floor' });
  await close();
});

test('the class colours equal the palette of the server', async () => {
  const { page, close } = await openLive();
  const { palette } = await page.evaluate(() => fetch('api/v1/model').then((answer) => answer.json()));
  for (const { name, color } of palette.classes) {
    const shown = await page.evaluate((n) => getComputedStyle(document.documentElement).getPropertyValue(`--class-${n}`), name);
    const hex = `#${color.map((v) => Math.round(255 * v).toString(16).padStart(2, '0')).join('')}`;
    assert.equal(shown.trim(), hex, name);
  }
  await close();
});

test('bars and legend show the class limits of the server', async () => {
  const { page, close } = await openLive();
  await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
  const legend = () => page.$$eval('#legend li', (all) => all.map((entry) => entry.textContent));
  assert.deepEqual(await legend(), ['low', 'medium > 30 %', 'high > 60 %', 'unknown']);
  site.say('limits 0.15 0.4');
  await page.waitForFunction(() => document.getElementById('legend').textContent.includes('15 %'), null, LONG);
  assert.deepEqual(await legend(), ['low', 'medium > 15 %', 'high > 40 %', 'unknown']);
  const shares = await page.locator('#loads .bar').first().evaluate((bar) => ['::before', '::after'].map(
    (tick) => parseFloat(getComputedStyle(bar, tick).left) / bar.clientWidth));
  assert.deepEqual(shares.map((share) => share.toFixed(2)), ['0.15', '0.40']);
  site.say('limits 0.3 0.6');
  await close();
});

test('the status follows a stream that stops, is missing and starts again', async () => {
  const { page, problems, close } = await openLive({ isDrawn: true });
  await seePixels(page, 'red', isRed, 300);
  site.say('stale');
  await statusIs(page, 'Stale');
  await page.waitForFunction(() => /last sample received \d/.test(document.getElementById('banner').textContent), null, LONG);
  const words = await page.$$eval('#loads .word', (parts) => [...new Set(parts.map((part) => part.textContent))]);
  assert.deepEqual(words, ['unknown'], 'an old load is no load');
  const until = Date.now() + LONG.timeout;
  let coloured = 1;
  while (coloured > 0 && Date.now() < until) {
    const pixels = await pixelsOf(page, '#view canvas');
    coloured = countPixels(pixels, isRed) + countPixels(pixels, isGreen);
  }
  assert.equal(coloured, 0, 'a stale human is grey');
  await saveScreenshot(page, 'stale_desktop');
  site.say('nodata');
  await statusIs(page, 'No data');
  assert.equal(await text(page, '#banner'), 'Waiting for udp://0.0.0.0:9763');
  assert.equal(await page.locator('#points').isVisible(), true, 'the page has had a person');
  await saveScreenshot(page, 'no_data_desktop');
  site.say('live');
  await statusIs(page, 'Live');
  assert.equal(await page.locator('#banner').isVisible(), false);
  await seePixels(page, 'red', isRed, 300);
  assert.deepEqual(problems, []);
  await close();
});

test('the symbols of people are listed only on a page that has had a person', async () => {
  const { page, problems, close } = await openLive();
  await page.waitForFunction(() => /compression/.test(document.getElementById('compression').textContent), null, LONG);
  assert.deepEqual(await page.locator('#points dd:visible').allTextContents(),
    ['Centre of mass', 'Centre of pressure', 'Margin of stability 8.3 cm', 'Ground reaction force', 'L5/S1 compression 2.15 kN']);
  site.say('people 0');
  await page.waitForFunction(() => document.querySelectorAll('.person').length === 0, null, LONG);
  const robots = await openPage(site.url);
  await statusIs(robots.page, 'Live');
  await robots.page.waitForFunction(() => document.getElementById('sample').textContent !== '–', null, LONG);
  assert.equal(await robots.page.locator('#points').isVisible(), false);
  assert.equal(await page.locator('#points').isVisible(), true);
  site.say('people 1');
  await robots.page.locator('#points').waitFor({ state: 'visible', ...LONG });
  assert.deepEqual([...problems, ...robots.problems], []);
  await robots.close();
  await close();
});

test('a page that was busy itself takes what has come before it says how the stream is', async () => {
  const { page, close } = await openLive();
  await page.evaluate(() => {
    window.words = [];
    const word = document.getElementById('status-word');
    new MutationObserver(() => window.words.push(word.textContent)).observe(word, { childList: true, characterData: true, subtree: true });
  });
  for (let i = 0; i < 2; ++i) {
    const before = await page.evaluate(() => {
      const until = performance.now() + 2500;
      while (performance.now() < until) ;
      return document.getElementById('sample').textContent;
    });
    await page.waitForFunction((sample) => document.getElementById('sample').textContent !== sample, before, LONG);
  }
  assert.deepEqual(await page.evaluate(() => window.words), []);
  await close();
});

test('the page detects a server that ends or does not respond', async () => {
  const mortal = await startFixture();
  const { page, close } = await openPage(mortal.url);
  await statusIs(page, 'Live');
  await chooseTab(page, 'body');
  const mapIs = (isKnown) => page.waitForFunction((known) => {
    const cards = [...document.querySelectorAll('.joint-card')];
    return cards.length === 15 && cards.some(({ dataset }) => dataset.class !== 'unknown') === known
      && cards.some((card) => /\d/.test(card.querySelector('.ratio').textContent)) === known;
  }, isKnown, LONG);
  await mapIs(true);
  process.kill(mortal.pid, 'SIGSTOP');
  await statusIs(page, 'Disconnected');
  await mapIs(false);
  process.kill(mortal.pid, 'SIGCONT');
  await statusIs(page, 'Live');
  await mapIs(true);
  await mortal.kill();
  await statusIs(page, 'Disconnected');
  await mapIs(false);
  assert.match(await text(page, '#banner'), /No connection/);
  await close();
});

test('the page takes up a server that was started again, with its bodies and moments, and says so', async () => {
  const first = await startFixture();
  const [live, behind] = [await openPage(first.url), await openPage(first.url)];
  for (const { page } of [live, behind]) await statusIs(page, 'Live');
  await behind.page.keyboard.press('Space');
  await behind.page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  await first.kill();
  for (const { page } of [live, behind]) {
    await page.waitForFunction(() => document.getElementById('banner').textContent.includes('No connection to the server'), null, LONG);
  }
  const again = live.page.waitForRequest(/api\/v1\/model/, LONG);
  // Both say it for some seconds, at one time.
  const said = [[live, /^The server restarted$/], [behind, /restarted: the moment that you looked at is gone$/]].map(([{ page }, words]) =>
    page.waitForFunction((source) => new RegExp(source).test(document.getElementById('banner').textContent), words.source, LONG));
  const second = await startFixture(['--port', new URL(first.url).port, '--worn']);
  second.say('live');
  await again;  // another body has the revision of the one before
  await Promise.all(said);
  for (const { page } of [live, behind]) {
    await statusIs(page, 'Live');
    assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  }
  await saveScreenshot(live.page, 'started_again');
  await live.close();
  await behind.close();
  await second.stop();
});

test('without a skin there is no choice where loads are shown', async () => {
  const { page, close } = await openLive();
  await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
  assert.equal(await page.locator('#loads-shown').isVisible(), false);
  await close();
});

test('the named cameras rotate the view until the user moves it', async () => {
  const { page, close } = await openLive({ isDrawn: true });
  await page.locator('#cameras button').first().waitFor(LONG);
  assert.deepEqual(await page.$$eval('#cameras button', (all) => all.map((button) => button.dataset.camera)),
    ['front', 'back', 'left', 'right', 'top', 'iso', 'three_quarter']);
  assert.deepEqual(await pressedCameras(page), ['three_quarter']);
  await page.click('[data-camera="front"]');
  assert.deepEqual(await pressedCameras(page), ['front']);
  // From the front, the person's right shoulder is on the left of the picture: red on both sides.
  await seePixels(page, 'red', isRed, 300);
  const box = await page.locator('#view canvas').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  assert.deepEqual(await pressedCameras(page), []);
  await close();
});

test('a hand load is set and shown, and rejected if it is impossible', async () => {
  const { page, problems, close } = await openLive({ isDrawn: true });
  const hint = (part) => page.waitForFunction(
    (wanted) => document.getElementById('loads-hint').textContent.includes(wanted), part, LONG);
  await page.selectOption('#hand', 'right_kg');
  await page.fill('#hand-kg', '12.5');
  await page.click('#hand-load button');
  await hint('hand load 12.5 kg right');
  // Dark iron in the picture: nothing else there is so dark.
  const isIron = (r, g, b) => r < 75 && g < 82 && b < 95 && b > r;
  await page.click('[data-camera="front"]');
  await seePixels(page, 'iron', isIron, 150);
  await page.selectOption('#hand', 'left_kg');
  await page.fill('#hand-kg', '2');
  await page.press('#hand-kg', 'Enter');
  await hint('hand load 2 kg left');
  assert.doesNotMatch(await page.textContent('#loads-hint'), /right/, 'it replaces what is held');
  await page.selectOption('#hand', 'right_kg');
  await page.fill('#hand-kg', '60');
  await page.click('#hand-load button');
  await page.waitForFunction(() => document.getElementById('banner').textContent === 'Could not set the hand load: load of more than 50 kg', null, LONG);
  await page.fill('#hand-kg', '0');
  await page.click('#hand-load button');
  await page.waitForFunction(() => !document.getElementById('loads-hint').textContent.includes('hand load'), null, LONG);
  assert.ok(problems.every((line) => /400|api\/v1\/hand_load/.test(line)), problems.join());
  await close();
});

test('the page shows metric, load mode and assumptions beside the loads', async () => {
  const { page, close } = await openLive();
  await page.waitForFunction(() => /^load metric: total, dynamic · floor at z = 0\.00 m · body mass assumed: 75 kg/
    .test(document.getElementById('loads-hint').textContent), null, LONG);
  assert.equal(await text(page, '#support'), 'Margin of stability 8.3 cm');
  assert.equal(await text(page, '#compression'), 'L5/S1 compression 2.15 kN');
  const title = await page.locator('#loads li').last().getAttribute('title');
  assert.match(title, /^left foot is not on the floor/);
  await close();
});

test('the server picture is shown on request and saved at full size', async () => {
  const { page, problems, close } = await openLive();
  const image = page.locator('#picture-image');
  assert.equal(await image.isVisible(), false, 'it costs nothing until it is looked at');
  await chooseTab(page, 'picture');
  await image.waitFor({ state: 'visible', ...LONG });
  await page.waitForFunction(() => document.getElementById('picture-image').naturalWidth === 640, null, LONG);
  await page.selectOption('#picture-camera', 'iso');
  await page.waitForFunction(() => fetch('api/v1/cameras').then((a) => a.json()).then(({ live }) => live === 'iso'), null, LONG);
  const waiting = page.waitForEvent('download', LONG);
  await page.click('#save-picture');
  const download = await waiting;
  assert.match(download.suggestedFilename(), /^kinescope_iso_[\dTZ-]+\.png$/);
  const png = await readFile(await download.path());
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [1920, 1080]);
  await page.uncheck('#picture-on');
  assert.equal(await image.isVisible(), false);
  assert.deepEqual(problems, []);
  await close();
});

test('the page reports a missing renderer and works without it', async () => {
  const blind = await startFixture(['--no-pictures']);
  const { page, close } = await openPage(blind.url);
  await statusIs(page, 'Live');
  await page.waitForFunction(() => document.getElementById('picture-note').textContent === 'This server does not render pictures.', null, LONG);
  assert.equal(await page.locator('#save-picture').isDisabled(), true);
  await close();
  await blind.stop();
});

test('the server picture replaces the view without WebGL', async () => {
  const { page, close } = await openLive({
    beforeLoad: (fresh) => fresh.addInitScript(() => {
      HTMLCanvasElement.prototype.getContext = () => null;
    }),
  });
  assert.match(await text(page, '#view'), /WebGL is not available/);
  await page.locator('#picture-image').waitFor({ state: 'visible', ...LONG });
  await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
  await close();
});

test('an HTML answer of a proxy is reported, and the rest of the page works', async () => {
  const { page, problems, close } = await openLive({
    beforeLoad: async (fresh) => {
      await keepWords(fresh, 'banner');  // it is said for some seconds, while the page is loaded
      for (const route of ['diagnostics', 'cameras']) {
        await fresh.route(`**/api/v1/${route}`, (request) => request.fulfill({ contentType: 'text/html', body: '<h1>Hi</h1>' }));
      }
    },
  });
  await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
  await page.waitForFunction(() => window.words.some((text) => /cameras.*text\/html/.test(text)), null, LONG);
  await page.waitForFunction(() => /diagnostics.*text\/html/.test(document.getElementById('problems').textContent), null, LONG);
  assert.deepEqual(problems, []);
  await close();
});

test('the page requires a token and removes it from the address', async () => {
  const guarded = await startFixture(['--token', 's3cret-of-the-lab']);
  const denied = await openPage(guarded.url.replace(/\?.*/, ''));
  assert.match(await text(denied.page, 'body'), /token/);
  await denied.close();
  const { page, problems, close } = await openPage(guarded.url);
  await statusIs(page, 'Live');
  assert.equal(new URL(page.url()).search, '');
  await page.reload();
  await statusIs(page, 'Live');
  assert.deepEqual(problems.filter((line) => !line.startsWith('failed: ')), [], 'but for requests that the reload cut short');
  await close();
  await guarded.stop();
});

/** A box as ASCII STL, metres. */
function boxStl([x, y, z]) {
  const corner = (i) => [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z].map((v) => v / 2).join(' ');
  const faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6],
    [1, 3, 5], [3, 7, 5]];
  return `solid box\n${faces.map((face) => `facet normal 0 0 0\nouter loop\n${face.map((i) => `vertex ${corner(i)}`)
    .join('\n')}\nendloop\nendfacet`).join('\n')}\nendsolid box\n`;
}

/** Of the first person, once there is one. */
async function linksOf(url) {
  const until = Date.now() + LONG.timeout;
  while (Date.now() < until) {
    const { people } = await fetch(`${url}api/v1/model`).then((answer) => answer.json());
    if (people.length > 0) return people[0].links;
  }
  assert.fail('nobody came');
}

test('a body of mesh files is shown, and missing files are counted', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'kinescope_meshes_'));
  const meshed = await startFixture(['--meshes', folder]);
  const links = (await linksOf(meshed.url)).map(({ name }) => name.replace('skeleton_', ''));
  const [missing, ...others] = links;
  await Promise.all(others.map((name) => writeFile(join(folder, `${name}.stl`), boxStl([0.15, 0.15, 0.15]))));
  const { page, problems, close } = await openPage(meshed.url, { isDrawn: true });
  await statusIs(page, 'Live');
  await page.waitForFunction(
    () => document.getElementById('banner').textContent === '1 mesh of the body model could not be loaded', null, LONG);
  const isBody = (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) < 30 && g > 90 && g < 215;
  await seePixels(page, 'body', isBody, 2000);
  assert.equal(missing, 'pelvis');
  assert.ok(problems.length > 0 && problems.every((line) => /404|api\/v1\/mesh\/0\/1\/0$/.test(line)), problems.join());
  await close();
  await meshed.stop();
  await rm(folder, { recursive: true });
});

test('the page shows gloves and props and names problems of the server picture', async () => {
  // Higher than every load of the person: where props are, and nothing else.
  const aboveLoads = async (page) => {
    const { width, height, data } = await pixelsOf(page, '#view');
    let count = 0;
    for (let y = 0; y < height; ++y) {
      let reds = 0;
      for (let x = 0; x < width; ++x) {
        const [r, g, b] = data.slice(4 * (y * width + x), 4 * (y * width + x) + 3);
        reds += isRed(r, g, b) ? 1 : 0;
        count += r > 40 && r < 110 && g - r >= 6 && b - g >= 12 ? 1 : 0;  // of their slate
      }
      if (reds > 3) return count;
    }
    return 0;  // no person yet
  };
  const bare = await openLive({ viewport: DESKTOP, isDrawn: true });
  await seePixels(bare.page, 'red', isRed, 300);
  const before = await aboveLoads(bare.page);
  assert.ok(before < 100, `${before} such pixels are there without props`);
  await bare.close();

  const folder = await mkdtemp(join(tmpdir(), 'kinescope_gloves_'));
  const diagnostics = { pictures: { problems: ['mesh package://arm/hand.stl: package <b>arm</b> is not found'] } };
  const worn = await startFixture(['--worn', '--meshes', folder, '--diagnostics', JSON.stringify(diagnostics)]);
  const meshed = (await linksOf(worn.url)).filter(({ visuals }) => visuals.some(({ mesh }) => mesh))
    .map(({ name }) => name.replace('skeleton_', ''));
  assert.equal(meshed.length, 21 + 40, 'the fingers, and no hand beside them');
  await Promise.all(meshed.map((name) => writeFile(join(folder, `${name}.stl`), boxStl([0.03, 0.03, 0.03]))));
  const { page, problems, close } = await openPage(worn.url, { viewport: DESKTOP, isDrawn: true });
  await statusIs(page, 'Live');
  const until = Date.now() + LONG.timeout;
  while (await aboveLoads(page) < 400) assert.ok(Date.now() < until, 'no props above the loads');
  await page.waitForFunction(() => performance.getEntriesByType('resource')
    .filter(({ name }) => name.includes('/api/v1/mesh/')).length === 61, null, LONG);
  await page.locator('#diagnostics').waitFor({ state: 'visible', ...LONG });
  assert.deepEqual(await page.$$eval('#problems li', (all) => all.map((line) => line.textContent)),
    ['Missing or replaced in the server picture: mesh package://arm/hand.stl: package <b>arm</b> is not found']);
  await saveScreenshot(page, 'worn_desktop');
  assert.deepEqual(problems, []);
  await close();
  await worn.stop();
  await rm(folder, { recursive: true });
});

test('the loads of two people are listed by name', async () => {
  const { page, close } = await openLive();
  site.say('people 2');
  // Names come in a message of their own, a moment after the numbers.
  await page.waitForFunction(() => {
    const labels = [...document.querySelectorAll('#loads .label')].map((label) => label.textContent);
    return labels.length === 30 && labels.includes('Demo: L5/S1') && labels.includes('Demo 2: L5/S1');
  }, null, LONG);
  await close();
});

test('a hand load can be set for each person, and the readings show the selected person', async () => {
  const { page, problems, close } = await openLive();
  assert.equal(await page.locator('#hand-person').isVisible(), false, 'one person needs no choice');
  site.say('people 2');
  await page.locator('#hand-person').waitFor({ state: 'visible', ...LONG });
  assert.deepEqual(await page.$$eval('#hand-person option', (all) => all.map((option) => option.text)), ['Demo', 'Demo 2']);
  await page.selectOption('#hand-person', { label: 'Demo 2' });
  await page.selectOption('#hand', 'left_kg');
  await page.fill('#hand-kg', '3.5');
  await page.click('#hand-load button');
  await page.waitForFunction(() => document.getElementById('loads-hint').textContent.includes('hand load 3.5 kg left'), null, LONG);
  for (const [name, viewport] of [['phone', PHONE], ['desktop', DESKTOP]]) {
    await page.setViewportSize(viewport);
    const cut = await page.evaluate(() => [...document.querySelectorAll('#hand-load > *, #loads-title')]
      .filter((part) => part.getBoundingClientRect().right > document.querySelector('.loads').getBoundingClientRect().right)
      .map((part) => part.id || part.tagName));
    assert.deepEqual(cut, [], name);
    await saveScreenshot(page, `two_people_${name}`);
  }
  await page.selectOption('#hand-person', { label: 'Demo' });
  await page.waitForFunction(() => !document.getElementById('loads-hint').textContent.includes('3.5 kg'), null, LONG);
  assert.deepEqual(problems, []);
  await close();
});

for (const [name, viewport, colorScheme] of [
  ['desktop', DESKTOP, 'light'], ['phone_dark', PHONE, 'dark']]) {
  test(`the page fits ${name} without clipping or horizontal scrolling`, async () => {
    const { page, problems, close } = await openLive({ viewport, colorScheme, isDrawn: true });
    await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
    await seePixels(page, 'red', isRed, 100);
    const { scroll, client } = await page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth, client: document.documentElement.clientWidth }));
    assert.ok(scroll <= client, `${scroll} px wide on ${client}`);
    const cut = await page.evaluate(() => [...document.querySelectorAll(
      '#status, .readings dd, button, select, #loads .label, #loads .word, #loads .ratio, #loads .note, #loads-hint, #legend li, h1, h2')]
      .filter((part) => part.offsetParent && part.clientWidth > 1 && part.scrollWidth > part.clientWidth + 1 && getComputedStyle(part).display !== 'inline'
        || part.getBoundingClientRect().right > innerWidth + 0.5)
      .map((part) => `${part.className || part.id || part.tagName}: ${part.textContent}`));
    assert.deepEqual(cut, []);
    if (viewport === DESKTOP) {
      const all = await page.locator('.load-list').evaluate((list) => list.scrollHeight - list.clientHeight);
      assert.ok(all <= 0, `the load list needs ${all} px more`);
    }
    await saveScreenshot(page, `live_${name}`);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('the contrast of texts to their background is at least 4.5 to 1', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const { page, close } = await openLive({ colorScheme });
    await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
    const poor = await page.evaluate(() => {
      const canvas = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
      // Paints one colour over another as the browser would, and reads what comes out.
      const over = (below, color) => {
        canvas.fillStyle = below;
        canvas.fillRect(0, 0, 1, 1);
        canvas.fillStyle = color;
        canvas.fillRect(0, 0, 1, 1);
        return [...canvas.getImageData(0, 0, 1, 1).data].slice(0, 3);
      };
      const css = (rgb) => `rgb(${rgb.join()})`;
      const light = (rgb) => rgb.map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
        .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
      const background = (part) => (part === null ? [255, 255, 255]
        : over(css(background(part.parentElement)), getComputedStyle(part).backgroundColor));
      return [...document.querySelectorAll('#status-word, dt, dd, #source, #viewers, button, h1, h2, .label, .note, .word, .ratio, .hint, #legend li')]
        .filter((part) => part.offsetParent && part.textContent.trim() && !part.disabled)
        .map((part) => {
          const behind = background(part);
          const [a, b] = [light(over(css(behind), getComputedStyle(part).color)), light(behind)].sort((x, y) => y - x);
          return { part: `${part.id || part.className || part.tagName} ${part.textContent.trim()}`, ratio: (a + 0.05) / (b + 0.05) };
        })
        .filter(({ ratio }) => ratio < 4.5).map(({ part, ratio }) => `${part}: ${ratio.toFixed(2)}`);
    });
    assert.deepEqual(poor, [], colorScheme);
    await close();
  }
});
