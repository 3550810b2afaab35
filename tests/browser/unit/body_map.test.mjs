import assert from 'node:assert/strict';
import test from 'node:test';
import { PLACES, Trend } from '../../../web/body_map.js';

const joints = (ratio) => [{ name: 'l5_s1', label: 'L5/S1', loadClass: 'low', ratio }];

test('an arrow compares with a second before, and stays away while a load hardly changes', () => {
  const trend = new Trend();
  assert.equal(trend.add(10e6, joints(0.2))('l5_s1'), '', 'nothing to compare with');
  assert.equal(trend.add(10.5e6, joints(0.9))('l5_s1'), '');
  assert.equal(trend.add(11e6, joints(0.26))('l5_s1'), '▲');
  assert.equal(trend.add(11.6e6, joints(0.87))('l5_s1'), '');
  assert.equal(trend.add(12e6, joints(0.15))('l5_s1'), '▼');
  assert.equal(trend.add(12.1e6, joints(NaN))('l5_s1'), '');
});

test('after a jump back in time there is nothing to compare with', () => {
  const trend = new Trend();
  trend.add(10e6, joints(0.2));
  assert.equal(trend.add(5e6, joints(0.9))('l5_s1'), '');
  assert.equal(trend.add(6e6, joints(0.2))('l5_s1'), '▼');
});

test('joints of both sides are mirrored on the drawing', () => {
  for (const [name, [x, y]] of Object.entries(PLACES)) {
    if (name.startsWith('right_')) assert.deepEqual(PLACES[name.replace('right', 'left')], [-x, y], name);
  }
  assert.equal(Object.keys(PLACES).length, 15);
});
