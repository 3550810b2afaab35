import assert from 'node:assert/strict';
import test from 'node:test';
import { aim, groundOf } from '../../../web/cameras.js';

const front = { name: 'front', position: [4.6, 0, 1.5], target: [0, 0, 1], up: [0, 0, 1], vertical_fov_rad: 0.5 };
const top = { name: 'top', position: [0, 0, 5.6], target: [0, 0, 1], up: [1, 0, 0], vertical_fov_rad: 0.5 };
const here = { middle: [0, 0, 0], radius: 0 };
const near = (actual, expected) =>
  actual.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) < 1e-9, `${actual} instead of ${expected}`));
const distance = ({ position, target }) => Math.hypot(...position.map((v, i) => v - target[i]));

test('a named view is the server’s, moved to where the person stands', () => {
  near(aim(front, here, 1.5).position, front.position);
  const moved = aim(front, { middle: [2, -1, 0], radius: 0 }, 1.5);
  near(moved.position, [6.6, -1, 1.5]);
  near(moved.target, [2, -1, 1]);
  assert.ok(Math.abs(moved.fovDegrees - 28.6479) < 1e-3);
});

test('several people are shown from further away, as in the server’s picture', () => {
  const wide = aim(front, { middle: [0, 0, 0], radius: 1 }, 1.5);
  const half = Math.tan(0.25);
  assert.ok(Math.abs(distance(wide) - (distance(aim(front, here, 1.5)) + 1 / half)) < 1e-9);
});

test('a narrow screen still shows both arms', () => {
  const aspect = 0.5;
  const visible = 2 * distance(aim(front, here, aspect)) * Math.tan(0.25) * aspect;
  assert.ok(visible >= 1.9 - 1e-9, `${visible} m`);
});

test('straight down, the camera leans so that "up" of the view is up on the screen', () => {
  const { position, target } = aim(top, here, 1.5);
  assert.ok(position[0] < target[0], 'it stands a trace behind');
  assert.ok(Math.abs(position[0]) < 0.01);
});

test('the ground is the middle of the people', () => {
  assert.deepEqual(groundOf([], 0), here);
  assert.deepEqual(groundOf([[0, 0, 0.9], [2, 0, 1]], -0.5), { middle: [1, 0, -0.5], radius: 1 });
});
