import assert from 'node:assert/strict';
import test from 'node:test';
import { freeAreaOf } from '../../../web/free_area.js';
import { ballsOf } from '../../../web/outline.js';

const VIEW = { left: 100, top: 50, right: 1100, bottom: 650 };

test('what goes from side to side leaves no room above or below it, and other overlays cover corners', () => {
  const banner = { left: 110, top: 56, right: 1090, bottom: 104 }, legend = { left: 906, top: 556, right: 1100, bottom: 650 };
  const hidden = { left: 0, top: 0, right: 0, bottom: 0 }, beside = { left: 1100, top: 50, right: 1400, bottom: 650 };
  const { free, corners } = freeAreaOf(VIEW, [banner, legend, hidden, beside]);
  assert.deepEqual(free, { left: 0, top: 0.1, right: 1, bottom: 1 });
  assert.deepEqual(corners, [{ left: 0.8, top: 500 / 600, right: 1, bottom: 1 }]);
});

test('overlays that leave no room do not count', () => {
  const all = { left: 100, top: 50, right: 1100, bottom: 600 };
  assert.deepEqual(freeAreaOf(VIEW, [all]), { free: { left: 0, top: 0, right: 1, bottom: 1 }, corners: [] });
});

test('the balls of a person move with the links, and those of a load are around it', () => {
  const half = Math.SQRT1_2;  // a quarter turn about z
  const links = [{ position: [1, 2, 3], quaternion: [0, 0, half, half] }];
  const held = [{ kind: 'box', position: [0, 0, 1], quaternion: [0, 0, 0, 1], size: [0.4, 0.2, 0.3] }];
  const [limb, load] = ballsOf({ links, held }, [{ link: 0, position: [0.5, 0, 0], radius: 0.1 }, { link: 9, position: [0, 0, 0], radius: 1 }]);
  limb.center.forEach((v, i) => assert.ok(Math.abs(v - [1, 2.5, 3][i]) < 1e-9, `${limb.center}`));
  assert.deepEqual(load, { center: [0, 0, 1], radius: 0.2 });
  assert.deepEqual(ballsOf({ links, held: [] }, undefined), [{ center: [1, 2, 3], radius: 0.12 }], 'before the outline comes');
});
