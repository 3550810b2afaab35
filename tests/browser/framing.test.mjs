// How large the view shows people, and that no overlay is over them: measured in the pixels of the canvas.
import assert from 'node:assert/strict';
import { test as nodeTest } from 'node:test';
import { DESKTOP, saveScreenshot } from './open_page.mjs';
import { moved, onlyView, record, serve, whatCovers } from './same_pixels.mjs';

const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const SKIN = { route: '**/api/v1/skin/**', address: 'api/v1/skin' };
const OVERLAYS = ['#cameras', '#points', '#loads-shown', '#banner'];

/** On the right side, the face to +x. */
const lyingDown = (frame) => moved(frame,
  ([w, x, y, z]) => [w + x, x - w, y + z, z - y].map((v) => v * Math.SQRT1_2),
  ([x, y, z]) => [x, z - 0.95, 0.25 - y]);

/** The rectangle around what is covered, px of the page. */
function boxOf(covered, { width, height }, view) {
  let [left, top, right, bottom] = [width, height, 0, 0];
  covered.forEach((isCovered, i) => {
    if (!isCovered) return;
    const x = i % width, y = Math.floor(i / width);
    [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x + 1), Math.max(bottom, y + 1)];
  });
  const scale = view.width / width;
  return { left: view.x + scale * left, top: view.y + scale * top, right: view.x + scale * right, bottom: view.y + scale * bottom };
}

for (const { name, motion, change, viewport, camera } of [
  { name: 'a lying person fills the view of a desk', motion: 'n_pose', change: lyingDown, viewport: DESKTOP, camera: 'front' },
  { name: 'a squatting person fills the view of a desk', motion: 'squat', viewport: DESKTOP, camera: 'three_quarter' },
]) {
  test(`${name}, and is not under buttons, symbols or banner`, async () => {
    const site = await serve(await record(motion, 0.9, [], change), ['--pictures', 'off']);
    const { page, covered, size, close } = await whatCovers(site, camera, SKIN, undefined, viewport);
    const view = await page.locator('#view canvas').boundingBox();
    const person = boxOf(covered, size, view);
    await onlyView(page, false);
    await saveScreenshot(page, `framing_${motion}`);
    const overlays = await page.evaluate((selectors) => selectors.map((selector) => {
      const { left, top, right, bottom } = document.querySelector(selector).getBoundingClientRect();
      return { selector, left, top, right, bottom };
    }), OVERLAYS);
    const shown = overlays.filter(({ left, right }) => right > left);
    assert.ok(shown.length >= 2, 'there are overlays');
    for (const { selector, left, top, right, bottom } of shown) {
      const isOver = left < person.right && right > person.left && top < person.bottom && bottom > person.top;
      assert.ok(!isOver, `${selector} is over the person`);
    }
    const across = (person.right - person.left) / view.width, upright = (person.bottom - person.top) / view.height;
    const least = motion === 'squat' ? 0.5 : 0.6;  // beside the overlays, which take a part of the height
    assert.ok(Math.max(across, upright) >= least, `${across.toFixed(2)} of the width, ${upright.toFixed(2)} of the height`);
    assert.ok(Math.max(across, upright) <= 0.86, `${across.toFixed(2)} of the width, ${upright.toFixed(2)} of the height`);
    await close();
    await site.stop();
  });
}
