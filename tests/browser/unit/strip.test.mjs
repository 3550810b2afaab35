import assert from 'node:assert/strict';
import test from 'node:test';
import { Series } from '../../../web/series.js';
import { clockText, heightOf, spanOf, STRIP_KEYS, widthOf, wordOf, worstOf } from '../../../web/strip.js';
import { WallClock } from '../../../web/wall_clock.js';

const WIDTH = 100_000;  // µs
/** @param {number[][]} values  high, medium, unknown joints and loss of each column; [] without samples */
function seriesOf(values) {
  const series = new Series({ person: 0, keys: STRIP_KEYS, width: WIDTH });
  series.put({ first: 0, end: values.length }, values.map((each) => ({
    samples: each.length > 0 ? 6 : 0,
    values: Object.fromEntries(STRIP_KEYS.map((key, i) => [key, { min: 0, max: each[i] ?? null, last: 0 }])),
  })), values.length * WIDTH);
  return series;
}
const look = (high, medium, isUnknown = false) => ({ high, medium, isUnknown, loss: 0 });

test('the height of a column says its class: a line, 22 to 60 % by the number of joints, or all', () => {
  assert.equal(heightOf(look(0, 0)), 0);
  assert.equal(heightOf(look(0, 1)), 0.22);
  assert.ok(heightOf(look(0, 4)) > heightOf(look(0, 3)));
  assert.equal(heightOf(look(0, 10)), 0.6);
  assert.equal(heightOf(look(0, 15)), 0.6);
  assert.equal(heightOf(look(1, 1)), 1);
});

test('a column has the worst of its samples, of all people in its row', () => {
  const quiet = seriesOf([[0, 0, 0, 0], [0, 2, 1, 0], [0, 0, 0, 0], []]);
  const loud = seriesOf([[0, 1, 15, 0.2], [0, 0, 0, 0], [1, 5, 0, 0], []]);
  assert.deepEqual(worstOf([quiet], 0, 3 * WIDTH), { high: 0, medium: 2, isUnknown: false, loss: 0 });
  assert.deepEqual(worstOf([quiet, loud], 0, 3 * WIDTH), { high: 1, medium: 5, isUnknown: true, loss: 0.2 });
  assert.equal(wordOf(worstOf([loud], 2 * WIDTH, 3 * WIDTH)), 'high');
  assert.equal(wordOf(worstOf([loud], WIDTH, 2 * WIDTH)), 'low');
  assert.equal(wordOf(worstOf([quiet], 3 * WIDTH, 4 * WIDTH)), 'no samples');
  assert.equal(wordOf(look(0, 0, true)), 'unknown');
});

test('the strip is as long as the next of a few times, and its columns see each tenth of a second of ten minutes', () => {
  assert.equal(spanOf(0), 10.1e6);
  assert.equal(spanOf(10_200_000), 20.2e6);
  assert.equal(spanOf(580e6), 606e6);
  assert.equal(spanOf(602e6), 606e6, 'ten minutes are kept in pieces');
  assert.ok(spanOf(7200e6) >= 7200e6);
  for (const secs of [10, 600, 3600]) assert.ok(secs * 1e6 / widthOf(secs * 1e6) <= 2400);
  assert.equal(widthOf(600e6), 250_000);
});

test('clock texts have seconds where minutes have several', () => {
  const wall = new Date(2026, 0, 5, 9, 7, 4).getTime();
  assert.equal(clockText(wall, 60_000), '09:07');
  assert.equal(clockText(wall, 10_000), '09:07:04');
});

test('the clock follows the sample that came quickest, and a clock that was set', () => {
  const clock = new WallClock();
  clock.add(1000, 501_050);
  clock.add(1100, 501_120);
  clock.add(1200, 501_290);
  assert.equal(clock.at(2_000_000), 502_020);
  clock.add(1300, 3_601_300);
  assert.equal(clock.at(2_000_000), 3_602_000);
});
