import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { axesOf, cameraAt, extentAim, framedPeople, middleOf, ownAim } from '../../../web/cameras.js';

const front = { name: 'front', position: [4.6, 0, 1.5], target: [0, 0, 1], up: [0, 0, 1], vertical_fov_rad: 0.5 };
const top = { name: 'top', position: [0, 0, 5.6], target: [0, 0, 1], up: [1, 0, 0], vertical_fov_rad: 0.5 };
const near = (actual, expected) =>
  actual.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) < 1e-9, `${actual} instead of ${expected}`));

test('a camera is at its place from the middle of the people, and shows the height there', () => {
  const axes = axesOf(front, 0), distance = 1 / Math.tan(0.25);
  const { position, target, fovDegrees } = cameraAt(front, axes, { right: 0.5, up: 0, height: 2 }, [2, -1, 0]);
  near(target, [2, -0.5, 0]);
  near(position, target.map((v, i) => v - distance * axes.forward[i]));
  assert.ok(Math.abs(fovDegrees - 28.6479) < 1e-3);
});

test('each named view looks in the direction of the server picture, also of a person who has turned', () => {
  // named_views_test.cc holds the same file against the server's own cameras.
  const { views } = JSON.parse(readFileSync(new URL('named_views.json', import.meta.url), 'utf8'));
  for (const view of views) {
    const alone = views.find((v) => v.name === view.name && v.radius === 0 && v.aspect > 1);
    const { forward, right, up } = axesOf(alone, view.heading ?? 0);
    const way = view.target.map((v, i) => v - view.position[i]), far = Math.hypot(...way);
    const lean = view.name === 'top' ? 2e-3 : 1e-5;  // an orbit has no "up" at its pole
    forward.forEach((v, i) => assert.ok(Math.abs(v - way[i] / far) < lean, `${view.name}: ${forward}`));
    assert.ok(Math.abs(right[2]) < 1e-9, `${view.name} is level`);
    assert.ok(up.reduce((sum, v, i) => sum + v * view.up[i], 0) > 0, view.name);
  }
});

test('a named view of a scene without people shows all of it, as the server picture does', () => {
  const { views, extents } = JSON.parse(readFileSync(new URL('named_views.json', import.meta.url), 'utf8'));
  for (const { name, aspect, position, target, ...extent } of extents) {
    const view = views.find((v) => v.name === name && v.radius === 0 && v.aspect > 1);
    const aim = extentAim(view, axesOf(view, 0), extent, aspect);
    near(aim.target, target);
    aim.position.forEach((v, i) => assert.ok(Math.abs(v - position[i]) < 1e-5, `${name}: ${aim.position}`));
  }
});

test('the camera above the person leans slightly, so that the up direction is defined', () => {
  const { forward } = axesOf(top, 0);
  assert.ok(forward[0] > 0 && forward[0] < 0.002, 'it stands a trace behind');
  const turned = axesOf(top, Math.PI / 2);
  assert.ok(turned.forward[1] > 0.0005 && Math.abs(turned.forward[0]) < 1e-9, 'the person faces up in the picture');
});

test('the own camera stands, or goes with its frame and turns as it says', () => {
  const own = { name: 'own', position: [2, 0, 1], target: [0, 0, 1], up: [0, 0, 1], vertical_fov_rad: 0.5, turn: 'none' };
  const range = { least: 0.5, most: 10 };
  near(ownAim(own, null, range).position, [2, 0, 1]);
  near(ownAim(own, null, range).target, [0, 0, 1]);
  const half = Math.SQRT1_2, about = (axis) => ({ position: [5, 0, 0], quaternion: [...axis.map((v) => v * half), half] });
  const turnedAboutZ = about([0, 0, 1]), tipped = about([1, 0, 0]);  // by 90 degrees
  near(ownAim(own, turnedAboutZ, range).position, [7, 0, 1]);
  near(ownAim({ ...own, turn: 'heading' }, turnedAboutZ, range).position, [5, 2, 1]);
  near(ownAim({ ...own, turn: 'heading' }, tipped, range).position, [7, 0, 1]);
  near(ownAim({ ...own, turn: 'pose' }, tipped, range).position, [7, -1, 0]);
  near(ownAim({ ...own, turn: 'pose' }, tipped, range).up, [0, -1, 0]);
  near(ownAim({ ...own, target: [-98, 0, 1] }, null, range).target, [-8, 0, 1]);
});

test('the ground point is the middle of the people, without one who is far', () => {
  const [here, beside, far] = [[0, 0, 0.9], [2, 0, 1], [990, 0, 1]].map((position) => ({ links: [{ position }] }));
  assert.deepEqual(middleOf([here, beside], -0.5), [1, 0, -0.5]);
  assert.deepEqual(framedPeople([far, beside, here], 50), [beside, here]);
  assert.deepEqual(framedPeople([far, beside], 50), [beside], 'one who is far hides none');
  assert.deepEqual(framedPeople([], 50), []);
});
