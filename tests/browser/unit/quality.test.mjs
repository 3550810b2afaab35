import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Quality } from '../../../web/quality.js';

/** @param {Quality} quality
 *  @param {number} count  of measurements
 *  @param {number} millis  between frames */
function measure(quality, count, millis) {
  for (let i = 0; i < 24 * count; ++i) quality.measure(millis);
}

test('a slow machine gets one reduction after the other, three at most', () => {
  const quality = new Quality(false), found = [];
  for (let i = 0; i < 5; ++i) {
    measure(quality, 1, 60);
    found.push(quality.reductions);
  }
  assert.deepEqual(found, [1, 2, 3, 3, 3]);
});

test('a machine that was busy for a moment has the whole quality again', () => {
  const quality = new Quality(false);
  measure(quality, 2, 60);
  assert.equal(quality.reductions, 2);
  measure(quality, 5, 16);
  assert.equal(quality.reductions, 1);
  measure(quality, 20, 16);
  assert.equal(quality.reductions, 0);
});

test('what is too much again and again is tried less and less often', () => {
  const quality = new Quality(false);
  let reduced = 0;
  for (let i = 0; i < 200; ++i) {
    const before = quality.reductions;
    measure(quality, 1, quality.reductions === 0 ? 60 : 16);
    if (quality.reductions > before) ++reduced;
  }
  assert.ok(reduced <= 4, `${reduced} times`);
});

test('frames that are neither slow nor quick change nothing, nor does a view that was hidden', () => {
  const quality = new Quality(false);
  measure(quality, 1, 60);
  measure(quality, 50, 33);
  measure(quality, 50, 2000);
  assert.equal(quality.reductions, 1);
});

test('a very slow view is reduced within a few frames, and one hitch is not taken for that', () => {
  const slow = new Quality(false), hitched = new Quality(false);
  for (let i = 0; i < 5; ++i) slow.measure(600);
  assert.equal(slow.reductions, 1);
  for (const millis of [900, 16, 16, 16, 16, 16]) hitched.measure(millis);
  assert.equal(hitched.reductions, 0);
});

test('a fixed quality is never reduced', () => {
  const quality = new Quality(true);
  measure(quality, 10, 60);
  assert.equal(quality.reductions, 0);
});
