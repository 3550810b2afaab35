import assert from 'node:assert/strict';
import test from 'node:test';
import { pointsOf, roundedUp } from '../../../web/plot.js';
import { cellOf, csvOf, fileNameOf } from '../../../web/plot_files.js';
import { shortJoint, trialsIn } from '../../../web/plots.js';
import { Series } from '../../../web/series.js';

const WIDTH = 100_000;  // µs
const known = (min, max) => ({ samples: 6, values: { margin: { min, max, last: max } } });
const unknown = { samples: 6, values: { margin: { min: null, max: null, last: null } } };
const empty = { ...unknown, samples: 0 };
function seriesOf(columns) {
  const series = new Series({ person: 0, keys: ['margin'], width: WIDTH });
  series.put({ first: 0, end: columns.length }, columns, columns.length * WIDTH);
  return series;
}

test('each column gives its smallest and largest value, the nearer one to the column before first', () => {
  const [times, values] = pointsOf(seriesOf([known(1, 2), known(1, 3), known(0, 3)]), ['margin'], { from: 100_000, to: 200_000 }, 10);
  assert.deepEqual(times.slice(0, 4), [25_000, 75_000, 125_000, 175_000]);
  assert.deepEqual(values.slice(0, 6), [10, 20, 10, 30, 30, 0]);
});

test('an unknown value and a gap interrupt the line, a slow stream does not', () => {
  const series = seriesOf([known(1, 1), unknown, known(1, 1), empty, empty, known(1, 1), ...Array(6).fill(empty), known(1, 1)]);
  const [, values] = pointsOf(series, ['margin'], { from: 100_000, to: 1_250_000 }, 1);
  const byColumn = Array.from({ length: 13 }, (_, n) => values[2 * n]);
  assert.deepEqual(byColumn, [1, null, 1, undefined, undefined, 1, null, null, null, null, null, null, 1]);
});

test('axes end at round numbers', () => {
  for (const [value, wanted] of [[80, 80], [81, 100], [4, 4], [0.031, 0.04], [101, 150], [999, 1000], [0.1 + 0.2, 0.3]]) {
    assert.ok(Math.abs(roundedUp(value) - wanted) < 1e-9, `${value}: ${roundedUp(value)}`);
  }
});

test('files name the trials that ran in their time', () => {
  const trial = (text, micros, endMicros) => ({ micros, endMicros, label: '▶', text, isTrial: true });
  const flags = [trial('before', 0, 100), trial('anna lifts 1', 50, 300), trial('now', 250, null), { ...trial('a mark', 200, null), isTrial: false }];
  assert.deepEqual(trialsIn(flags, 100, 200), ['anna lifts 1']);
  assert.deepEqual(trialsIn(flags, 200, 400), ['anna lifts 1', 'now']);
});

test('joints have short names', () => {
  assert.equal(shortJoint('Right shoulder'), 'R shoulder');
  assert.equal(shortJoint('Left wrist'), 'L wrist');
  assert.equal(shortJoint('L5/S1'), 'L5/S1');
});

test('the CSV has a row for each column, with person and trial, and nothing that a spreadsheet would run', async () => {
  const about = { person: '=HYPERLINK("x")', source: 'udp://0.0.0.0:9763', from: 0, to: 300_000, wallMillis: (micros) => micros / 1000,
    flags: [{ micros: 120_000, endMicros: null, label: '1', text: 'lifts; slowly', isTrial: false },
      { micros: 199_999, endMicros: 250_000, label: '2', text: '=x', isTrial: false }] };
  const text = await csvOf(seriesOf([known(1, 2), unknown, empty, known(5, 5)]), about).text();
  const name = '"\'=HYPERLINK(""x"")"';
  assert.deepEqual(text.split('\r\n'), [
    'person,source,time,seconds,samples,margin_min,margin_max,margin_last,marks',
    `${name},udp://0.0.0.0:9763,1970-01-01T00:00:00.000Z,0.000,6,1,2,2,`,
    `${name},udp://0.0.0.0:9763,1970-01-01T00:00:00.100Z,0.100,6,,,,lifts; slowly; =x`,
    `${name},udp://0.0.0.0:9763,1970-01-01T00:00:00.200Z,0.200,0,,,,`,
    '']);
  assert.equal(cellOf('a,b'), '"a,b"');
  assert.equal(fileNameOf({ ...about, person: '../Änne S.' }, 'csv'), 'kinescope__Änne_S__1970-01-01T00-00-00-300Z.csv');
});
