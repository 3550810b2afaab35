// The page of a running `kinescope serve` (KINESCOPE_PAGE) that a suit streams to; started by
// tests/system/ros/pipeline_test.cc.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { closeBrowser, countPixels, openPage, pixelsOf, saveScreenshot } from './open_page.mjs';

const LONG = { timeout: 60000 };
after(closeBrowser);

test('the page shows the person of a streaming suit and its rate', async () => {
  const { page, problems, close } = await openPage(process.env.KINESCOPE_PAGE);
  await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live', null, LONG);
  // Of samples as they come, a second at a time: a busy machine lets one second have fewer and the next more.
  await page.waitForFunction(() => /^1[12]\d\.\d Hz$/.test(document.getElementById('rate').textContent), null, LONG);
  const isBody = (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) < 30 && g > 90 && g < 215;
  const isGreen = (r, g, b) => g > 90 && r < 0.6 * g && b < 0.85 * g;
  const until = Date.now() + LONG.timeout;
  let body = 0, green = 0, size = 1;
  while ((body < 0.01 * size || green < 100) && Date.now() < until) {
    const pixels = await pixelsOf(page, '#view');
    size = pixels.width * pixels.height;
    body = countPixels(pixels, isBody);
    green = countPixels(pixels, isGreen);
  }
  assert.ok(body >= 0.01 * size, `${body} of ${size} pixels are body`);
  assert.ok(green >= 100, `${green} pixels are green spheres`);
  await saveScreenshot(page, 'whole_program');
  assert.deepEqual(problems, []);
  await close();
});
