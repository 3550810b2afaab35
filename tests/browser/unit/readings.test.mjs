import assert from 'node:assert/strict';
import test from 'node:test';
import { comText, copText, loadsHint, meshesText, readingsOf, streamReadingsOf } from '../../../web/readings.js';

const person = { metric: 'total', isDynamic: true, comSource: 'mvn', comDisagrees: false, comMinusMvn: NaN,
  groundIsMeasured: false, cop: [0, 0, 0], margin: 0.083, compression: 2150 };
const details = { mass_kg: 75, mass_is_assumed: false, hand_load: { right_kg: 0, left_kg: 0, both_kg: 0 },
  why_other_metric: '', why_no_ground: '', filter: '', delay_secs: 0, floor_z_m: 0 };

test('the hint states the metric, the mode and the assumptions of the loads', () => {
  assert.equal(loadsHint(person, details), 'load metric: total, dynamic · floor at z = 0.00 m');
  assert.equal(loadsHint(person, { ...details, filter: 'causal', delay_secs: 0.045, floor_z_m: null }),
    'load metric: total, dynamic · 45 ms late (causal filter) · floor not found');
  assert.equal(loadsHint({ ...person, isDynamic: false }, details), 'load metric: total, static · floor at z = 0.00 m');
  assert.equal(loadsHint({ ...person, metric: 'external' }, details), 'load metric: external · floor at z = 0.00 m');
  const doubtful = { ...details, mass_is_assumed: true, hand_load: { right_kg: 5, left_kg: 0, both_kg: 0 },
    why_other_metric: 'no strength table' };
  assert.equal(loadsHint({ ...person, comDisagrees: true, comMinusMvn: 0.0123 }, doubtful), 'load metric: total, dynamic · '
    + 'floor at z = 0.00 m · body mass assumed: 75 kg · hand load 5 kg right · centre of mass differs from MVN by 1.2 cm · no strength table');
  assert.equal(loadsHint(person, undefined), 'load metric: total, dynamic', 'details come a moment after the first state');
});

test('the marker texts state their origin, or why a marker is missing', () => {
  assert.equal(comText(person), 'Centre of mass');
  assert.equal(comText({ ...person, comSource: 'body_model' }), 'Centre of mass (body model)');
  assert.equal(copText(person, details), 'Centre of pressure');
  assert.equal(copText({ ...person, groundIsMeasured: true }, details), 'Centre of pressure (measured)');
  assert.equal(copText({ ...person, cop: null }, { ...details, why_no_ground: 'both feet are off the floor' }),
    'Centre of pressure: both feet are off the floor');
  assert.equal(copText({ ...person, cop: null }, undefined), 'Centre of pressure: unknown');
});

test('margin and compression are shown while they are live and known', () => {
  const live = readingsOf(person, details, true);
  assert.equal(live.support, 'Margin of stability 8.3 cm');
  assert.equal(live.compression, 'L5/S1 compression 2.15 kN');
  const stale = readingsOf(person, details, false);
  assert.deepEqual([stale.support, stale.compression], ['Support polygon', '']);
  const unknown = readingsOf({ ...person, margin: NaN, compression: NaN }, details, true);
  assert.deepEqual([unknown.support, unknown.compression], ['Support polygon', '']);
});

test('an assumed mass and a different centre of mass are marked as doubtful', () => {
  assert.equal(readingsOf(person, details, true).isDoubtful, false);
  assert.equal(readingsOf(person, { ...details, mass_is_assumed: true }, true).isDoubtful, true);
  assert.equal(readingsOf({ ...person, comDisagrees: true }, undefined, true).isDoubtful, true);
});

test('without a person only the markers are named', () => {
  assert.deepEqual(readingsOf(undefined, undefined, true), { hint: '', isDoubtful: false, com: 'Centre of mass',
    cop: 'Centre of pressure', support: 'Support polygon', compression: '' });
});

const stream = { liveness: 'live', rateHz: 60, counter: 812, timeCodeMillis: 83456, viewers: 1 };

test('the header shows the values of a live stream', () => {
  assert.deepEqual(streamReadingsOf(stream, { median: 6.04, p95: 11.6 }, true), {
    rate: '60.0 Hz', latency: '6.0 ms', latencyP95: 'p95 12 ms', sample: '812', timeCode: '00:01:23.456',
    viewers: '1 viewer',
  });
});

test('a stopped stream keeps its last sample and has no rate', () => {
  const stale = streamReadingsOf({ ...stream, liveness: 'stale', viewers: 2 }, null, false);
  assert.deepEqual(stale, { rate: '–', latency: '–', latencyP95: '', sample: '812', timeCode: '00:01:23.456',
    viewers: '2 viewers' });
});

test('the header has no numbers before the first sample', () => {
  const dashes = { rate: '–', latency: '–', latencyP95: '', sample: '–', timeCode: '–' };
  assert.deepEqual(streamReadingsOf(null, null, false), { ...dashes, viewers: '' });
  assert.deepEqual(streamReadingsOf({ ...stream, liveness: 'no data' }, null, false), { ...dashes, viewers: '1 viewer' });
  const nobody = streamReadingsOf({ ...stream, liveness: 'no person' }, null, false);
  assert.equal(nobody.sample, '–');
  assert.notEqual(nobody.timeCode, '–', 'time goes on');
});

test('missing meshes are counted', () => {
  assert.deepEqual([0, 1, 2].map(meshesText), ['', '1 mesh of the body model could not be loaded',
    '2 meshes of the body model could not be loaded']);
});
