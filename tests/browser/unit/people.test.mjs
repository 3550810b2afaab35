// Bodies of made-up people, with the real three.js; nothing is drawn.
import assert from 'node:assert/strict';
import test from 'node:test';
import { toColor } from '../../../web/colors.js';
import { makeMarkerMaterials } from '../../../web/human.js';
import { People } from '../../../web/people.js';

const rgb = [0.5, 0.5, 0.5];
const palette = {
  classes: ['low', 'medium', 'high', 'unknown'].map((name) => ({ name, color: rgb, size: 0.8, rim: 0 })),
  cop: rgb, com: rgb, support: rgb, held: rgb, body: rgb, stale_body: rgb, clay: [0.4, 0.3, 0.2], object: rgb, axes: [rgb, rgb, rgb],
  ghost: { on_light: rgb, on_dark: rgb, share: 0.75 },
};
const box = { kind: 'box', size: [0.1, 0.1, 0.1], position: [0, 0, 0], quaternion: [0, 0, 0, 1], rgba: null };
const marks = { depths: Array(22).fill(0.1), com: 0.034, com_depth: 0.068, com_ring: 0.062, com_line: 0.0035, cop_edge: 0.046, cop: 0.038 };
const modelOf = (character, revision = 1) => ({ character, revision, ghost_opacity: null, opacity: 1, skin: null, links: [{ visuals: [box] }], marks });
const personOf = (character) => ({ character, links: [{ position: [0, 0, 1], quaternion: [0, 0, 0, 1] }],
  loads: [], support: [], feet: [], held: [], com: null, cop: null });
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

test('bodies of style clay have its colour, and those without live data that of stale ones', () => {
  const { people } = twoPeople();
  const limb = people.group.children[0].children[0].children[0].children[0];
  const colorOf = (look, isLive) => {
    people.setLook(look);
    people.update(stateOf(100, 0, 1), isLive);
    return limb.material.color.clone();
  };
  const matte = { loads: 'spheres', style: 'matte', hidden: [] }, clay = { ...matte, style: 'clay' };
  assert.deepEqual(colorOf(clay, true), toColor(palette.clay));
  assert.deepEqual(colorOf(clay, false), toColor(palette.stale_body));
  assert.deepEqual(colorOf(matte, true), toColor(palette.body));
  assert.deepEqual(colorOf({ ...matte, style: 'line' }, true), toColor(palette.body), 'the page draws no lines');
});

test('a translucent body lets through what is in it, and keeps its colour', () => {
  const people = new People(() => {});
  people.setModels([{ ...modelOf(0), opacity: 0.5 }], palette, makeMarkerMaterials(palette));
  people.update(stateOf(100, 0), true);
  const { material } = people.group.children[0].children[0].children[0].children[0];
  assert.equal(material.transparent, true);
  assert.equal(material.opacity, 0.5);
  assert.deepEqual(material.color, toColor(palette.body));
});

/** The spheres that are drawn: centre and radius. */
function ballsOf(human) {
  const [spheres] = human.children.filter(({ children: [mesh] }) => mesh?.material?.uniforms?.balls);
  const { balls, count } = spheres.children[0].material.uniforms;
  return balls.value.slice(0, spheres.visible ? count.value : 0).map((ball) => ball.toArray());
}

test('people without a skin keep their load spheres', () => {
  const { people } = twoPeople();
  const state = stateOf(100, 0);
  state.people[0].loads = [{ joint: 3, loadClass: 'high', radius: 0.05, position: [0, 0, 1] }];
  people.setLook({ loads: 'skin', style: 'matte', hidden: [] });
  people.update(state, true);
  assert.deepEqual(ballsOf(people.group.children[0]), [[0, 0, 1, 0.05]]);
  assert.equal(people.hasSkins, false);
});

test('hidden parts of a person are not drawn, and the others are', () => {
  const { people } = twoPeople();
  const [human] = people.group.children;
  const shown = (hidden) => {
    people.setLook({ loads: 'spheres', style: 'matte', hidden });
    const state = stateOf(100, 0);
    Object.assign(state.people[0], { loads: [{ joint: 3, loadClass: 'high', radius: 0.05, position: [0, 0, 1] }], com: [0, 0, 1], cop: [0, 0, 0] });
    people.update(state, true);
    return { parts: human.children.map(({ visible }) => visible), balls: ballsOf(human).length };
  };
  const all = shown([]);
  for (const [part, balls, count] of [['loads', 1, 0], ['com', 1, 1], ['cop', 0, 1], ['markers', 0, 0]]) {
    const without = shown([part]);
    const differ = without.parts.filter((visible, i) => visible !== all.parts[i]);
    assert.equal(all.balls - without.balls, balls, part);
    assert.equal(differ.length, count, part);
    assert.ok(!differ.includes(true));
  }
});

test('people are complete when their skins are loaded or cannot be, the one of fewer triangles too', async () => {
  const asked = [];
  globalThis.fetch = (route) => new Promise((resolve) => { asked.push({ route, refuse: () => resolve(new Response('', { status: 404 })) }); });
  let changed = () => {};
  const people = new People(() => changed());
  const refuse = (at) => new Promise((done) => {
    changed = () => done(undefined);
    asked[at].refuse();
  });
  people.setModels([{ ...modelOf(0), skin: '/api/v1/skin/0/1' }], palette, makeMarkerMaterials(palette));
  assert.equal(people.isComplete, false);
  await refuse(0);
  assert.equal(people.isComplete, true);
  people.setCoarse(true);
  assert.equal(people.isComplete, false);
  await refuse(1);
  assert.equal(people.isComplete, true);
  people.setCoarse(false);
  people.setCoarse(true);
  assert.deepEqual(asked.map(({ route }) => route), ['api/v1/skin/0/1', 'api/v1/skin/0/1?error_mm=3']);
  assert.deepEqual(people.failedMeshes, ['/api/v1/skin/0/1', '/api/v1/skin/0/1?error_mm=3']);
});
