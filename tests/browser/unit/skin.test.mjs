// The skin as the C++ encoder has just written it (page_fixture_server describe), and its frames for random postures:
// person 0 with bare hands, person 1 with gloves.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Matrix4 } from '../../../web/node_modules/three/build/three.module.js';
import { extentOf, setShades, SIDE } from '../../../web/floor_shadow.js';
import { readSkin } from '../../../web/skin_buffer.js';
import { emptyPlanes, foldsOfVertices, setPlanes } from '../../../web/skin_folds.js';
import { framesOf } from '../../../web/skin_frames.js';
import { capsulesOf, emptyCapsules, limbsOfVertices, setCapsules } from '../../../web/skin_limbs.js';
import { REGION_FLOATS, regionsOf } from '../../../web/skin_regions.js';
import { neighboursOf } from '../../../web/skin_surface.js';
import { toBuffer, told } from './told_by_server.mjs';

const buffers = told.skins.map(({ hex }) => toBuffer(hex));

/** Largest distance of positions, m, and of rotations, rad. */
function farthest(frames, expected) {
  let position = 0, rotation = 0;
  frames.forEach((frame, i) => {
    position = Math.max(position, Math.hypot(...frame.position.toArray().map((v, k) => v - expected[i].position[k])));
    const dot = frame.rotation.toArray().reduce((sum, v, k) => sum + v * expected[i].rotation[k], 0);
    rotation = Math.max(rotation, 2 * Math.acos(Math.min(1, Math.abs(dot))));
  });
  return { position, rotation };
}

test('the frames of random postures equal those of the server', () => {
  told.skins.forEach(({ postures }, person) => {
    const { rig } = readSkin(buffers[person], 'skin');
    for (const { links, frames } of postures) {
      const { position, rotation } = farthest(framesOf(rig, links), frames);
      // Bare fingers come from the bind pose, which is sent as float32.
      assert.ok(position < 2e-6 && rotation < 2e-3, `person ${person}: ${position} m, ${rotation} rad`);
    }
  });
});

test('the frames of the bind pose leave the vertices in place', () => {
  for (const buffer of buffers) {
    const { rig } = readSkin(buffer, 'skin');
    const links = [];
    rig.frames.forEach(({ kind, link }, i) => {
      const { position, rotation } = rig.bind[i];
      if (kind === 'link') links[link] = { position: position.toArray(), quaternion: rotation.toArray() };
    });
    // Carpus and metacarpals have no frame of their own.
    for (let i = 0; i < links.length; ++i) links[i] ??= links[0];
    const expected = rig.bind.map(({ position, rotation }) => ({ position: position.toArray(), rotation: rotation.toArray() }));
    const { position, rotation } = farthest(framesOf(rig, links), expected);
    assert.ok(position < 1e-6 && rotation < 2e-3, `${position} m, ${rotation} rad`);
  }
});

test('a skin takes at most 600 kB, is as tall as a person, and its weights are whole', () => {
  for (const buffer of buffers) {
    assert.ok(buffer.byteLength <= 600000, `${buffer.byteLength} bytes`);
    const { positions, weights, triangles, indices } = readSkin(buffer, 'skin');
    const heights = positions.filter((_, i) => i % 3 === 2);
    const tall = heights.reduce((most, z) => Math.max(most, z)) - heights.reduce((least, z) => Math.min(least, z));
    assert.ok(tall > 1.65 && tall < 1.85, `${tall} m`);
    assert.equal(indices.length, weights.length);
    for (let i = 0; i < weights.length; i += 4) {
      assert.equal(weights[i] + weights[i + 1] + weights[i + 2] + weights[i + 3], 255, `vertex ${i / 4}`);
    }
    assert.ok(triangles.length > 3 * 30000);
  }
});

test('a truncated or altered skin is rejected', () => {
  const [whole] = buffers;
  for (const size of [0, 3, 4, 100, 5000, whole.byteLength - 1]) {
    assert.throws(() => readSkin(whole.slice(0, size), 'api/v1/skin/0/1'), /api\/v1\/skin\/0\/1.*reload the page/, `${size} bytes`);
  }
  const header = new DataView(whole).getUint32(0, true);
  const altered = (at, value) => {
    const copy = new Uint8Array(whole.slice(0));
    copy[at] = value;
    return copy.buffer;
  };
  const { rig, positions } = readSkin(whole, 'skin');
  const influences = 4 + header + 28 * rig.frames.length;
  assert.throws(() => readSkin(altered(influences, 255), 'skin'), /frame that does not exist/);
  const triangles = influences + 6 * positions.length;
  assert.throws(() => readSkin(altered(triangles + 1, 255), 'skin'), /corner that is no vertex/);
});

