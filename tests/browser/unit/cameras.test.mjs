import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { aim, groundOf } from '../../../web/cameras.js';

const front = { name: 'front', position: [4.6, 0, 1.5], target: [0, 0, 1], up: [0, 0, 1], vertical_fov_rad: 0.5 };
const top = { name: 'top', position: [0, 0, 5.6], target: [0, 0, 1], up: [1, 0, 0], vertical_fov_rad: 0.5 };
const framing = { min_width_m: 1.9, margin_m: 0.7, narrowest_aspect: 4 / 3, reach_m: 50, height_m: 2.5,
  spare_below: 0.036 };
const here = { middle: [0, 0, 0], radius: 0, height: 2.5, below: 0, heading: 0 };
const near = (actual, expected) =>
  actual.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) < 1e-9, `${actual} instead of ${expected}`));
const distance = ({ position, target }) => Math.hypot(...position.map((v, i) => v - target[i]));

test('a named view equals that of the server, moved to the person', () => {
  near(aim(front, framing, here, 1.5).position, front.position);
  const moved = aim(front, framing, { ...here, middle: [2, -1, 0] }, 1.5);
  near(moved.position, [6.6, -1, 1.5]);
  near(moved.target, [2, -1, 1]);
  assert.ok(Math.abs(moved.fovDegrees - 28.6479) < 1e-3);
});

test('each named view matches the server picture of one person, of one who has turned and of a group', () => {
  // named_views_test.cc holds the same file against the server's own cameras.
  const { framing: sent, views } = JSON.parse(readFileSync(new URL('named_views.json', import.meta.url), 'utf8'));
  for (const view of views) {
    const alone = views.find((v) => v.name === view.name && v.radius === 0 && v.aspect > 1);
    const ground = { ...here, radius: view.radius, heading: view.heading ?? 0 };
    const { position, target, fovDegrees } = aim(alone, sent, ground, view.aspect);
    const lean = view.name === 'top' ? 0.02 : 1e-5;  // an orbit has no "up" at its pole
    position.forEach((v, i) => assert.ok(Math.abs(v - view.position[i]) < lean, `${view.name}: ${position}`));
    near(target, view.target);
    assert.ok(Math.abs(fovDegrees - (view.vertical_fov_rad * 180) / Math.PI) < 1e-9);
  }
});

test('the view is lowered for what seems to be below the floor', () => {
  const { position, target } = aim(front, framing, { ...here, below: 0.036 * 2.5 + 0.2 }, 1.5);
  near(target, [0, 0, 0.8]);
  near(position, [4.6, 0, 1.3]);
  near(aim(front, framing, { ...here, below: 0.05 }, 1.5).target, [0, 0, 1]);
});

test('a narrow screen shows both arms', () => {
  const aspect = 0.5;
  const visible = 2 * distance(aim(front, framing, here, aspect)) * Math.tan(0.25) * aspect;
  assert.ok(visible >= 1.9 - 1e-9, `${visible} m`);
});

test('the camera above the person leans slightly, so that the up direction is defined', () => {
  const { position, target } = aim(top, framing, here, 1.5);
  assert.ok(position[0] < target[0], 'it stands a trace behind');
  assert.ok(Math.abs(position[0]) < 0.01);
  const turned = aim(top, framing, { ...here, heading: Math.PI / 2 }, 1.5);
  assert.ok(turned.position[1] < -0.001 && Math.abs(turned.position[0]) < 1e-9, 'the person faces up in the picture');
});

test('the ground point is the middle of the people', () => {
  assert.deepEqual(groundOf([], 0, 50), { middle: [0, 0, 0], radius: 0 });
  assert.deepEqual(groundOf([[0, 0, 0.9], [2, 0, 1]], -0.5, 50), { middle: [1, 0, -0.5], radius: 1 });
  assert.deepEqual(groundOf([[990, 0, 1], [2, 0, 1]], 0, 50), { middle: [2, 0, 0], radius: 0 }, 'one who is far hides none');
});
