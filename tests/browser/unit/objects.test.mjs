// Labels of tracked objects, with the real three.js and a canvas that draws nothing.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { ObjectMarks } from '../../../web/objects.js';

const rgb = [0.5, 0.5, 0.5];
const palette = { object: rgb, axes: [rgb, rgb, rgb], stale_body: rgb };
const cart = { character: 9, number: 0, name: 'cart', position: [1, 2, 3], quaternion: [0, 0, 0, 1] };

const pen = { measureText: (text) => ({ width: 20 * text.length }), beginPath() {}, roundRect() {}, fill() {}, fillText() {} };
before(() => {
  globalThis.document = { createElement: () => ({ width: 0, height: 0, getContext: () => pen }) };
});
after(() => { delete globalThis.document; });

/** Of the view's height; a sprite that keeps its size on the screen is as high as at a distance of 1 m. */
const shareOf = (marks, fovDegrees) => {
  const label = marks.group.children[0].children[1];
  return label.scale.y / (2 * Math.tan((fovDegrees * Math.PI) / 360));
};

test('a label takes the same share of the view through any lens, also when the lens changes', () => {
  const marks = new ObjectMarks(palette, 60);
  marks.setNames([cart]);
  marks.update([cart], true);
  assert.ok(Math.abs(shareOf(marks, 60) - 0.034) < 1e-9, `${shareOf(marks, 60)} at 60 degrees`);
  const { x, y } = marks.group.children[0].children[1].scale;
  marks.setFieldOfView(20);
  assert.ok(Math.abs(shareOf(marks, 20) - 0.034) < 1e-9, `${shareOf(marks, 20)} at 20 degrees`);
  const narrow = marks.group.children[0].children[1].scale;
  assert.ok(Math.abs(narrow.x / narrow.y - x / y) < 1e-9, 'it is not squeezed');
});
