// Where a joint bends far, the flesh on its hollow side meets: it flattens against the plane in which the fold closes,
// and gives way along the fold, as in the server's pictures (urdf/skin/contact.cc). Bind pose, metres.
import * as THREE from 'three';

/** @typedef {number[]} Growth  two: where a share grows from 0 to 1, smoothly
 *  @typedef {number[]} Vector  three
 *  @typedef {{link: number, before: number[], frame: number, center_m: Vector, normal: Vector, across: Vector,
 *    inwards: Vector, pressed_m: Growth, bulging_m: Growth, outwards: Vector, beside_midline_m: Growth,
 *    softness_m: number, bulge: number, bulges: Growth}} FoldShape  link: the joint's child; before: the links on the
 *    other side of the plane; frame: carries the plane; bulges: over the cosine of the bend
 *  @typedef {{shapes: FoldShape[], contact: Growth, bulge_reach_m: number}} Folds
 *  @typedef {import('./skin_frames.js').Pose} Pose */

/** @param {Growth} growth
 *  @param {number} x */
function grown([from, to], x) {
  const t = Math.min(1, Math.max(0, (x - from) / (to - from)));
  return t * t * (3 - 2 * t);
}

/** @param {Vector} a
 *  @param {number} x
 *  @param {number} y
 *  @param {number} z */
const dot = (a, x, y, z) => a[0] * x + a[1] * y + a[2] * z;

/** How far a frame is past the joint, 0..1; less than 0: it carries other parts.
 *  @param {FoldShape} fold
 *  @param {import('./skin_buffer.js').FrameRule} frame */
function pastOf({ link, before }, { kind, link: own, share }) {
  const isSwing = kind === 'swing';
  if (kind === 'half' || kind === 'fixed') return -1;
  if (own === link) return isSwing ? share : 1;
  return !isSwing && before.includes(own) ? 0 : -1;
}

/** Four numbers of each vertex and fold that it takes part in: the place of the fold, its share of the press (negative
 *  on the child's side), how far it is past the plane in the bind pose (m, at most 0) and how much wider it becomes.
 *  @param {import('./skin_buffer.js').Skin} skin
 *  @returns {{values: Float32Array, most: number}}  most: folds of a vertex, at least one; as many are in `values` for
 *    each vertex, one fold after the other */
export function foldsOfVertices({ rig: { frames, folds: { shapes } }, positions, indices, weights }) {
  const vertices = positions.length / 3;
  /** @type {number[][]} */
  const found = Array.from({ length: vertices }, () => []);
  shapes.forEach((fold, place) => {
    const past = frames.map((frame) => pastOf(fold, frame));
    const { center_m: center } = fold;
    for (let vertex = 0; vertex < vertices; ++vertex) {
      let whole = 0, weighted = 0;
      for (let i = 4 * vertex; i < 4 * vertex + 4; ++i) {
        const ofFrame = past[indices[i]];
        if (ofFrame < 0) continue;
        whole += weights[i];
        weighted += weights[i] * ofFrame;
      }
      if (whole === 0) continue;
      const [x, y, z] = positions.subarray(3 * vertex, 3 * vertex + 3);
      const dx = x - center[0], dy = y - center[1], dz = z - center[2];
      const inwards = dot(fold.inwards, dx, dy, dz), before = dot(fold.normal, dx, dy, dz);
      const side = Math.min(1, Math.max(-1, 2 - 4 * weighted / whole));
      const share = whole / 255 * grown(fold.beside_midline_m, dot(fold.outwards, x, y, z));
      const press = side * share * grown(fold.pressed_m, inwards);
      const bulge = Math.abs(side) * share * grown(fold.bulging_m, inwards) * fold.bulge;
      if (press === 0 && bulge === 0) continue;
      found[vertex].push(place, press, Math.min(press > 0 ? before : -before, 0), bulge);
    }
  });
  const most = found.reduce((longest, { length }) => Math.max(longest, length / 4), 1);
  const values = new Float32Array(4 * vertices * most);
  found.forEach((each, vertex) => {
    for (let k = 0; k < each.length / 4; ++k) values.set(each.slice(4 * k, 4 * k + 4), 4 * (k * vertices + vertex));
  });
  return { values, most };
}

/** @param {Folds} folds */
export const emptyPlanes = ({ shapes }) => new Float32Array(12 * Math.max(1, shapes.length));

/** Three vectors of each fold: the normal of the plane in the world and the softness, the direction along the fold and
 *  the share of contact, the centre and the share of the bulge.
 *  @param {Folds} folds
 *  @param {THREE.Matrix4[]} matrices  world_from_bind of each frame
 *  @param {Pose[]} links  of all links, as they are streamed
 *  @param {Float32Array} planes  is written */
export function setPlanes({ shapes, contact }, matrices, links, planes) {
  const vector = new THREE.Vector3();
  const direction = (/** @type {number} */ link) =>
    new THREE.Vector3(0, 0, 1).applyQuaternion(new THREE.Quaternion().fromArray(links[link].quaternion));
  shapes.forEach(({ link, before, frame, center_m, normal, across, softness_m, bulges }, i) => {
    const bend = direction(link).dot(direction(before[0]));
    const rows = [
      [...vector.fromArray(normal).transformDirection(matrices[frame]), softness_m],
      [...vector.fromArray(across).transformDirection(matrices[frame]), grown(contact, bend)],
      [...vector.fromArray(center_m).applyMatrix4(matrices[frame]), grown(bulges, bend)],
    ];
    planes.set(rows.flat(), 12 * i);
  });
}

/** GLSL: a posed position after the folds that its vertex takes part in. `folds` has the values of foldsOfVertices(),
 *  one fold below the other.
 *  @param {Folds} folds
 *  @param {number} most  of a vertex */
export const pressed = ({ shapes, bulge_reach_m }, most) => `
  uniform highp sampler2D folds;
  uniform vec4 planes[${3 * Math.max(1, shapes.length)}];
  vec3 pressed(vec3 position, ivec2 at, int rows) {
    for (int k = 0; k < ${most}; ++k) {
      vec4 of = texelFetch(folds, at + ivec2(0, k * rows), 0);
      int fold = 3 * int(of.x + 0.5);
      vec4 normal = planes[fold], across = planes[fold + 1], center = planes[fold + 2];
      vec3 from = position - center.xyz;
      float before = dot(normal.xyz, from);
      float above = (of.y > 0.0 ? before : -before) - of.z;
      float past = max(-above, 0.0);
      float press = past * past / (normal.w + past + 1e-9);
      float wider = of.w * ${bulge_reach_m} / (${bulge_reach_m} + max(above, 0.0));
      position += across.w * of.y * press * normal.xyz + center.w * wider * dot(across.xyz, from) * across.xyz;
    }
    return position;
  }`;
