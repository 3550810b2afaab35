import assert from 'node:assert/strict';
import test from 'node:test';
import { comText, copText, loadsHint, readingsOf } from '../../../web/readings.js';

const person = { metric: 'total', isDynamic: true, comSource: 'mvn', comDisagrees: false, comMinusMvn: NaN,
  groundIsMeasured: false, cop: [0, 0, 0], margin: 0.083, compression: 2150 };
const details = { mass_kg: 75, mass_is_assumed: false, hand_load: { right_kg: 0, left_kg: 0, both_kg: 0 },
  why_other_metric: '', why_no_ground: '' };

test('the hint says what the loads are and what they stand on', () => {
  assert.equal(loadsHint(person, details), 'total, dynamic');
  assert.equal(loadsHint({ ...person, isDynamic: false }, details), 'total, static');
  assert.equal(loadsHint({ ...person, metric: 'external' }, details), 'external');
  const doubtful = { ...details, mass_is_assumed: true, hand_load: { right_kg: 5, left_kg: 0, both_kg: 0 },
    why_other_metric: 'no strength table' };
  assert.equal(loadsHint({ ...person, comDisagrees: true, comMinusMvn: 0.0123 }, doubtful), 'total, dynamic · '
    + 'body mass assumed: 75 kg · hand load 5 kg right · centre of mass differs from MVN by 1.2 cm · no strength table');
  assert.equal(loadsHint(person, undefined), 'total, dynamic', 'details come a moment after the first state');
});

test('the markers say whose they are, and why one is not there', () => {
  assert.equal(comText(person), 'Centre of mass');
  assert.equal(comText({ ...person, comSource: 'body_model' }), 'Centre of mass (body model)');
  assert.equal(copText(person, details), 'Centre of pressure');
  assert.equal(copText({ ...person, groundIsMeasured: true }, details), 'Centre of pressure (measured)');
  assert.equal(copText({ ...person, cop: null }, { ...details, why_no_ground: 'both feet are off the floor' }),
    'Centre of pressure: both feet are off the floor');
  assert.equal(copText({ ...person, cop: null }, undefined), 'Centre of pressure: unknown');
});

test('margin and compression are said while they are live and known', () => {
  const live = readingsOf(person, details, true);
  assert.equal(live.support, 'Margin of stability 8.3 cm');
  assert.equal(live.compression, 'L5/S1 compression 2.15 kN');
  const stale = readingsOf(person, details, false);
  assert.deepEqual([stale.support, stale.compression], ['Support polygon', '']);
  const unknown = readingsOf({ ...person, margin: NaN, compression: NaN }, details, true);
  assert.deepEqual([unknown.support, unknown.compression], ['Support polygon', '']);
});

test('an assumed mass and a centre of mass that disagrees deserve a second look', () => {
  assert.equal(readingsOf(person, details, true).isDoubtful, false);
  assert.equal(readingsOf(person, { ...details, mass_is_assumed: true }, true).isDoubtful, true);
  assert.equal(readingsOf({ ...person, comDisagrees: true }, undefined, true).isDoubtful, true);
});

test('without a person only the markers are named', () => {
  assert.deepEqual(readingsOf(undefined, undefined, true), { hint: '', isDoubtful: false, com: 'Centre of mass',
    cop: 'Centre of pressure', support: 'Support polygon', compression: '' });
});