test('a skin of fewer triangles takes a quarter of the bytes, and its normals lean on vertices that it has', () => {
  for (const { hex, coarse_hex: coarseHex } of told.skins) {
    const buffer = toBuffer(coarseHex), { leans, positions, triangles, rig } = readSkin(buffer, 'skin');
    assert.ok(buffer.byteLength < toBuffer(hex).byteLength / 4, `${buffer.byteLength} bytes`);
    assert.ok(triangles.length > 3 * 3000 && triangles.length < 3 * 6000, `${triangles.length / 3} triangles`);
    const vertices = positions.length / 3;
    assert.deepEqual([leans.shares.length, leans.neighbours.length], [3 * vertices, 2 * vertices]);
    assert.ok(leans.shares.every(Number.isFinite));
    const bytes = new Uint8Array(buffer.slice(0));
    const neighbours = 4 + new DataView(buffer).getUint32(0, true) + 28 * rig.frames.length + 24 * vertices;
    bytes.fill(255, neighbours, neighbours + 2);
    assert.throws(() => readSkin(bytes.buffer, 'skin'), /leans on what is no vertex/);
    assert.throws(() => readSkin(withHeader(buffer, (header) => { header.leans = false; }), 'skin'), /bytes instead of/);
    assert.equal(readSkin(toBuffer(hex), 'skin').leans, null);
  }
});

test('a rigged person of the user has colours, and need not be closed', () => {
  const buffer = toBuffer(told.own_skin.hex);
  const skin = readSkin(buffer, 'skin');
  assert.equal(skin.positions.length, 3 * told.own_skin.vertices);
  assert.ok(skin.paint instanceof Uint8Array && skin.isTwoSided);
  assert.deepEqual([...skin.paint.subarray(0, 4)], told.own_skin.first_color);
  const { ring, first } = neighboursOf(skin.triangles, told.own_skin.vertices);
  assert.ok(ring.length > skin.triangles.length, 'there is a gap');
  assert.equal(first[told.own_skin.vertices], ring.length);
});

/** The skin with another header. */
function withHeader(whole, change) {
  const size = new DataView(whole).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(whole, 4, size)));
  change(header);
  const text = JSON.stringify(header);
  const bytes = new TextEncoder().encode(text.padEnd(4 * Math.ceil(text.length / 4)));
  const other = new Uint8Array(4 + bytes.length + whole.byteLength - 4 - size);
  new DataView(other.buffer).setUint32(0, bytes.length, true);
  other.set(bytes, 4);
  other.set(new Uint8Array(whole, 4 + size), 4 + bytes.length);
  return other.buffer;
}

test('every limb has vertices that follow each other, and capsules move with the links', () => {
  const { rig: { limbs, limbOfFrame }, indices, weights } = readSkin(buffers[0], 'skin');
  const ofVertices = limbsOfVertices(indices, weights, limbOfFrame);
  assert.equal(new Set(ofVertices).size, limbs.length);
  const runs = ofVertices.filter((limb, i) => limb !== ofVertices[i - 1]).length;
  assert.ok(runs < 3 * limbs.length, `${runs} runs of ${limbs.length} limbs`);
  const [{ links }] = told.skins[0].postures;
  const moved = links.map(({ position: [x, y, z], quaternion }) => ({ position: [x + 1, y, z], quaternion }));
  const before = capsulesOf(limbs, links), after = capsulesOf(limbs, moved);
  before.forEach(({ start, end, startRadius }, i) => {
    assert.ok(startRadius > 0.01 && start.distanceTo(end) > 0.02 && start.distanceTo(end) < 0.7, `limb ${i}`);
    assert.ok(Math.abs(after[i].end.x - end.x - 1) < 1e-9);
  });
});

test('folds take the flesh of both sides, press it only where joints bend far, and each vertex has few', () => {
  const skin = readSkin(buffers[0], 'skin');
  const { folds, bind } = skin.rig;
  const vertices = skin.positions.length / 3;
  const { values, most } = foldsOfVertices(skin);
  assert.ok(most >= 2 && most <= 4, `${most} folds of a vertex`);
  const sides = folds.shapes.map(() => [0, 0]);
  for (let i = 0; i < vertices * most; ++i) {
    const [fold, side, floor, bulge] = values.subarray(4 * i, 4 * i + 4);
    assert.ok(Math.abs(side) <= 1 && floor <= 0 && bulge >= 0 && bulge < 0.3, `vertex ${i % vertices}`);
    if (Math.abs(side) > 0.9) sides[fold][side > 0 ? 0 : 1] += 1;
  }
  assert.ok(sides.flat().every((count) => count > 40), `${sides}`);
  const [{ links }] = told.skins[0].postures;
  const planes = emptyPlanes(folds);
  const straight = links.map(({ position }) => ({ position, quaternion: [0, 0, 0, 1] }));
  setPlanes(folds, bind.map(() => new Matrix4()), straight, planes);
  folds.shapes.forEach((_, i) => assert.deepEqual([planes[12 * i + 7], planes[12 * i + 11]], [0, 0]));
});

