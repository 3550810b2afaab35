// Where loads are shown on the skin, as the server finds it (urdf/skin/load_regions.cc): the region around each joint,
// in the bind pose. Pure functions.

/** @typedef {{joint: number, isBall: boolean, parts: number, middle: number[], direction: number[], halfWidth: number,
 *    flare: number}} RegionShape  a ball, or a band across `direction`, which falls to the sides by `flare` (1/m);
 *    joint: as in the loads of a state; parts: of the body, as bits; middle, halfWidth: m */

const TRUNK = 0;
const OUTSIDE = -0.01;  // where triangles have corners in different regions
/** Floats of each vertex: how far inside of its region it is (1: in the middle, 0: on the border), the region's place
 *  in the list, and where the vertex is across the hatching, m. */
export const REGION_FLOATS = 3;
const ACROSS = 0.577;

/** The part of the body that carries nearly all of each vertex; else the trunk.
 *  @param {Uint8Array} indices  of frames, four of each vertex
 *  @param {Uint8Array} weights
 *  @param {number[]} partOfFrame
 *  @param {number} least  of the weights of a part, of 255
 *  @returns {Uint8Array} */
function partsOfVertices(indices, weights, partOfFrame, least) {
  const shares = new Uint16Array(Math.max(TRUNK, ...partOfFrame) + 1);
  return Uint8Array.from({ length: weights.length / 4 }, (_, vertex) => {
    shares.fill(0);
    for (let i = 4 * vertex; i < 4 * vertex + 4; ++i) shares[partOfFrame[indices[i]]] += weights[i];
    const part = shares.findIndex((share) => share >= least);
    return part < 0 ? TRUNK : part;
  });
}

/** @param {RegionShape} shape
 *  @param {number} x
 *  @param {number} y
 *  @param {number} z */
function insideOf({ isBall, middle, direction, halfWidth, flare }, x, y, z) {
  const dx = x - middle[0], dy = y - middle[1], dz = z - middle[2];
  const along = dx * direction[0] + dy * direction[1] + dz * direction[2] - flare * dy * dy;
  return 1 - (isBall ? Math.hypot(dx, dy, dz) : Math.abs(along)) / halfWidth;
}

/** @param {Pick<import('./skin_buffer.js').Skin, 'rig'|'positions'|'indices'|'weights'|'triangles'>} skin
 *  @returns {Float32Array}  REGION_FLOATS of each vertex */
export function regionsOf({ rig, positions, indices, weights, triangles }) {
  const { shapes, partOfFrame, leastWeight } = rig.regions;
  const parts = partsOfVertices(indices, weights, partOfFrame, leastWeight);
  const values = new Float32Array(REGION_FLOATS * parts.length);
  parts.forEach((part, vertex) => {
    const x = positions[3 * vertex], y = positions[3 * vertex + 1], z = positions[3 * vertex + 2];
    let nearest = 0, most = -1;
    shapes.forEach((shape, region) => {
      if ((shape.parts >> part & 1) === 0) return;
      const inside = insideOf(shape, x, y, z);
      if (inside <= most) return;
      most = inside;
      nearest = region;
    });
    values.set([most, nearest, ACROSS * (x + y + z)], REGION_FLOATS * vertex);
  });
  keepApart(triangles, values);
  return values;
}

/** Wherever the corners of a triangle have different regions, all of them are outside.
 *  @param {Uint16Array} triangles
 *  @param {Float32Array} values  are changed */
function keepApart(triangles, values) {
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = triangles.subarray(t, t + 3);
    const [a, b, c] = [0, 1, 2].map((i) => values[REGION_FLOATS * corners[i] + 1]);
    if (a === b && b === c) continue;
    for (const corner of corners) {
      values[REGION_FLOATS * corner] = Math.min(values[REGION_FLOATS * corner], OUTSIDE);
    }
  }
}
