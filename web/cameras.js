// Named views: the numbers come from the server (/api/v1/cameras), so that a name shows the same view in page and
// picture. World frame: z up, metres. Pure functions.

/** @typedef {import('./messages.js').CameraView} CameraView
 *  @typedef {import('./state_codec.js').Person} Person
 *  @typedef {{position: number[], target: number[], fovDegrees: number}} Aim */

/** Tilt of a view straight down, as a share of its distance: an orbit has no "up" exactly at its pole. */
const POLE_TILT = 1e-3;

/** The name of the camera that the server was started with, if that is none of the others. */
export const OWN_CAMERA = 'own';

const add = (/** @type {number[]} */ a, /** @type {number[]} */ b) => a.map((v, i) => v + b[i]);
const subtract = (/** @type {number[]} */ a, /** @type {number[]} */ b) => a.map((v, i) => v - b[i]);
const scale = (/** @type {number[]} */ a, /** @type {number} */ k) => a.map((v) => v * k);
/** About z, counter-clockwise seen from above.
 *  @param {number[]} a
 *  @param {number} angle  rad */
const turned = ([x, y, z], angle) =>
  [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), z];
const length = (/** @type {number[]} */ a) => Math.hypot(...a);
const unit = (/** @type {number[]} */ a) => scale(a, 1 / length(a));
/** @type {(a: number[], b: number[]) => number[]} */
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const pelvisOf = (/** @type {Person} */ { links }) => links[0].position;

/** Without those who are farther than `reach` from the person nearest to the origin: all would be too small to see.
 *  @param {Person[]} people
 *  @param {number} reach  m
 *  @returns {Person[]} */
export function framedPeople(people, reach) {
  if (people.length === 0) return [];
  const distance = (/** @type {Person} */ a, x = 0, y = 0) => Math.hypot(pelvisOf(a)[0] - x, pelvisOf(a)[1] - y);
  const [x, y] = pelvisOf(people.reduce((a, b) => (distance(b) < distance(a) ? b : a)));
  return people.filter((person) => distance(person, x, y) <= reach);
}

/** Middle of the people on the floor.
 *  @param {Person[]} people  at least one
 *  @param {number} floor  its height, m */
export function middleOf(people, floor) {
  const [x, y] = scale(people.map(pelvisOf).reduce(add), 1 / people.length);
  return [x, y, floor];
}

/** Of the camera that shows `view`.
 *  @param {CameraView} view
 *  @param {number} heading  by which it is turned, rad
 *  @returns {import('./view_frame.js').Axes} */
export function axesOf(view, heading) {
  let offset = turned(subtract(view.position, view.target), heading);
  const viewUp = turned(view.up, heading);
  const isPole = Math.hypot(offset[0], offset[1]) < POLE_TILT * length(offset);
  if (isPole) offset = subtract(offset, scale(viewUp, POLE_TILT * length(offset)));
  const forward = unit(scale(offset, -1)), right = unit(cross(forward, viewUp));
  return { right, up: cross(right, forward), forward };
}

/** @param {number[]} a
 *  @param {number[]} quaternion  x y z w */
function rotated(a, [x, y, z, w]) {
  const axis = [x, y, z], t = scale(cross(axis, a), 2);
  return add(add(a, scale(t, w)), cross(axis, t));
}

/** Of the server's own camera, which stands, or goes with a frame of TF.
 *  @param {CameraView} view
 *  @param {import('./state_codec.js').Pose|null} base  null: it stands, or the frame is not known yet
 *  @param {{least: number, most: number}} range  of the distance to the target, m
 *  @returns {Aim & {up: number[]}} */
export function ownAim(view, base, { least, most }) {
  const toWorld = (/** @type {number[]} */ a) => {
    if (base === null || view.turn === 'none') return a;
    if (view.turn === 'pose') return rotated(a, base.quaternion);
    const [x, y] = rotated([1, 0, 0], base.quaternion);
    return turned(a, Math.atan2(y, x));
  };
  const position = add(base?.position ?? [0, 0, 0], toWorld(view.position));
  const ahead = toWorld(subtract(view.target, view.position));
  const distance = Math.max(least, Math.min(most, length(ahead)));
  return {
    position,
    target: add(position, scale(unit(ahead), distance)),
    up: toWorld(view.up),
    fovDegrees: (view.vertical_fov_rad * 180) / Math.PI,
  };
}

/** Of a named view of a scene without people: Around() of render/camera/camera.cc.
 *  @param {CameraView} view
 *  @param {import('./view_frame.js').Axes} axes
 *  @param {import('./state_codec.js').Extent} extent
 *  @param {number} aspect  width / height of the view
 *  @returns {Aim} */
export function extentAim(view, { forward }, { min, max }, aspect) {
  const margin = 1.15, smallest = 0.02;  // m
  const radius = Math.max(length(subtract(max, min)) / 2, smallest), target = scale(add(min, max), 0.5);
  const distance = (margin * radius) / Math.sin(view.vertical_fov_rad / 2) / Math.min(1, aspect);
  return {
    position: subtract(target, scale(forward, distance)),
    target,
    fovDegrees: (view.vertical_fov_rad * 180) / Math.PI,
  };
}

/** Position and target of the camera that shows `view` from that place.
 *  @param {CameraView} view
 *  @param {import('./view_frame.js').Axes} axes
 *  @param {import('./view_frame.js').ViewPlace} place
 *  @param {number[]} middle  of the people on the floor
 *  @returns {Aim} */
export function cameraAt(view, { right, up, forward }, place, middle) {
  const target = add(middle, add(scale(right, place.right), scale(up, place.up)));
  const distance = place.height / 2 / Math.tan(view.vertical_fov_rad / 2);
  return {
    position: subtract(target, scale(forward, distance)),
    target,
    fovDegrees: (view.vertical_fov_rad * 180) / Math.PI,
  };
}
