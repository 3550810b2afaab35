// A hand load set on the page of a running `kinescope serve` (KINESCOPE_PAGE), to which a suit streams the
// T-pose; started by tests/system/ros/pipeline_test.cc.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { closeBrowser, countPixels, openPage, pixelsOf, saveScreenshot } from './open_page.mjs';

const LONG = { timeout: 60000 };
after(closeBrowser);

test('a load of two kilograms in a stretched-out hand makes that shoulder orange', async () => {
  const { page, problems, close } = await openPage(process.env.KINESCOPE_PAGE);
  const shoulderIs = (word) => page.waitForFunction((wanted) => {
    const row = [...document.querySelectorAll('#loads li')]
      .find((item) => item.querySelector('.label').textContent === 'Right shoulder');
    return row?.querySelector('.word').textContent === wanted;
  }, word, LONG);
  await shoulderIs('low');
  await page.selectOption('#hand', 'right_kg');
  await page.fill('#hand-kg', '2');
  await page.click('#hand-load button');
  await shoulderIs('medium');
  const isOrange = (r, g, b) => r > 200 && g > 90 && g < 190 && b < 110;
  const until = Date.now() + LONG.timeout;
  let orange = 0;
  while (orange < 60 && Date.now() < until) orange = countPixels(await pixelsOf(page, '#view'), isOrange);
  assert.ok(orange >= 60, `${orange} pixels are orange`);
  assert.match(await page.locator('#loads-hint').textContent(), /hand load 2 kg right/);
  await saveScreenshot(page, 'hand_load');
  await page.fill('#hand-kg', '0');
  await page.click('#hand-load button');
  await shoulderIs('low');
  assert.deepEqual(problems, []);
  await close();
});
