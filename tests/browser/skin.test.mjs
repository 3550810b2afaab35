// The person on the page and in the server's pictures is the same surface: what the skin covers, pixel by pixel.
import assert from 'node:assert/strict';
import { test as nodeTest } from 'node:test';
import { DESKTOP, openPage, PHONE, pixelsOfPng, saveScreenshot, settled } from './open_page.mjs';
import { cameraOf, grown, LONG, MARKS, mask, moved, onlyView, overlap, PLAIN, record, serve, serverPixels, whatCovers }
  from './same_pixels.mjs';

const REST = `${MARKS},shadows`;  // everything but the body
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const SKIN = { route: '**/api/v1/skin/**', address: 'api/v1/skin' };

const turnedAround = (/** @type {string} */ frame) =>
  moved(frame, ([w, x, y, z]) => [-z, -y, x, w], ([x, y, z]) => [-x, -y, z]);

for (const { motion, seconds, camera, person } of [
  { motion: 'squat', seconds: 1.2, camera: 'left', person: [] },
  { motion: 'lift', seconds: 1, camera: 'three_quarter', person: ['--sex', 'female', '--mass', '60', '--height', '1.64'] },
  { motion: 'overhead', seconds: 1.5, camera: 'front', person: ['--mass', '105'] },
  { motion: 'sit', seconds: 0.1, camera: 'iso', person: [] },
]) {
  test(`the skin of ${motion} covers the same pixels on the page and in the server's picture`, async () => {
    const file = await record(motion, seconds, person);
    const site = await serve(file, [...person, '--pictures', 'off']);
    const { page, covered: onPage, size, close } = await whatCovers(site, camera, SKIN);
    const sameCamera = await cameraOf(page, camera, size);
    const drawn = [];
    for (const hidden of [REST, `${REST},body`, REST.replace('loads,', '')]) {
      drawn.push(await serverPixels(file, sameCamera, size, [...PLAIN, hidden, ...person]));
    }
    const [body, nothing, withLoads] = drawn;
    const inPicture = mask(body, nothing);
    await saveScreenshot(page, `skin_${motion}`);
    const { share, either } = overlap(onPage, inPicture, grown(mask(body, withLoads), size));
    assert.ok(either > 0.02 * onPage.length, `${either} pixels`);
    assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels are covered by both`);
    await close();
    await site.stop();
  });
}

/** A live picture of the recording. */
async function snapshotOf(file, camera, { width, height }) {
  const live = await serve(file, ['--loop', '--picture_size', '64x64']);  // a stale picture has a banner
  const watcher = await openPage(live.url);
  // Before the first sample, a snapshot has no person.
  await watcher.page.waitForFunction(() => document.getElementById('status-word').textContent.startsWith('Recording'), null, LONG);
  await watcher.close();
  const answer = await fetch(`${live.url}api/v1/snapshot.png?camera=${camera}&width=${width}&height=${height}`);
  const png = Buffer.from(await answer.arrayBuffer());
  await live.stop();
  return pixelsOfPng(png);
}

test('a person who faces -x is shown from the front, on the page and in a snapshot', async () => {
  const motion = 'walk', camera = 'front', nothing = new Uint8Array(1 << 24);
  const files = [await record(motion, 0.9, []), await record(motion, 0.9, [], turnedAround)];
  const straight = await serve(files[0], ['--pictures', 'off']);
  const expected = await whatCovers(straight, camera, SKIN);
  await expected.close();
  await straight.stop();
  const site = await serve(files[1], ['--pictures', 'off']);
  const { page, covered: onPage, size, close } = await whatCovers(site, camera, SKIN);
  await saveScreenshot(page, 'skin_turned');
  const same = overlap(onPage, expected.covered, nothing);
  assert.ok(same.either > 0.02 * onPage.length, `${same.either} pixels`);
  assert.ok(same.share >= 0.95, `${same.share.toFixed(4)} of the pixels on the page are those of a person who faces x`);
  const [one, other] = [await snapshotOf(files[0], camera, size), await snapshotOf(files[1], camera, size)];
  const others = mask(one, other).reduce((sum, isOther) => sum + isOther, 0);
  assert.ok(others < 0.05 * same.either, `${others} pixels of a snapshot are not those of a person who faces x`);
  await close();
  await site.stop();
});

/** Where a load class is shown: nothing else on a person is as colourful. */
function colourful({ width, height, data }) {
  const covered = new Uint8Array(width * height);
  for (let i = 0; i < covered.length; ++i) {
    const channels = [0, 1, 2].map((k) => data[4 * i + k]);
    covered[i] = Math.max(...channels) - Math.min(...channels) > 60 ? 1 : 0;
  }
  return covered;
}

test('loads lie on the same pixels of the skin on the page and in the picture of the server', async () => {
  const file = await record('lift', 1, []);
  const site = await serve(file, ['--loop', '--loads', 'skin', '--style', 'clay', '--pictures', 'off']);
  const { page, problems, close } = await openPage(site.url, { colorScheme: 'dark' });
  await page.waitForFunction(() => document.getElementById('status-word').textContent.startsWith('Recording'), null, LONG);
  const choice = page.getByLabel('Where joint loads are shown');
  await choice.waitFor(LONG);
  assert.equal(await choice.inputValue(), 'skin', 'as the server was started');
  await page.locator('#cameras button[data-camera="right"]').click();
  await onlyView(page, true);
  const shown = await settled(page);
  const size = { width: shown.width, height: shown.height };
  await saveScreenshot(page, 'skin_loads');
  const options = ['--loads', 'skin', '--style', 'clay', ...PLAIN, REST.replace('loads,', '')];
  const drawn = await serverPixels(file, await cameraOf(page, 'right', size), size, options);
  const points = colourful(await serverPixels(file, await cameraOf(page, 'right', size), size,
    [...PLAIN, `${REST.replace('loads,', '')},loads,body`]));
  // Centre of mass and pressure are drawn on the page only.
  const isMark = (pixels) => pixels.data.reduce((marks, _, at) => {
    if (at % 4 === 0 && pixels.data[at + 2] > 1.3 * pixels.data[at + 1]) marks[at / 4] = 1;
    return marks;
  }, new Uint8Array(size.width * size.height));
  assert.equal(points.reduce((sum, each) => sum + each, 0), 0, 'nothing else is colourful');
  const { share, either } = overlap(colourful(shown), colourful(drawn), isMark(shown));
  assert.ok(either > 0.002 * shown.width * shown.height, `${either} pixels`);
  assert.ok(share >= 0.85, `${share.toFixed(4)} of the colourful pixels are so in both`);
  await onlyView(page, false);
  await choice.focus();
  await page.keyboard.press('ArrowUp');
  assert.equal(await choice.inputValue(), 'spheres', 'by the keyboard');
  await onlyView(page, true);
  const spheres = await settled(page);
  assert.ok(overlap(colourful(spheres), colourful(drawn), isMark(spheres)).share < 0.6);
  await saveScreenshot(page, 'skin_spheres');
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
});

test('the choice where loads are shown has room beside everything else', async () => {
  const site = await serve(await record('walk', 0.9, []), ['--loop', '--loads', 'both', '--pictures', 'off']);
  for (const [name, viewport] of Object.entries({ desktop: DESKTOP, phone: PHONE })) {
    const { page, close } = await openPage(site.url, { viewport });
    await page.waitForFunction(() => document.getElementById('status-word').textContent.startsWith('Recording'), null, LONG);
    await page.getByLabel('Where joint loads are shown').waitFor(LONG);
    await settled(page);
    await saveScreenshot(page, `skin_both_${name}`);
    const boxOf = (selector) => page.locator(selector).boundingBox();
    const own = await boxOf('#loads-shown'), stage = await boxOf('.stage');
    assert.ok(own.x > stage.x && own.x + own.width < stage.x + stage.width && own.y > stage.y, name);
    for (const other of ['#cameras', '.points']) {
      const { x, y, width, height } = await boxOf(other);
      assert.ok(x >= own.x + own.width || own.x >= x + width || y >= own.y + own.height || own.y >= y + height,
        `${name}: it overlaps ${other}`);
    }
    for (const words of ['The stream has stopped: last sample received 12 s ago', 'long '.repeat(30)]) {
      const covered = await page.evaluate((text) => {
        const banner = document.getElementById('banner');
        banner.hidden = false;
        banner.textContent = text;
        const own = banner.getBoundingClientRect();
        return ['#loads-shown', '#cameras', '.points'].filter((selector) => {
          const other = document.querySelector(selector).getBoundingClientRect();
          return own.left < other.right && other.left < own.right && own.top < other.bottom && other.top < own.bottom;
        });
      }, words);
      assert.deepEqual(covered, [], `${name}: a banner covers controls`);
    }
    await close();
  }
  await site.stop();
});

// In the page, before its own programs: pictures take 60 ms each, and `trianglesDrawn` are those of the largest mesh of the
// last one.
function drawSlowly() {
  let largest = 0;
  const { drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawElements = function draw(mode, count, ...more) {
    largest = Math.max(largest, count / 3);
    return drawElements.call(this, mode, count, ...more);
  };
  window.requestAnimationFrame = (callback) => setTimeout(() => {
    largest = 0;
    callback(performance.now());
    if (largest > 0) window.trianglesDrawn = largest;
  }, 60);
}

test('a view that cannot keep up is drawn with fewer triangles, and at rest with all', async () => {
  const site = await serve(await record('walk', 5, []), ['--loop', '--pictures', 'off']);
  const { page, problems, close } = await openPage(site.url, { beforeLoad: (opened) => opened.addInitScript(drawSlowly) });
  // The coarse skin may be there before the whole one, which then waits until the view is at rest.
  const isCoarse = () => page.waitForFunction(() => window.trianglesDrawn > 4500 && window.trianglesDrawn < 8000, null, LONG);
  await isCoarse();
  await saveScreenshot(page, 'skin_coarse');
  await page.getByRole('button', { name: 'Pause' }).click();
  await settled(page);
  await page.waitForFunction(() => window.trianglesDrawn > 30000, null, LONG);
  await saveScreenshot(page, 'skin_at_rest');
  await page.getByRole('button', { name: 'Play' }).click();
  await isCoarse();
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
});
