// Bodies of made-up people, with the real three.js; nothing is drawn.
import assert from 'node:assert/strict';
import test from 'node:test';
import { makeMarkerMaterials } from '../../../web/human.js';
import { People } from '../../../web/people.js';

const rgb = [0.5, 0.5, 0.5];
const palette = {
  classes: ['low', 'medium', 'high', 'unknown'].map((name) => ({ name, color: rgb })),
  cop: rgb, com: rgb, support: rgb, held: rgb, body: rgb, stale_body: rgb, object: rgb, axes: [rgb, rgb, rgb],
};
const box = { kind: 'box', size: [0.1, 0.1, 0.1], position: [0, 0, 0], quaternion: [0, 0, 0, 1], rgba: null };
const modelOf = (character, revision = 1) => ({ character, revision, skin: null, links: [{ visuals: [box] }] });
const personOf = (character) => ({ character, links: [{ position: [0, 0, 1], quaternion: [0, 0, 0, 1] }],
  loads: [], support: [], held: [], com: null, cop: null });
const stateOf = (seconds, ...characters) =>
  ({ sentMicros: 1e6 * seconds, floor: 0, people: characters.map(personOf) });

/** People 0 and 1; `disposed` counts what has been given back of each. */
function twoPeople() {
  const people = new People(() => {});
  const markers = makeMarkerMaterials(palette);
  people.setModels([modelOf(0), modelOf(1)], palette, markers);
  const disposed = people.group.children.map((body) => {
    const counts = { geometries: 0, materials: 0 };
    const limb = body.children[0].children[0].children[0];
    limb.geometry.addEventListener('dispose', () => { counts.geometries += 1; });
    limb.material.addEventListener('dispose', () => { counts.materials += 1; });
    return counts;
  });
  return { people, markers, disposed };
}

test('a person who leaves is hidden at once and released ten seconds later', () => {
  const { people, disposed } = twoPeople();
  people.update(stateOf(100, 0, 1), true);
  people.update(stateOf(101, 0), true);
  assert.deepEqual(people.group.children.map(({ visible }) => visible), [true, false]);
  assert.deepEqual(disposed[1], { geometries: 0, materials: 0 });
  people.update(stateOf(111, 0), true);
  assert.deepEqual(disposed, [{ geometries: 0, materials: 0 }, { geometries: 1, materials: 1 }]);
  assert.equal(people.group.children.length, 1);
  assert.equal(people.has(1, 1), false, 'its model is loaded again when it comes back');
  assert.equal(people.has(0, 1), true);
});

test('people who appear and leave for an hour leave no bodies in memory', () => {
  const { people, markers } = twoPeople();
  for (let i = 2; i < 360; ++i) {
    people.setModels([modelOf(i)], palette, markers);
    people.update(stateOf(10 * i, i), true);
  }
  assert.ok(people.size <= 3, `${people.size} bodies are kept`);
});

test('a person keeps the body during a short gap in the stream', () => {
  const { people, disposed } = twoPeople();
  people.update(stateOf(100, 0, 1), true);
  people.update(stateOf(109, 0), true);
  people.update(stateOf(109.5, 0, 1), true);
  people.update(stateOf(119, 0), true);
  assert.equal(people.has(1, 1), true);
  assert.equal(disposed[1].geometries, 0);
});

test('a model is kept if it arrives before its person', () => {
  const { people } = twoPeople();
  people.update(stateOf(5000, 0), true);
  assert.equal(people.has(1, 1), true);
});

test('a new revision replaces the body and releases the old one', () => {
  const { people, markers, disposed } = twoPeople();
  people.setModels([modelOf(0, 1), modelOf(1, 2)], palette, markers);
  assert.deepEqual(disposed, [{ geometries: 0, materials: 0 }, { geometries: 1, materials: 1 }]);
  assert.equal(people.group.children.length, 2);
  assert.equal(people.has(1, 2), true);
});
