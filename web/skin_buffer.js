// Reads the skin of a person as the server sends it (docs/http.md): a JSON header and little-endian arrays. Counts are
// checked before anything is read.
import * as THREE from 'three';
import { boolean, listOf, number, object, oneOf, recordOf } from './messages.js';

const KINDS = /** @type {const} */ (['link', 'swing', 'twist', 'half', 'fixed']);
const MOST_FRAMES = 256;  // their numbers are bytes
const MOST_VERTICES = 65536;
const PAINTS = /** @type {const} */ (['suit', 'colors']);
const MOST_LIMBS = 32;  // bits of a number
const MOST_PARTS = 16;
const MOST_REGIONS = 64;  // as the shader has place for
const MOST_FOLDS = 16;
const rgb = listOf(number, 3);
const vector = listOf(number, 3), growth = listOf(number, 2);

const readHeader = object({
  vertices: number, triangles: number, position_step_m: number, border_step_m: number,
  paint: oneOf(PAINTS), two_sided: boolean, leans: boolean,
  own_plane_until_rad: number, middle_share: number, middles: recordOf(listOf(number, 4)),
  frames: object({
    kinds: listOf(oneOf(KINDS)), links: listOf(number), parents: listOf(number), shares: listOf(number),
    into_bend_m: listOf(number), up_bone_m: listOf(number), limbs: listOf(number), parts: listOf(number),
  }),
  limbs: object({
    links: listOf(number), points_m: listOf(number), radii_m: listOf(number), covered_by: listOf(listOf(number)),
    covered_by_joined: listOf(listOf(number)),
  }),
  folds: object({
    shapes: listOf(object({
      link: number, before: listOf(number), frame: number, center_m: vector, normal: vector, across: vector,
      inwards: vector, pressed_m: growth, bulging_m: growth, outwards: vector, beside_midline_m: growth,
      softness_m: number, bulge: number, bulges: growth,
    })),
    contact: growth, bulge_reach_m: number,
  }),
  regions: object({
    joints: listOf(number), balls: listOf(boolean), parts: listOf(number), middles_m: listOf(number),
    directions: listOf(number), half_widths_m: listOf(number), flares: listOf(number),
    least_weight: number,
  }),
  colors: object({ top: rgb, trousers: rgb, shoes: rgb, bare: rgb, band: rgb }),
});

/** @typedef {{kind: (typeof KINDS)[number], link: number, parent: number, share: number, intoBend: number,
 *    upBone: number}} FrameRule
 *  @typedef {{frames: FrameRule[], middles: Map<number, THREE.Quaternion>, ownPlaneUntil: number, middleShare: number,
 *    bind: import('./skin_frames.js').Frame[], inHand: import('./skin_frames.js').Frame[],
 *    limbs: import('./skin_limbs.js').Limb[], limbOfFrame: number[], folds: import('./skin_folds.js').Folds,
 *    regions: {shapes: import('./skin_regions.js').RegionShape[], partOfFrame: number[], leastWeight: number}}} Rig
 *    bind: the frames of the pose of the vertices; inHand: the same in the frame of their link; leastWeight: of 255, by
 *    which a vertex belongs to one part of the body
 *  @typedef {ReturnType<typeof readHeader>['colors']} SuitColors  sRGB 0..1
 *  @typedef {{rig: Rig, colors: SuitColors, positions: Float32Array, indices: Uint8Array, weights: Uint8Array,
 *    paint: Int8Array|Uint8Array, borderStep: number, isTwoSided: boolean, triangles: Uint16Array,
 *    leans: {shares: Float32Array, neighbours: Uint16Array}|null}} Skin
 *    positions: m; leans: of a skin of fewer triangles, how its normals become those of the whole one: three shares and
 *    two vertices of each; indices and weights: four of each vertex, weights sum up to 255; paint: four of each vertex, of a
 *    suit (Int8Array) distances in steps, m, else its colour */

/** Of columns with two ends of each limb; none if they differ in length.
 *  @param {ReturnType<typeof readHeader>['limbs']} columns
 *  @returns {import('./skin_limbs.js').Limb[]} */
function limbsOf({ links, points_m, radii_m, covered_by, covered_by_joined }) {
  const count = covered_by.length;
  if (covered_by_joined.length !== count || links.length !== 2 * count || radii_m.length !== 2 * count
    || points_m.length !== 6 * count) return [];
  const end = (/** @type {number} */ i) =>
    ({ link: links[i], point: new THREE.Vector3().fromArray(points_m, 3 * i), radius: radii_m[i] });
  return covered_by.map((whole, i) =>
    ({ start: end(2 * i), end: end(2 * i + 1), joined: covered_by_joined[i], whole }));
}

/** Null if the columns differ in length.
 *  @param {ReturnType<typeof readHeader>['regions']} columns
 *  @returns {import('./skin_regions.js').RegionShape[]|null} */
function regionsOf({ joints, balls, parts, middles_m, directions, half_widths_m, flares }) {
  const count = joints.length;
  if ([balls, parts, half_widths_m, flares].some(({ length }) => length !== count)
    || [middles_m, directions].some(({ length }) => length !== 3 * count)) return null;
  return joints.map((joint, i) => ({
    joint, isBall: balls[i], parts: parts[i], middle: middles_m.slice(3 * i, 3 * i + 3),
    direction: directions.slice(3 * i, 3 * i + 3), halfWidth: half_widths_m[i],
    flare: flares[i],
  }));
}

/** @param {ArrayBuffer} buffer
 *  @param {string} route  for the error
 *  @returns {Skin}
 *  @throws {Error} if it is truncated or has another shape */
