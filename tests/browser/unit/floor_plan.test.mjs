import assert from 'node:assert/strict';
import test from 'node:test';
import { frameOf } from '../../../web/floor_plan.js';

test('the square of the floor has all points in it, and is never smaller than half a metre', () => {
  assert.deepEqual(frameOf([]), { x: 0, y: 0, side: 0.5 });
  assert.deepEqual(frameOf([{ x: 3, y: -1 }]), { x: 3, y: -1, side: 0.5 });
  const { x, y, side } = frameOf([{ x: 0, y: 0 }, { x: 2, y: 0.5 }, { x: 1, y: -0.1 }]);
  assert.deepEqual([x, y], [1, 0.2]);
  assert.equal(side, 2.5);
});
