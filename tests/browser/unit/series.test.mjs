import assert from 'node:assert/strict';
import test from 'node:test';
import { columnsOf, Feed, routeOf, Series } from '../../../web/series.js';

const WIDTH = 100_000;  // µs
const grid = { person: 3, keys: ['rate', 'loss'], width: WIDTH };
const column = (rate, samples = 10) => ({ samples, values: { rate: { min: rate, max: rate + 1, last: rate }, loss: { min: null, max: null, last: null } } });
const columns = (first, end) => Array.from({ length: end - first }, (_, i) => column(first + i));
/** With the columns from `first` to `end`, asked for when the newest sample was at the end of the last one. */
const filled = (first, end) => {
  const series = new Series(grid);
  series.put({ first, end }, columns(first, end), end * WIDTH - 1);
  return series;
};

test('a request names person, keys, times and columns', () => {
  assert.equal(routeOf(grid, { first: 10, end: 30 }),
    'api/v1/series?person=3&keys=rate%2Closs&from=1000000&to=3000000&columns=20');
});

test('only what is new is asked for, from the first column that may still have grown', () => {
  const series = new Series(grid);
  assert.deepEqual(series.missing(0, 1_000_000, 950_000), { first: 0, end: 10 });
  series.put({ first: 0, end: 10 }, columns(0, 10), 950_000);
  assert.equal(series.missing(0, 1_000_000, 950_000), null, 'no sample has come since');
  assert.deepEqual(series.missing(0, 2_000_000, 1_250_000), { first: 7, end: 13 });
  series.put({ first: 7, end: 13 }, columns(7, 13), 1_250_000);
  assert.equal(series.column(12).values.rate.last, 12);
  assert.equal(series.missing(0, 900_000, 9_000_000), null, 'a former time is complete');
});

test('what is before is loaded in front, and what is elsewhere replaces all', () => {
  const series = filled(50, 60);
  assert.deepEqual(series.missing(4_000_000, 5_500_000, 5_999_999), { first: 40, end: 50 });
  series.put({ first: 40, end: 50 }, columns(40, 50), 5_999_999);
  for (let n = 40; n < 60; ++n) assert.equal(series.column(n).values.rate.last, n);
  assert.deepEqual(series.missing(9_000_000, 9_500_000, 20_000_000), { first: 90, end: 96 });
  series.put({ first: 90, end: 96 }, columns(90, 96), 20_000_000);
  assert.equal(series.column(59), undefined);
  assert.equal(series.column(95).values.rate.last, 95);
});

test('a request stays within the limits of the server, the newest first', () => {
  const many = new Series({ ...grid, keys: Array.from({ length: 10 }, () => 'rate') });
  assert.deepEqual(many.missing(0, 600_000_000, 600_000_000), { first: 4001, end: 6001 });
  const few = new Series(grid);
  assert.deepEqual(few.missing(0, 600_000_000, 600_000_000), { first: 1905, end: 6001 });
});

test('columns that the server forgets are forgotten', () => {
  const series = filled(0, 100);
  series.forget(4_250_000);
  assert.equal(series.column(41), undefined);
  assert.equal(series.column(42).values.rate.last, 42);
  series.forget(99_000_000);
  assert.equal(series.hasSamples, false);
});

test('the worst of several columns is that of the peak in any of them', () => {
  const series = filled(0, 20);
  series.put({ first: 7, end: 8 }, [column(500)], 2_000_000);
  assert.deepEqual(series.worst(550_000, 900_000, 'rate'), { min: 5, max: 501, samples: 40 });
  assert.equal(series.worst(550_000, 900_000, 'loss'), null);
  assert.equal(series.worst(3_000_000, 4_000_000, 'rate'), null);
});

test('a gap is half a second without samples; less is a slow stream', () => {
  const series = filled(0, 30);
  const empty = (first, end) =>
    series.put({ first, end }, Array.from({ length: end - first }, () => column(0, 0)), 3_000_000);
  empty(10, 14);
  for (let n = 10; n < 14; ++n) assert.equal(series.isGap(n, 3_000_000), false);
  empty(20, 25);
  for (let n = 20; n < 25; ++n) assert.equal(series.isGap(n, 3_000_000), true, String(n));
});

test('an answer has the values of each column', () => {
  const [first, second] = columnsOf({ samples: [4, 0], keys: { rate: { min: [1, null], max: [2, null], last: [1.5, null] } } });
  assert.deepEqual(first, { samples: 4, values: { rate: { min: 1, max: 2, last: 1.5 } } });
  assert.deepEqual(second, { samples: 0, values: { rate: { min: null, max: null, last: null } } });
});

test('the feed asks in rounds: the next one when all answers have come, and not too soon', async () => {
  const asked = [], waiting = [];
  const feed = new Feed((of, span) => new Promise((resolve) => {
    asked.push(of.person);
    waiting.push(() => resolve(columns(span.first, span.end)));
  }));
  const [one, two] = [1, 2].map((person) => new Series({ ...grid, person }));
  const wanted = [one, two].map((series) => ({ series, from: 0, to: 9_000_000 }));
  const update = (now) => feed.update(wanted, 1_000_000 + 1000 * now, now);
  const first = update(0);
  update(500);
  waiting.shift()();
  update(600);
  assert.deepEqual(asked, [1, 2], 'an answer has not come');
  waiting.shift()();
  assert.equal(await first, '');
  assert.equal(one.column(5).values.rate.last, 5);
  const second = update(900);
  assert.deepEqual(asked, [1, 2, 1, 2]);
  while (waiting.length > 0) waiting.shift()();
  await second;
  await update(1100);
  assert.equal(asked.length, 4, 'too soon');
});

test('after a rejection the feed says why and waits', async () => {
  let count = 0;
  const feed = new Feed(() => { ++count; return Promise.reject(new Error('person=3: no samples are kept')); });
  const wanted = [{ series: new Series(grid), from: 0, to: 1_000_000 }];
  assert.equal(await feed.update(wanted, 1_000_000, 0), 'person=3: no samples are kept');
  await feed.update(wanted, 2_000_000, 1000);
  assert.equal(count, 1);
  assert.ok(!feed.isComplete, 'what was rejected is missing while it waits');
  await feed.update(wanted, 5_000_000, 3500);
  assert.equal(count, 2);
});