test('a skin with unknown folds is rejected', () => {
  for (const change of [
    ({ shapes }) => { shapes[0].frame = 256; },
    ({ shapes }) => { shapes[1].link = -1; },
    ({ shapes }) => { shapes[2].before = []; },
    ({ shapes }) => { shapes[3].before = [0.5]; },
    (folds) => { folds.shapes = Array(17).fill(folds.shapes[0]); },
  ]) {
    const buffer = withHeader(buffers[0], ({ folds }) => change(folds));
    assert.throws(() => readSkin(buffer, 'skin'), /unknown folds/, `${change}`);
  }
});

test('a skin with unknown limbs is rejected', () => {
  const [whole] = buffers;
  assert.ok(readSkin(withHeader(whole, () => {}), 'skin'));
  for (const change of [
    (header) => { header.frames.limbs[3] = 17; },
    (header) => { header.frames.limbs[3] = 0.5; },
    (header) => { header.limbs.covered_by[2].push(-1); },
    (header) => { header.limbs.radii_m.pop(); },
    (header) => { header.limbs.covered_by = []; },
  ]) assert.throws(() => readSkin(withHeader(whole, change), 'skin'), /unknown limbs; reload/);
});

test('loads are shown on the same regions of the skin as in pictures of the server', () => {
  told.skins.forEach(({ regions }, person) => {
    const skin = readSkin(buffers[person], 'skin');
    const { shapes } = skin.rig.regions;
    const values = regionsOf(skin);
    assert.equal(values.length, REGION_FLOATS * regions.inside.length);
    const seen = new Map();
    let farthest = 0;
    regions.inside.forEach((inside, vertex) => {
      const [here, region] = values.subarray(REGION_FLOATS * vertex);
      farthest = Math.max(farthest, Math.abs(here - inside));
      if (inside < 0.05) return;
      const { joint } = shapes[region];
      assert.equal(joint, regions.joints[vertex], `person ${person}, vertex ${vertex}`);
      seen.set(joint, (seen.get(joint) ?? 0) + 1);
    });
    // Vertices are sent in steps of 30 µm; the narrowest region has a half width of 27 mm.
    assert.ok(farthest < 0.003, `person ${person}: ${farthest}`);
    assert.equal(seen.size, shapes.length);
    for (const [joint, count] of seen) assert.ok(count > 40, `joint ${joint} has ${count} vertices`);
  });
});

test('wherever the corners of a triangle have different regions, all of them are outside', () => {
  const shape = { isBall: true, parts: 1, direction: [0, 0, 0], halfWidth: 1, flare: 0 };
  const shapes = [{ ...shape, joint: 4, middle: [0, 0, 0] }, { ...shape, joint: 9, middle: [1.5, 0, 0] }];
  const values = regionsOf({
    rig: { regions: { shapes, partOfFrame: [0, 1], leastWeight: 230 } },
    positions: Float32Array.from([0, 0, 0, 0.5, 0, 0, 1.4, 0, 0, 0.1, 0, 0, 0.1, 0, 0]),
    indices: Uint8Array.from({ length: 20 }, (_, i) => (i === 16 ? 1 : 0)),
    weights: Uint8Array.from({ length: 20 }, (_, i) => (i % 4 === 0 ? 255 : 0)),
    triangles: Uint16Array.from([0, 1, 3, 1, 2, 3]),
  });
  const inside = [0, 1, 2, 3, 4].map((i) => Number(values[REGION_FLOATS * i].toFixed(2)));
  assert.deepEqual(inside, [1, -0.01, -0.01, -0.01, -1], 'the last vertex belongs to a part without regions');
  assert.deepEqual([0, 2].map((i) => values[REGION_FLOATS * i + 1]), [0, 1]);
});

test('a skin with unknown regions is rejected', () => {
  for (const change of [
    (header) => { header.frames.parts[3] = 16; },
    (header) => { header.frames.parts[3] = -1; },
    (header) => { header.regions.parts.pop(); },
    (header) => { header.regions.middles_m.pop(); },
    (header) => { header.regions.flares.pop(); },
    (header) => { header.regions.half_widths_m[2] = 0; },
    (header) => { header.regions.joints = []; },
    (header) => { for (const key of Object.keys(header.regions)) if (key !== 'least_weight') {
      const size = header.regions[key].length / header.regions.half_widths_m.length;
      header.regions[key] = Array(65 * size).fill(header.regions[key][0]);
    } },
  ]) assert.throws(() => readSkin(withHeader(buffers[0], change), 'skin'), /unknown regions; reload/);
});

