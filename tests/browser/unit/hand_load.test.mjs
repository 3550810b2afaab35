import assert from 'node:assert/strict';
import test from 'node:test';
import { handLoadText, onlyIn } from '../../../web/hand_load.js';

test('setting one hand replaces all that is held', () => {
  assert.deepEqual(onlyIn('left_kg', 2.5), { right_kg: 0, left_kg: 2.5, both_kg: 0 });
  assert.deepEqual(onlyIn('both_kg', 10), { right_kg: 0, left_kg: 0, both_kg: 10 });
});

test('hand loads are described in words, and empty hands are omitted', () => {
  assert.equal(handLoadText({ right_kg: 5, left_kg: 2.25, both_kg: 0 }), 'hand load 5 kg right, 2.25 kg left');
  assert.equal(handLoadText({ right_kg: 0, left_kg: 0, both_kg: 10 }), 'hand load 10 kg in both hands');
  assert.equal(handLoadText({ right_kg: 0, left_kg: 0, both_kg: 0 }), '');
  assert.equal(handLoadText(undefined), '');
});
