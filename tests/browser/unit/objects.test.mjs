// Labels of tracked objects, with the real three.js and a canvas that draws nothing.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { ObjectMarkers } from '../../../web/objects.js';

const rgb = [0.5, 0.5, 0.5];
const palette = { object: rgb, axes: [rgb, rgb, rgb], stale_body: rgb };
const cart = { character: 9, number: 0, name: 'cart', position: [1, 2, 3], quaternion: [0, 0, 0, 1] };

const pen = { measureText: (text) => ({ width: 20 * text.length }), beginPath() {}, roundRect() {}, fill() {}, fillText() {} };
before(() => {
  globalThis.document = { createElement: () => ({ width: 0, height: 0, getContext: () => pen }) };
});
after(() => { delete globalThis.document; });

/** Of the view's height; a sprite that keeps its size on the screen is as high as at a distance of 1 m. */
const shareOf = (markers, fovDegrees) => {
  const label = markers.group.children[0].children[1];
  return label.scale.y / (2 * Math.tan((fovDegrees * Math.PI) / 360));
};

test('a label has the same share of the view at any field of view', () => {
  const markers = new ObjectMarkers(palette, 60);
  markers.setNames([cart]);
  markers.update([cart], true);
  assert.ok(Math.abs(shareOf(markers, 60) - 0.034) < 1e-9, `${shareOf(markers, 60)} at 60 degrees`);
  const { x, y } = markers.group.children[0].children[1].scale;
  markers.setFieldOfView(20);
  assert.ok(Math.abs(shareOf(markers, 20) - 0.034) < 1e-9, `${shareOf(markers, 20)} at 20 degrees`);
  const narrow = markers.group.children[0].children[1].scale;
  assert.ok(Math.abs(narrow.x / narrow.y - x / y) < 1e-9, 'it is not squeezed');
});