test('the vertices around a vertex go once around it', () => {
  const octahedron = Uint16Array.from([0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5]);
  const { ring, first } = neighboursOf(octahedron, 6);
  const around = ring.subarray(first[4], first[5]);
  const start = around.indexOf(0);
  assert.deepEqual([0, 1, 2, 3].map((i) => around[(start + i) % 4]), [0, 2, 1, 3], 'counter-clockwise from outside');
  const { triangles, positions } = readSkin(buffers[0], 'skin');
  const whole = neighboursOf(triangles, positions.length / 3);
  assert.equal(whole.ring.length, triangles.length, 'as many neighbours as corners: the skin is closed');
});

/** The normal of a vertex as the shader sums it up over its ring, and as the mean of its triangles by area. */
function normalsOf(triangles, positions, vertex) {
  const at = (/** @type {number} */ i) => positions[i].map((/** @type {number} */ v, /** @type {number} */ k) => v - positions[vertex][k]);
  const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const sum = (total, each) => total.map((v, k) => v + each[k]);
  const { ring, first } = neighboursOf(triangles, positions.length);
  const around = [...ring.subarray(first[vertex], first[vertex + 1])];
  const ofRing = around.reduce((total, next, i) => sum(total, cross(at(around.at(i - 1)), at(next))), [0, 0, 0]);
  let mean = [0, 0, 0];
  for (let t = 0; t < triangles.length; t += 3) {
    const place = [0, 1, 2].find((i) => triangles[t + i] === vertex);
    if (place === undefined) continue;
    mean = sum(mean, cross(at(triangles[t + (place + 1) % 3]), at(triangles[t + (place + 2) % 3])));
  }
  return { ofRing, mean };
}

test('normals are right where a surface of the user ends, meets itself or has triangles twice', () => {
  const positions = [[0, 0, 0], [1, 0, 0.1], [0, 1, 0.2], [-1, 0, 0.3], [0, -1, -0.2], [1, 1, 0.5], [-1, 1, 0.7]];
  for (const triangles of [
    [0, 1, 2], [0, 1, 2, 0, 2, 3], [0, 2, 3, 0, 1, 2], [0, 1, 2, 0, 3, 4], [0, 1, 2, 0, 1, 2],
    [0, 1, 2, 0, 2, 1], [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1], [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 0, 5, 6],
    [0, 1, 2, 0, 1, 5, 0, 3, 2], [1, 2, 3],
  ]) {
    const { ofRing, mean } = normalsOf(Uint16Array.from(triangles), positions, 0);
    ofRing.forEach((v, k) => assert.ok(Math.abs(v - mean[k]) < 1e-12, `${triangles}: ${ofRing} instead of ${mean}`));
  }
});

test('the shadow on the floor reaches 45 cm beyond the limbs', () => {
  const { rig: { limbs } } = readSkin(buffers[0], 'skin');
  const { links } = told.skins[0].postures[0];
  const capsules = emptyCapsules(limbs);
  setCapsules(limbs, links, capsules);
  const ends = capsulesOf(limbs, links).flatMap(({ start, end }) => [start.toArray(), end.toArray()]);
  const { first, size } = extentOf(capsules);
  for (const axis of [0, 1]) {
    const places = ends.map((end) => end[axis]);
    assert.ok(Math.abs(first[axis] - (Math.min(...places) - 0.45)) < 1e-5);
    assert.ok(Math.abs(first[axis] + size[axis] - (Math.max(...places) + 0.45)) < 1e-5);
  }
});

test('the shadow is darkest under the person and ends before its grid does', () => {
  const { rig: { limbs } } = readSkin(buffers[0], 'skin');
  const { links } = told.skins[0].postures[0];
  const capsules = emptyCapsules(limbs), shades = new Float32Array(SIDE * SIDE);
  setCapsules(limbs, links, capsules);
  const extent = extentOf(capsules);
  const ends = capsulesOf(limbs, links).flatMap(({ start, end }) => [start, end]);
  setShades(capsules, extent, Math.min(...ends.map(({ z }) => z)) - 0.05, shades);
  const darkest = shades.indexOf(Math.max(...shades));
  const place = [darkest % SIDE, Math.floor(darkest / SIDE)].map((at, axis) => extent.first[axis] + extent.size[axis] * at / (SIDE - 1));
  const near = Math.min(...ends.map(({ x, y }) => Math.hypot(x - place[0], y - place[1])));
  assert.ok(shades[darkest] > 0.5 && shades[darkest] <= 0.8, `${shades[darkest]}`);
  assert.ok(near < 0.15, `the darkest point is ${near} m from the limbs`);
  for (let i = 0; i < SIDE; ++i) {
    for (const at of [i, (SIDE - 1) * SIDE + i, i * SIDE, i * SIDE + SIDE - 1]) assert.equal(shades[at], 0, `point ${at} at the edge`);
  }
});
