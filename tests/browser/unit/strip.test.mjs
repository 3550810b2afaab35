import assert from 'node:assert/strict';
import test from 'node:test';
import { Series } from '../../../web/series.js';
import { clockText, heightOf, labelsThatFit, shortened, spanOf, STRIP_KEYS, widthOf, wordOf, worstOf } from '../../../web/strip.js';
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
  assert.equal(clockText(NaN, 1), '–');
});

/** What a page knows: its newest state was made at 10 s of the server's clock. */
const known = (others) => ({
  newest: { madeMicros: 10e6, stampMicros: 1_000_010e6, liveness: 'live' }, recording: null, serverMillis: 10_000, wallMillis: 500_000, ...others,
});
const stale = { madeMicros: 10e6, stampMicros: 1_000_010e6, liveness: 'stale' };
const recording = { start_micros: 1_000_000e6, length_secs: 20, round_secs: null, ended_micros: null };

test('a page that is opened 43 s after the stream has stopped shows the times of day at which its samples came', () => {
  const clock = new WallClock();
  clock.update(known({ newest: stale, serverMillis: 53_000, wallMillis: 543_000 }));
  assert.equal(clock.at(10e6), 500_000);
  assert.equal(clock.at(4e6), 494_000);
});

test('times of day are those of the clock of the viewer, whatever the stamps are, and follow it when it is set', () => {
  const clock = new WallClock();
  assert.ok(Number.isNaN(clock.at(10e6)));
  clock.update(known({ serverMillis: null }));
  assert.ok(Number.isNaN(clock.at(10e6)), 'the clock of the server is not known yet');
  clock.update(known({}));
  assert.equal(clock.at(10e6), 500_000);
  clock.update(known({ newest: stale, serverMillis: 11_000, wallMillis: 3_601_000 }));
  assert.equal(clock.at(10e6), 3_600_000, 'also while the stream stands');
  clock.update(known({ serverMillis: 12_000, wallMillis: 3_602_006 }));
  assert.equal(clock.at(10e6), 3_600_000, 'but not each rounding of it');
});

test('times of day stay while the connection is lost, and are right with a server that has another clock', () => {
  const clock = new WallClock();
  clock.update(known({}));
  clock.update(known({ serverMillis: null, wallMillis: 520_000 }));
  assert.equal(clock.at(10e6), 500_000);
  clock.update(known({ serverMillis: 2000, wallMillis: 530_000 }));
  assert.equal(clock.at(1e6), 529_000);
});

test('a recording has the times of day of its stamps, when it plays and when it has ended', () => {
  const clock = new WallClock();
  clock.update(known({ recording }));
  assert.equal(clock.at(9e6), 1_000_009_000);
  // The state that says that the stream has stopped is made later than its last sample was played.
  clock.update(known({ recording, newest: { ...stale, madeMicros: 10.5e6 } }));
  assert.equal(clock.at(9e6), 1_000_009_000);
  const late = new WallClock();
  late.update(known({ newest: stale, serverMillis: 99_000 }));  // the server has not told yet that it plays a recording
  late.update(known({ recording: { ...recording, ended_micros: 10e6 }, newest: { ...stale, madeMicros: 10.5e6 }, serverMillis: 99_000 }));
  assert.equal(late.at(9e6), 1_000_009_000);
});

/** Labels of letters that are 9 px tall. */
const label = (text, middle) => ({ text, top: middle - 4.5, bottom: middle + 4.5 });
const fitting = (labels) => labelsThatFit(labels).map(({ text }) => text);

test('a label that would touch another one is left out, and those before it in the list stay', () => {
  assert.deepEqual(fitting([label('Ana', 6), label('Ben', 18), label('Cem', 30)]), ['Ana', 'Ben', 'Cem']);
  assert.deepEqual(fitting([label('Lost', 30), label('Ana', 4), label('Ben', 12), label('Cem', 20), label('Dora', 28)]), ['Lost', 'Ana', 'Cem']);
  assert.deepEqual(fitting([]), []);
});

test('a label that is too wide is shortened, and says so', () => {
  const widthOf = (text) => 7 * text.length;
  assert.equal(shortened('ana_1', 54, widthOf), 'ana_1');
  assert.equal(shortened('Character 12', 54, widthOf), 'Charac…');
  assert.equal(shortened('Character 12', 40, widthOf), 'Char…');
  assert.equal(shortened('👩‍🔬Anna-Maria', 54, () => 99), '…');
});
