// The people of a state as balls, as the server has them (core/person_outline.cc). World frame: z up, metres. Pure
// functions.

/** @typedef {import('./view_frame.js').Ball} Ball
 *  @typedef {import('./messages.js').OutlinePoint} OutlinePoint */

const AROUND_LINK = 0.12;  // m, of a person whose outline has not come yet

/** @param {number[]} q  x, y, z, w
 *  @param {number[]} v */
function rotated([x, y, z, w], [vx, vy, vz]) {
  const tx = 2 * (y * vz - z * vy), ty = 2 * (z * vx - x * vz), tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** @param {import('./state_codec.js').Solid} solid
 *  @returns {Ball} */
function ballAround({ kind, position, size: [x, y, z] }) {
  const radii = kind === 'box' ? [x / 2, y / 2, z / 2] : [x, y, z / 2];
  return { center: position, radius: Math.max(...radii) };
}

/** Around the person and what they hold.
 *  @param {import('./state_codec.js').Person} person
 *  @param {OutlinePoint[]|undefined} outline  of their model
 *  @returns {Ball[]} */
export function ballsOf({ links, held }, outline) {
  const body = outline === undefined ? links.map(({ position }) => ({ center: position, radius: AROUND_LINK }))
    : outline.flatMap(({ link, position, radius }) => {
      const at = links[link];
      if (at === undefined) return [];
      return [{ center: rotated(at.quaternion, position).map((v, i) => v + at.position[i]), radius }];
    });
  return [...body, ...held.map(ballAround)];
}
