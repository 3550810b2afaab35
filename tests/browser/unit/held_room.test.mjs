// The same cases as held_room_test.cc.
import assert from 'node:assert/strict';
import test from 'node:test';
import { HeldRoom } from '../../../web/held_room.js';

const STANDING = { height: 2.4, below: 0.1 }, SITTING = { height: 1.5, below: 0.3 }, OVERHEAD = { height: 3, below: 0.1 };

/** What is shown after more seconds in which `needed` is constant. */
function startTake() {
  const held = new HeldRoom();
  let secs = 0;
  const take = { shown: { height: 0, below: 0 }, moved: 0, play };
  function play(needed, more) {
    const end = secs + more;
    for (; secs < end; secs += 1 / 30) {
      const before = take.shown.height;
      take.shown = held.follow(needed, secs);
      if (before === 0) continue;
      assert.ok(Math.abs(take.shown.height - before) < 0.08, `it jumps at ${secs} s`);
      take.moved += Math.abs(take.shown.height - before) > 0.0005 ? 1 : 0;
    }
    return take.shown.height;
  }
  return take;
}

test('the view comes nearer slowly after two seconds, and makes room at once', () => {
  const take = startTake();
  take.play(STANDING, 5);
  assert.equal(take.play(SITTING, 1.8), STANDING.height);
  assert.ok(Math.abs(take.shown.below - SITTING.below) < 0.02, 'nothing is cut off');
  assert.ok(take.play(SITTING, 1) > 0.75 * STANDING.height);
  assert.ok(Math.abs(take.play(SITTING, 3) - SITTING.height) < 0.05);
  assert.ok(take.play(OVERHEAD, 0.6) > 0.85 * OVERHEAD.height);
  assert.ok(Math.abs(take.play(OVERHEAD, 2) - OVERHEAD.height) < 0.02);
});

test('the view learns to stand still for a person who bends and rises again', () => {
  const take = startTake();
  for (let i = 0; i < 3; ++i) {
    take.play(STANDING, 3);
    take.play(SITTING, 4);
  }
  const learnt = take.moved;
  for (let i = 0; i < 10; ++i) {
    assert.ok(take.play(STANDING, 3) >= 0.85 * STANDING.height);
    take.play(SITTING, 4);
  }
  assert.ok(take.moved < learnt + 60, `${take.moved - learnt} pictures of zooming`);
  take.play(SITTING, 30);
  take.play(STANDING, 30);
  assert.ok(Math.abs(take.play(SITTING, 6) - SITTING.height) < 0.05, 'it waits two seconds again');
});

test('the view ignores small differences, and begins anew where time goes back', () => {
  const take = startTake();
  take.play(STANDING, 2);
  assert.equal(take.play({ height: 1.1 * STANDING.height, below: 0.15 }, 5), STANDING.height);
  assert.equal(take.play({ height: 0.9 * STANDING.height, below: 0 }, 30), STANDING.height);
  assert.equal(take.moved, 0);
  const held = new HeldRoom();
  held.follow(OVERHEAD, 100);
  assert.deepEqual(held.follow(SITTING, 3), SITTING);
});
