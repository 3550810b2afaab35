// Named views: the numbers come from the server (/api/v1/cameras), so that a name shows the same view in page and
// picture. World frame: z up, metres. Pure functions.

/** @typedef {import('./messages.js').CameraView} CameraView
 *  @typedef {import('./messages.js').Framing} Framing
 *  @typedef {{position: number[], target: number[], fovDegrees: number}} Aim */

/** Tilt of a view straight down, as a share of its distance: an orbit has no "up" exactly at its pole. */
const POLE_TILT = 1e-3;

const add = (/** @type {number[]} */ a, /** @type {number[]} */ b) => a.map((v, i) => v + b[i]);
const subtract = (/** @type {number[]} */ a, /** @type {number[]} */ b) => a.map((v, i) => v - b[i]);
const scale = (/** @type {number[]} */ a, /** @type {number} */ k) => a.map((v) => v * k);
/** About z, counter-clockwise seen from above.
 *  @param {number[]} a
 *  @param {number} angle  rad */
const turned = ([x, y, z], angle) =>
  [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), z];
const length = (/** @type {number[]} */ a) => Math.hypot(...a);

/** Middle of the people on the floor, and the distance of the outermost person from it. People who are farther than
 *  `reach` from the person nearest to the origin are ignored: all would be too small to see.
 *  @param {number[][]} pelvises
 *  @param {number} floor  height of the floor, m
 *  @param {number} reach  m
 *  @returns {{middle: number[], radius: number}} */
export function groundOf(pelvises, floor, reach) {
  if (pelvises.length === 0) return { middle: [0, 0, floor], radius: 0 };
  const first = pelvises.reduce((a, b) => (Math.hypot(b[0], b[1]) < Math.hypot(a[0], a[1]) ? b : a));
  const framed = pelvises.filter((p) => Math.hypot(p[0] - first[0], p[1] - first[1]) <= reach);
  const sum = framed.reduce(([x, y], p) => [x + p[0], y + p[1]], [0, 0]);
  const middle = [sum[0] / framed.length, sum[1] / framed.length, floor];
  const radius = Math.max(...framed.map((p) => Math.hypot(p[0] - middle[0], p[1] - middle[1])));
  return { middle, radius };
}

/** Position and target of the camera that shows `view` of the people on `ground`.
 *  @param {CameraView} view
 *  @param {Framing} framing
 *  @param {{middle: number[], radius: number, height: number, below: number, heading: number}} ground  height: that the view
 *    shows, m; below: by which what comes towards the camera seems to be below the floor, m; heading: by which it is
 *    turned, rad
 *  @param {number} aspect  width / height of the canvas
 *  @returns {Aim} */
export function aim(view, framing, ground, aspect) {
  const half = Math.tan(view.vertical_fov_rad / 2);
  const size = ground.height / framing.height_m;
  let offset = turned(subtract(view.position, view.target), ground.heading);
  const extent = Math.max(size * length(offset) * half, (ground.radius + framing.margin_m) / framing.narrowest_aspect);
  const distance = extent / half + ground.radius;
  const widened = Math.max(1, framing.min_width_m / (2 * distance * half * aspect));
  offset = scale(offset, (distance * widened) / length(offset));
  const isPole = Math.hypot(offset[0], offset[1]) < POLE_TILT * length(offset);
  if (isPole) offset = subtract(offset, scale(turned(view.up, ground.heading), POLE_TILT * length(offset)));
  const lowered = Math.max(0, ground.below - framing.spare_below * ground.height);
  const target = add(add(ground.middle, scale(view.target, size)), [0, 0, -lowered]);
  return {
    position: add(target, offset),
    target,
    fovDegrees: (view.vertical_fov_rad * 180) / Math.PI,
  };
}
