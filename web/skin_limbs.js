// How limbs cover the sky over the skin, as the server computes it (urdf/skin/occlusion.cc): the body as capsules that
// move with the links. World frame: z up, metres. Pure functions.
import * as THREE from 'three';

/** @typedef {{link: number, point: THREE.Vector3, radius: number}} LimbEnd  point: in the frame of the link
 *  @typedef {{start: LimbEnd, end: LimbEnd, joined: number[], whole: number[]}} Limb  what covers it: limbs to which it
 *    is joined, which cover only what is away from them, and others
 *  @typedef {{start: THREE.Vector3, end: THREE.Vector3, startRadius: number, endRadius: number}} Capsule */

/** The limb that carries most of each vertex.
 *  @param {Uint8Array} indices  of frames, four of each vertex
 *  @param {Uint8Array} weights  of them, descending
 *  @param {number[]} limbOfFrame
 *  @returns {Uint8Array} */
export function limbsOfVertices(indices, weights, limbOfFrame) {
  const shares = new Uint16Array(Math.max(...limbOfFrame) + 1);
  return Uint8Array.from({ length: weights.length / 4 }, (_, vertex) => {
    shares.fill(0);
    for (let i = 4 * vertex; i < 4 * vertex + 4; ++i) shares[limbOfFrame[indices[i]]] += weights[i];
    return shares.indexOf(Math.max(...shares));
  });
}

/** @param {Limb[]} limbs
 *  @param {import('./skin_frames.js').Pose[]} links  as they are streamed
 *  @returns {Capsule[]} */
export function capsulesOf(limbs, links) {
  const place = (/** @type {LimbEnd} */ { link, point }) => point.clone()
    .applyQuaternion(new THREE.Quaternion().fromArray(links[link].quaternion))
    .add(new THREE.Vector3().fromArray(links[link].position));
  return limbs.map(({ start, end }) => ({
    start: place(start), end: place(end), startRadius: start.radius, endRadius: end.radius,
  }));
}

/** Which limbs cover each limb, as bits: all of it, and what is away from it.
 *  @param {Limb[]} limbs */
export function coversOf(limbs) {
  const bitsOf = (/** @type {number[]} */ numbers) => numbers.reduce((bits, number) => bits | 1 << number, 0);
  return Uint32Array.from(limbs.flatMap(({ whole, joined }) => [bitsOf(whole), bitsOf(joined)]));
}

/** Floats of each capsule: start and its radius, bone and by how much the radius grows, bone / length². */
export const CAPSULE_FLOATS = 12;

/** @param {Limb[]} limbs */
export const emptyCapsules = (limbs) => new Float32Array(CAPSULE_FLOATS * limbs.length);

/** @param {Limb[]} limbs
 *  @param {import('./skin_frames.js').Pose[]} links
 *  @param {Float32Array} values  are set */
export function setCapsules(limbs, links, values) {
  capsulesOf(limbs, links).forEach(({ start, end, startRadius, endRadius }, i) => {
    const bone = end.clone().sub(start);
    const axis = bone.clone().divideScalar(Math.max(bone.lengthSq(), 1e-8));
    values.set([...start, startRadius, ...bone, endRadius - startRadius, ...axis, 0], CAPSULE_FLOATS * i);
  });
}

/** Both ends of each.
 *  @param {Float32Array} values  of capsules */
export function capsuleEnds(values) {
  const ends = [];
  for (let at = 0; at < values.length; at += CAPSULE_FLOATS) {
    const start = [...values.subarray(at, at + 3)];
    ends.push(start, start.map((value, axis) => value + values[at + 4 + axis]));
  }
  return ends;
}

const STRENGTH = 0.8;  // of limbs that cover the sky
const LEAST_SQUARE = 1e-8;  // m²
const { clamp } = THREE.MathUtils;

/** The share of the sky over a point of the floor that no limb covers: `openSky` for a normal that points up and limbs that
 *  all cover it.
 *  @param {Float32Array} values  of capsules
 *  @param {number} x
 *  @param {number} y
 *  @param {number} z */
export function openSkyOverFloor(values, x, y, z) {
  let open = 1;
  for (let i = 0; i < values.length; i += CAPSULE_FLOATS) {
    const awayX = x - values[i], awayY = y - values[i + 1], awayZ = z - values[i + 2];
    const along = clamp(awayX * values[i + 8] + awayY * values[i + 9] + awayZ * values[i + 10], 0, 1);
    const toX = along * values[i + 4] - awayX, toY = along * values[i + 5] - awayY, up = along * values[i + 6] - awayZ;
    const square = Math.max(toX * toX + toY * toY + up * up, LEAST_SQUARE), radius = values[i + 3] + along * values[i + 7];
    open *= 1 - STRENGTH * Math.max(up, 0) / Math.sqrt(square) * Math.min(radius * radius / square, 1);
  }
  return open;
}

/** GLSL: the share of the sky over a vertex that no limb covers. All limbs are computed for all vertices: a software
 *  renderer would take longer to choose.
 *  @param {number} count  of limbs */
export const openSky = (count) => `
  uniform vec4 capsules[${3 * count}];
  uniform highp uvec2 covers[${count}];
  float openSky(vec3 position, vec3 normal, int limb) {
    uvec2 by = covers[limb];
    float open = 1.0;
    for (int i = 0; i < ${count}; ++i) {
      vec4 start = capsules[3 * i], bone = capsules[3 * i + 1];
      vec3 away = position - start.xyz;
      float along = clamp(dot(away, capsules[3 * i + 2].xyz), 0.0, 1.0);
      vec3 toBone = along * bone.xyz - away;
      float inverse = inversesqrt(max(dot(toBone, toBone), 1e-8)), radius = start.w + along * bone.w;
      float size = radius * inverse;
      float covered = ${STRENGTH} * max(dot(toBone, normal) * inverse, 0.0) * min(size * size, 1.0);
      float joined = clamp(2.5 * (1.0 / size - 1.0), 0.0, 1.0);
      covered *= (by.x >> i & 1u) != 0u ? 1.0 : (by.y >> i & 1u) != 0u ? joined : 0.0;
      open *= 1.0 - covered;
    }
    return open;
  }`;
