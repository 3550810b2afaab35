import assert from 'node:assert/strict';
import test from 'node:test';
import { placeOf, placeText, shifted, turned, zoomed } from '../../../web/orbit.js';

const start = { position: [3, 0, 1], target: [0, 0, 1] };
const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 1e-9);
const distance = ({ position, target }) => Math.hypot(...position.map((v, i) => v - target[i]));

test('a quarter turn goes counter-clockwise round the target and keeps the distance', () => {
  assert.ok(near(turned(start, Math.PI / 2, 0).position, [0, 3, 1]));
  assert.ok(Math.abs(distance(turned(start, 1.1, 0.4)) - 3) < 1e-9);
});

test('a camera stops above its target instead of going over it', () => {
  const above = turned(start, 0, 5);
  assert.ok(above.position[0] > 0 && above.position[2] > 3.99, above.position.join());
  assert.ok(turned(above, 0, -1).position[0] > above.position[0]);
});

test('zooming stays within its range', () => {
  assert.equal(distance(zoomed(start, 0.5, { least: 0.6, most: 30 })), 1.5);
  assert.equal(distance(zoomed(start, 0.001, { least: 0.6, most: 30 })), 0.6);
  assert.equal(distance(zoomed(start, 1000, { least: 0.6, most: 30 })), 30);
});

test('moving to the right takes camera and target along', () => {
  const next = shifted(start, 0.1, 0);
  assert.ok(near(next.target, [0, 0.3, 1]) && near(next.position, [3, 0.3, 1]));
});

test('the place in an address is that of the camera, to a centimetre', () => {
  const place = placeOf(placeText({ position: [5.1234, -2, 1.9], target: [4, -1, 1] }, [4, -1, 0]));
  assert.deepEqual(place, { position: [1.12, -1, 1.9], target: [0, 0, 1] });
});

test('what is no place is refused', () => {
  for (const text of ['', 'front', '1,2,3', '1,2,3,4,5,', '1,2,3,4,5,x', '1,2,3,1,2,3', '1e9,0,0,0,0,0', 'NaN,0,0,0,0,0', '1,2,3,4,5,6,7']) {
    assert.equal(placeOf(text), null, text);
  }
});
