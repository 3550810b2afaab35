import assert from 'node:assert/strict';
import test from 'node:test';
import { hasControls, layoutOf, LAYOUTS } from '../../../web/layout.js';

test('without a wish, the width decides; a desk that does not fit is a phone', () => {
  assert.deepEqual([layoutOf(null, false), layoutOf(null, true)], ['desk', 'phone']);
  assert.deepEqual([layoutOf('desk', false), layoutOf('desk', true)], ['desk', 'phone']);
});

test('phone, wall and kiosk stay what the address says', () => {
  for (const name of ['phone', 'wall', 'kiosk']) assert.deepEqual([layoutOf(name, false), layoutOf(name, true)], [name, name]);
});

test('wall and kiosk have no controls', () => {
  assert.deepEqual(LAYOUTS.filter(hasControls), ['desk', 'phone']);
});
