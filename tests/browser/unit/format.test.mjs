import assert from 'node:assert/strict';
import test from 'node:test';
import * as format from '../../../web/format.js';

const table = (name, rows) => test(name, () => {
  for (const [actual, expected] of rows) assert.equal(actual, expected);
});

table('rates', [[format.rate(60), '60.0 Hz'], [format.rate(239.96), '240.0 Hz'], [format.rate(0), '–'],
  [format.rate(NaN), '–']]);
table('latencies', [[format.latency(4.21), '4.2 ms'], [format.latency(9.96), '10 ms'], [format.latency(38.6), '39 ms'],
  [format.latency(null), '–'], [format.latency(NaN), '–']]);
table('time codes', [[format.timeCode(0), '00:00:00.000'], [format.timeCode(83456), '00:01:23.456'],
  [format.timeCode(86399999), '23:59:59.999'], [format.timeCode(360000000), '100:00:00.000'], [format.timeCode(-1), '–'],
  [format.timeCode(NaN), '–']]);
table('lags', [[format.lag(0), '−0.0 s'], [format.lag(12_449), '−12.4 s'], [format.lag(59_960), '−1:00 min'],
  [format.lag(133_400), '−2:13 min'], [format.lag(-5), '−0.0 s']]);
table('ages', [[format.age(0.44), '0.4 s'], [format.age(12.7), '12 s'], [format.age(185), '3 min'],
  [format.age(7300), '2 h']]);
table('percentages', [[format.percent(0.256), '26 %'], [format.percent(1.4), '140 %'], [format.percent(NaN), '–']]);
table('moments', [[format.moment(-12.34, 60.4), '12 of 60 N·m'], [format.moment(3.26, 8), '3.3 of 8 N·m'],
  [format.moment(3.26, 0), '3.3 N·m'], [format.moment(NaN, 60), '']]);
table('colours', [[format.hexColor([1, 0.55, 0]), '#ff8c00'], [format.hexColor([0.1, 0.7, 0.25]), '#1ab340']]);
table('labels', [[format.labelText('HTC Vive 1'), 'HTC Vive 1'], [format.labelText('x'.repeat(24)), 'x'.repeat(24)],
  [format.labelText('😀'.repeat(25)), `${'😀'.repeat(23)}…`], [format.labelText(''), '']]);
table('cameras', [[format.cameraLabel('three_quarter'), 'three quarter'], [format.shortCameraLabel('iso'), 'iso']]);