export function readSkin(buffer, route) {
  /** @returns {never} */
  const reject = (/** @type {string} */ what) => {
    throw new Error(`${route}: ${what}; reload the page`);
  };
  const headerSize = buffer.byteLength < 4 ? Infinity : new DataView(buffer).getUint32(0, true);
  if (4 + headerSize > buffer.byteLength || headerSize % 4 !== 0) reject(`${buffer.byteLength} bytes are no skin`);
  /** @type {unknown} */
  const document = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, headerSize)));
  const header = readHeader(document, route);
  const { vertices, triangles } = header;
  const { kinds, links, parents, shares, into_bend_m, up_bone_m, limbs: limbOfFrame, parts: partOfFrame } = header.frames;
  const count = kinds.length;
  const columns = [links, parents, shares, into_bend_m, up_bone_m, limbOfFrame, partOfFrame];
  if (columns.some(({ length }) => length !== count) || count > MOST_FRAMES) {
    reject('the columns of the frames differ in length');
  }
  const limbs = limbsOf(header.limbs);
  const isLimb = (/** @type {number} */ limb) => Number.isInteger(limb) && limb >= 0 && limb < limbs.length;
  if (limbs.length > MOST_LIMBS || !limbOfFrame.every(isLimb)
    || !limbs.every(({ joined, whole }) => [...joined, ...whole].every(isLimb))) reject('it has unknown limbs');
  const shapes = regionsOf(header.regions);
  const isPart = (/** @type {number} */ part) => Number.isInteger(part) && part >= 0 && part < MOST_PARTS;
  if (shapes === null || shapes.length > MOST_REGIONS || !partOfFrame.every(isPart)
    || !shapes.every(({ halfWidth }) => halfWidth > 0)) return reject('it has unknown regions');
  const isFrame = (/** @type {number} */ frame) => Number.isInteger(frame) && frame >= 0 && frame < count;
  const { folds } = header;
  if (folds.shapes.length > MOST_FOLDS || !folds.shapes.every(({ link, before, frame }) =>
    before.length > 0 && [frame, link, ...before].every(isFrame))) reject('it has unknown folds');
  if (!Number.isInteger(vertices) || vertices < 0 || vertices > MOST_VERTICES || !Number.isInteger(triangles)
    || triangles < 0) reject(`${vertices} vertices and ${triangles} triangles`);
  let at = 4 + headerSize;
  const leaning = header.leans ? vertices : 0;
  const wanted = at + 28 * count + 16 * leaning + 18 * vertices + 6 * triangles;
  if (buffer.byteLength !== wanted) reject(`${buffer.byteLength} bytes instead of ${wanted}`);
  const take = (/** @type {number} */ bytes) => {
    at += bytes;
    return at - bytes;
  };
  const bindValues = new Float32Array(buffer, take(28 * count), 7 * count);
  const leans = new Float32Array(buffer, take(12 * leaning), 3 * leaning);
  const influences = new Uint8Array(buffer, take(8 * vertices), 8 * vertices);
  const Paint = header.paint === 'suit' ? Int8Array : Uint8Array;
  const paint = new Paint(buffer, take(4 * vertices), 4 * vertices);
  const neighbours = new Uint16Array(buffer, take(4 * leaning), 2 * leaning);
  const steps = new Int16Array(buffer, take(6 * vertices), 3 * vertices);
  const corners = new Uint16Array(buffer, take(6 * triangles), 3 * triangles);
  if (corners.some((corner) => corner >= vertices)) reject('a triangle has a corner that is no vertex');
  if (neighbours.some((neighbour) => neighbour >= vertices)) reject('a normal leans on what is no vertex');
  const indices = new Uint8Array(4 * vertices), weights = new Uint8Array(4 * vertices);
  for (let i = 0; i < vertices; ++i) {
    indices.set(influences.subarray(8 * i, 8 * i + 4), 4 * i);
    weights.set(influences.subarray(8 * i + 4, 8 * i + 8), 4 * i);
  }
  if (indices.some((index) => index >= count)) reject('a vertex hangs on a frame that does not exist');
  const bind = kinds.map((_, i) => ({
    position: new THREE.Vector3().fromArray(bindValues, 7 * i),
    rotation: new THREE.Quaternion().fromArray(bindValues, 7 * i + 3),
  }));
  const frames = kinds.map((kind, i) => ({
    kind, link: links[i], parent: parents[i], share: shares[i], intoBend: into_bend_m[i], upBone: up_bone_m[i],
  }));
  const middles = new Map(Object.entries(header.middles).map(
    ([link, values]) => /** @type {const} */ ([Number(link), new THREE.Quaternion().fromArray(values)])));
  const inHand = bind.map(({ position, rotation }, i) => {
    // The first frames are those of the segments themselves.
    const hand = bind[frames[i].link] ?? bind[i];
    const back = hand.rotation.clone().conjugate();
    return {
      position: position.clone().sub(hand.position).applyQuaternion(back), rotation: back.clone().multiply(rotation),
    };
  });
  return {
    rig: {
      frames, middles, bind, inHand, limbs, limbOfFrame, folds, ownPlaneUntil: header.own_plane_until_rad,
      middleShare: header.middle_share, regions: { shapes, partOfFrame, leastWeight: header.regions.least_weight },
    },
    colors: header.colors, indices, weights, paint, borderStep: header.border_step_m,
    isTwoSided: header.two_sided, triangles: corners, leans: header.leans ? { shares: leans, neighbours } : null,
    positions: Float32Array.from(steps, (step) => header.position_step_m * step),
  };
}
