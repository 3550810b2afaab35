// The same cases as held_view_test.cc.
import assert from 'node:assert/strict';
import test from 'node:test';
import { HeldView } from '../../../web/held_view.js';
import { besideCorners, hullOf, neededHull, placeFor } from '../../../web/view_frame.js';

const WHOLE = { left: 0, top: 0, right: 1, bottom: 1 };
const slope = Math.tan(0.26);
const WIDE = { aspect: 16 / 9, slope, area: { free: WHOLE, corners: [] } };
const boxOf = (low, high) => hullOf([0, 1, 2, 3, 4, 5, 6, 7].map((i) =>
  ({ center: [0, 1, 2].map((axis) => (i >> axis & 1 ? high : low)[axis]), radius: 0 })));
const STANDING = boxOf([-0.3, 0, -0.2], [0.3, 1.8, 0.3]);
const SITTING = boxOf([-0.3, 0, -0.5], [0.3, 1.2, 0.5]);
const OVERHEAD = boxOf([-0.3, 0, -0.2], [0.3, 2.2, 0.3]);
const LYING = boxOf([-0.9, 0, -0.3], [0.9, 0.3, 0.3]);
const heightFor = (box) => placeFor(box, WIDE).height;

/** What is shown after more seconds in which `needed` is constant. */
function startTake() {
  const held = new HeldView();
  let secs = 0;
  const take = { shown: { right: 0, up: 0, height: 0 }, moved: 0, play };
  function play(needed, more) {
    const end = secs + more;
    for (; secs < end; secs += 1 / 30) {
      const before = take.shown.height;
      take.shown = held.follow(needed, WIDE, secs);
      if (before === 0) continue;
      assert.ok(Math.abs(take.shown.height - before) < 0.08, `it jumps at ${secs} s`);
      take.moved += Math.abs(take.shown.height - before) > 0.0005 ? 1 : 0;
    }
    return take.shown.height;
  }
  return take;
}

test('people fill height or width of what is free, with the same numbers as in the server picture', () => {
  const title = { free: { ...WHOLE, top: 0.1 }, corners: [] };
  const legend = { ...title, corners: [{ left: 0, top: 0.6, right: 0.3, bottom: 1 }] };
  for (const [box, shape, expected] of [
    [STANDING, WIDE, { right: 0, up: 0.9, height: 2.4748 }],
    [STANDING, { aspect: 4 / 3, slope, area: title }, { right: 0, up: 1.0316, height: 2.738 }],
    [LYING, WIDE, { right: 0, up: 0.15, height: 1.4918 }],
    [LYING, { aspect: 4 / 3, slope, area: title }, { right: 0, up: 0.2388, height: 1.9359 }],
    [LYING, { aspect: 16 / 9, slope, area: legend }, { right: 0, up: -0.0498, height: 1.4918 }],
  ]) {
    const place = placeFor(box, shape);
    for (const part of ['right', 'up', 'height']) {
      assert.ok(Math.abs(place[part] - expected[part]) < 2e-4, `${JSON.stringify(place)}, not ${JSON.stringify(expected)}`);
    }
  }
});

test('the view moves only where people would be covered, as far as in the server picture', () => {
  const legend = { left: 0, top: 0.6, right: 0.3, bottom: 1 };
  for (const [away, corners, expected] of [
    [0, [legend], 0], [-1.2, [legend], -0.6579], [2.5, [legend], 0.6948],
    [0.5, [legend, { left: 0.6, top: 0.6, right: 1, bottom: 1 }], 0.379],
    [0.5, [legend, { left: 0.4, top: 0.6, right: 1, bottom: 1 }], 1.1552],
    [-1.2, [], 0],
  ]) {
    const shape = { ...WIDE, area: { free: { ...WHOLE, top: 0.1 }, corners } };
    const { right } = besideCorners({ right: 0, up: 0.9, height: 2.4748 }, STANDING, [away, 0, 0], shape);
    assert.ok(Math.abs(right - expected) < 2e-4, `${right}, not ${expected}`);
  }
});

