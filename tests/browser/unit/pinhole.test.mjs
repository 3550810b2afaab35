// The edges of an image before its camera.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { edgesAt } from '../../../web/pinhole.js';

const camera = {
  width: 640, height: 480, focal_px: [525, 520], center_px: [250, 300], position: [0, 0, 0], orientation: [0, 0, 0, 1],
  scene_opacity: 1,
};

test('a point is where the pinhole of the calibration has it', () => {
  const { left, right, top, bottom } = edgesAt(camera, 2);
  // 2 m ahead, 0.3 m to the right, 0.2 m down.
  assert.ok(Math.abs((0.3 - left) / (right - left) * 640 - (250.5 + 525 * 0.3 / 2)) < 1e-9);
  assert.ok(Math.abs((top + 0.2) / (top - bottom) * 480 - (300.5 + 520 * 0.2 / 2)) < 1e-9);
});

test('an axis in the middle sees as far to each side', () => {
  const { left, right, top, bottom } = edgesAt({ ...camera, center_px: [319.5, 239.5] }, 1);
  assert.equal(left, -right);
  assert.equal(bottom, -top);
});
