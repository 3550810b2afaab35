import assert from 'node:assert/strict';
import test from 'node:test';
import { remember, Trails } from '../../../web/trails.js';

const at = (secs) => ({ micros: 1e6 * secs, at: { x: secs } });

test('a path keeps its last seconds', () => {
  const points = [];
  for (let i = 0; i <= 40; ++i) remember(points, at(i / 10), 2);
  assert.deepEqual([points[0].micros, points.at(-1).micros, points.length], [2e6, 4e6, 21]);
  remember(points, at(4), 2);
  assert.equal(points.length, 21, 'the same sample again');
});

test('a path begins anew when time goes back or something is missing', () => {
  const points = [];
  for (const secs of [1, 1.1, 1.2]) remember(points, at(secs), 2);
  remember(points, at(1.1), 2);
  assert.deepEqual(points.map(({ micros }) => micros), [1.1e6]);
  remember(points, at(2.7), 2);
  assert.deepEqual(points.map(({ micros }) => micros), [2.7e6]);
});

test('a path of an hour at 240 Hz is bounded', () => {
  const points = [];
  for (let i = 0; i < 3600; ++i) remember(points, at(i / 240), 60);
  assert.equal(points.length, 600);
});

const look = { segment: 0, name: 'pelvis', color: [0.2, 0.4, 0.8] }, com = { ...look, segment: -1 };
const person = (character, position, center = null) => ({ character, com: center, links: [{ position }] });

test('each person has a line for each point, as long as both are known', () => {
  const trails = new Trails();
  trails.setLook([look, com], 2);
  trails.update({ stampMicros: 0, people: [person(0, [0, 0, 1], [0, 0, 1.1]), person(1, [1, 0, 1])] });
  assert.equal(trails.group.children.length, 3, 'the centre of mass of one is not known');
  trails.update({ stampMicros: 1e5, people: [person(0, [0, 0.1, 1], [0, 0, 1.1]), person(1, [1, 0, 1])] });
  const lines = trails.group.children.filter(({ visible, geometry }) => visible && geometry.attributes.position);
  assert.equal(lines.length, 1, 'only one point has moved');
  const { max } = (lines[0].geometry.computeBoundingBox(), lines[0].geometry.boundingBox);
  assert.ok(Math.abs(max.z - 1.007) < 1e-6, `its newer end has a radius of 7 mm: ${max.z}`);
  trails.update({ stampMicros: 2e5, people: [person(1, [1, 0, 1])] });
  assert.equal(trails.group.children.length, 1, 'who has gone has no trail');
  trails.setLook([], 2);
  assert.equal(trails.group.children.length, 0);
});
