// The same cases as held_height_test.cc.
import assert from 'node:assert/strict';
import test from 'node:test';
import { HeldHeight } from '../../../web/held_height.js';

const STANDING = 2.4, SITTING = 1.5, OVERHEAD = 3;

/** The shown height after more seconds in which `needed` is constant. */
function startTake() {
  const held = new HeldHeight();
  let secs = 0, shown = 0;
  return (needed, more) => {
    const end = secs + more;
    for (; secs < end; secs += 1 / 60) {
      const before = shown;
      shown = held.follow(needed, secs);
      assert.ok(before === 0 || Math.abs(shown - before) < 0.08, `it jumps at ${secs} s`);
    }
    return shown;
  };
}

test('the height stands still for a person who bends and rises again', () => {
  const play = startTake();
  for (let i = 0; i < 10; ++i) {
    assert.equal(play(STANDING, 3), STANDING);
    assert.equal(play(SITTING, 3), STANDING);
  }
});

test('the height makes room at once and comes nearer after some time', () => {
  const play = startTake();
  play(STANDING, 2);
  assert.ok(Math.abs(play(OVERHEAD, 2) - OVERHEAD) < 0.02);
  assert.ok(Math.abs(play(SITTING, 8) - OVERHEAD) < 0.02, 'still remembered');
  assert.ok(Math.abs(play(SITTING, 12) - SITTING) < 0.02);
});

test('the height ignores small differences, and begins anew where time goes back', () => {
  const play = startTake();
  play(STANDING, 2);
  assert.equal(play(1.1 * STANDING, 5), STANDING);
  assert.equal(play(0.85 * STANDING, 30), STANDING);
  const held = new HeldHeight();
  held.follow(OVERHEAD, 100);
  assert.equal(held.follow(SITTING, 3), SITTING);
});