test('the view comes nearer slowly after two seconds, and makes room at once', () => {
  const take = startTake();
  take.play(STANDING, 5);
  assert.equal(take.play(SITTING, 1.8), heightFor(STANDING));
  assert.ok(take.play(SITTING, 1) > 0.75 * heightFor(STANDING));
  assert.ok(Math.abs(take.play(SITTING, 4) - heightFor(SITTING)) < 0.05);
  assert.ok(take.play(OVERHEAD, 0.6) > 0.85 * heightFor(OVERHEAD));
  const settled = take.play(OVERHEAD, 3);
  assert.ok(settled >= 0.98 * heightFor(OVERHEAD) && settled < 1.1 * heightFor(OVERHEAD), `${settled} m`);
});

test('the view learns to stand still for a person who bends and rises again', () => {
  const take = startTake();
  for (let i = 0; i < 3; ++i) {
    take.play(STANDING, 3);
    take.play(SITTING, 4);
  }
  const learnt = take.moved;
  for (let i = 0; i < 10; ++i) {
    assert.ok(take.play(STANDING, 3) >= 0.85 * heightFor(STANDING));
    take.play(SITTING, 4);
  }
  assert.ok(take.moved < learnt + 60, `${take.moved - learnt} pictures of zooming`);
  take.play(SITTING, 30);
  take.play(STANDING, 30);
  assert.ok(Math.abs(take.play(SITTING, 6) - heightFor(SITTING)) < 0.05, 'it waits two seconds again');
});

test('the view ignores small differences, and begins anew where time goes back', () => {
  const take = startTake();
  take.play(STANDING, 2);
  const held = heightFor(STANDING);
  assert.equal(take.play(boxOf([-0.6, -0.05, -0.2], [0.5, 1.9, 0.3]), 5), held);
  assert.equal(take.play(boxOf([-0.3, 0, -0.2], [0.3, 1.65, 0.3]), 30), held);
  assert.equal(take.moved, 0);
  const again = new HeldView();
  again.follow(OVERHEAD, WIDE, 100);
  assert.deepEqual(again.follow(SITTING, WIDE, 3), placeFor(SITTING, WIDE));
});

test('an overlay that comes or goes where people are moves the view at once, and one beside them does not', () => {
  const withCorner = (left, right) => ({ ...WIDE, area: { free: WHOLE, corners: [{ left, top: 0, right, bottom: 0.4 }] } });
  const held = new HeldView();
  const alone = held.follow(STANDING, WIDE, 5);
  assert.deepEqual(held.follow(STANDING, withCorner(0.8, 1), 5), alone);
  const over = withCorner(0.4, 1);
  assert.deepEqual(held.follow(STANDING, over, 5), placeFor(STANDING, over));
  assert.notDeepEqual(placeFor(STANDING, over), alone);
  assert.deepEqual(held.follow(STANDING, WIDE, 5), alone);
});

test('the view needs an adult with arms overhead without people, and nothing that is far from its person', () => {
  const axes = { right: [0, 1, 0], up: [0, 0, 1], forward: [-1, 0, 0] };
  assert.ok(Math.abs(heightFor(neededHull([], [5, 5, 0], axes)) - 2.5) < 0.2);
  const body = { center: [5, 5, 1], radius: 1 };
  const people = (...balls) => [{ place: [5, 5, 1], balls: [body, ...balls] }];
  const alone = neededHull(people(), [5, 5, 0], axes);
  assert.deepEqual(neededHull(people({ center: [5, 75, 1], radius: 0.1 }), [5, 5, 0], axes), alone);
  const more = neededHull(people({ center: [5, 5, 2.3], radius: 0.1 }), [5, 5, 0], axes);
  assert.ok(heightFor(more) > heightFor(alone), 'one that is held counts');
});
