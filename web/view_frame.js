// Where a camera is to be so that people fill most of what is free of the view; as in the server's live picture
// (render/camera/framing.cc, held_view.cc). Pure functions.

/** @typedef {number[]} Vector  of three numbers
 *  @typedef {{center: Vector, radius: number}} Ball  m
 *  @typedef {{right: Vector, up: Vector, forward: Vector}} Axes  of a camera, in the world
 *  @typedef {Ball[]} ViewHull  around people, of one moment or of several: the balls that may touch a side of the view, by
 *    direction; in a camera's axes (right, up, forward), from the people's middle on the floor
 *  @typedef {{left: number, top: number, right: number, bottom: number}} Rect  shares of the view's width and height, from
 *    its upper left corner
 *  @typedef {{free: Rect, corners: Rect[]}} FreeArea  between what goes from side to side; covered parts of it
 *  @typedef {{aspect: number, slope: number, area: FreeArea}} ViewShape  aspect: width / height; slope: of half the height
 *  @typedef {{right: number, up: number, height: number}} ViewPlace  of the middle of the view from the people's middle, in
 *    the camera's axes, and the height that the view shows there; m
 *  @typedef {{left: number, right: number, down: number, up: number}} Window  -1 to 1, up is positive
 *  @typedef {{eye: Vector, slope: number}} Seat  a camera in its own axes */

export const FILL = 0.76, MOST_FILL = 0.85;  // of the free height or width
const LEAST_HEIGHT = 0.9;  // m, that is shown
const REACH = 3;           // m; what is farther from its person is left out
const STANDING = { halfWidth: 0.35, height: 1.9 };  // m, of an adult with arms overhead
const LEAST_WINDOW = 0.1;

/** @type {(a: Vector, b: Vector) => number} */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @type {(a: Vector, b: Vector) => Vector} */
const minus = (a, b) => a.map((v, i) => v - b[i]);

/** To the planes through the eye that touch people: their slopes are those of the sides of views, and of a part of them. */
const DIRECTIONS = [[0, 0, 1], [0, 0, -1], ...[-0.5, -0.35, -0.2, -0.1, 0, 0.1, 0.2, 0.35, 0.5].flatMap((slope) =>
  [-1, 1].flatMap((side) => [[side, 0, slope], [0, side, slope]]))].map((way) => ({ way, length: Math.hypot(...way) }));

/** @param {(typeof DIRECTIONS)[number]} direction
 *  @param {Ball[]} balls */
function farthest({ way, length }, balls) {
  let found = balls[0], most = -Infinity;
  for (const ball of balls) {
    const reach = dot(way, ball.center) + length * ball.radius;
    if (reach > most) [found, most] = [ball, reach];
  }
  return found;
}

/** Around all of the balls, in the axes.
 *  @param {Ball[]} balls
 *  @returns {ViewHull} */
export function hullOf(balls) {
  return DIRECTIONS.map((direction) => farthest(direction, balls));
}

/** Around all of the hulls.
 *  @param {ViewHull[]} hulls
 *  @returns {ViewHull} */
export function union(hulls) {
  return DIRECTIONS.map((direction, i) => farthest(direction, hulls.map((hull) => hull[i])));
}

/** What a view in this direction must show. Without people: a standing adult with arms overhead.
 *  @param {{place: Vector, balls: Ball[]}[]} people  place: of the pelvis
 *  @param {Vector} middle
 *  @param {Axes} axes
 *  @returns {ViewHull} */
export function neededHull(people, middle, { right, up, forward }) {
  const inAxes = (/** @type {Ball} */ { center, radius }) => {
    const from = minus(center, middle);
    return { center: [dot(right, from), dot(up, from), dot(forward, from)], radius };
  };
  const near = people.flatMap(({ place, balls }) =>
    balls.filter(({ center, radius }) => Math.hypot(...minus(center, place)) + radius < REACH));
  if (near.length > 0) return hullOf(near.map(inAxes));
  const { halfWidth: radius, height } = STANDING;
  return hullOf([radius, height - radius].map((z) => inAxes({ center: [middle[0], middle[1], middle[2] + z], radius })));
}

/** @type {(rect: Rect) => Window} */
const windowOf = ({ left, top, right, bottom }) =>
  ({ left: 2 * left - 1, right: 2 * right - 1, down: 1 - 2 * bottom, up: 1 - 2 * top });

/** The middle part of it that is to be filled.
 *  @type {(window: Window, share: number) => Window} */
function filled({ left, right, down, up }, share) {
  const x = (right - left) * (1 - share) / 2, y = (up - down) * (1 - share) / 2;
  return { left: left + x, right: right - x, down: down + y, up: up - y };
}

/** All balls are between two planes through the eye, whose slopes are low and high, along one axis.
 *  @param {Ball[]} balls
 *  @param {number} axis
 *  @param {number} low
 *  @param {number} high */
function seatOf(balls, axis, low, high) {
  const above = Math.hypot(1, high), below = Math.hypot(1, low);
  const highSide = Math.max(...balls.map(({ center, radius }) => center[axis] - high * center[2] + above * radius));
  const lowSide = Math.min(...balls.map(({ center, radius }) => center[axis] - low * center[2] - below * radius));
  return {
    depth: -(highSide - lowSide) / (high - low),
    at: (/** @type {number} */ depth) => (highSide + high * depth + lowSide + low * depth) / 2,
  };
}

/** @type {(balls: Ball[], shape: ViewShape, window: Window) => Seat} */
function seatIn(balls, { aspect, slope }, { left, right, down, up }) {
  const across = seatOf(balls, 0, slope * aspect * left, slope * aspect * right);
  const upright = seatOf(balls, 1, slope * down, slope * up);
  const depth = Math.min(across.depth, upright.depth);
  return { eye: [across.at(depth), upright.at(depth), depth], slope };
}

/** The rectangle around the balls in the view.
 *  @type {(seat: Seat, balls: Ball[], aspect: number) => Window} */
function shownAround({ eye, slope }, balls, aspect) {
  const around = { left: Infinity, right: -Infinity, down: Infinity, up: -Infinity };
  for (const { center, radius } of balls) {
    const [x, y, z] = minus(center, eye), half = slope * Math.max(z, 1e-6);
    around.left = Math.min(around.left, (x - radius) / (half * aspect));
    around.right = Math.max(around.right, (x + radius) / (half * aspect));
    around.down = Math.min(around.down, (y - radius) / half);
    around.up = Math.max(around.up, (y + radius) / half);
  }
  return around;
}

/** @type {(a: Window, b: Window) => boolean} */
const overlaps = (a, b) => a.left < b.right && b.left < a.right && a.down < b.up && b.down < a.up;

/** @type {(window: Window, corner: Window) => Window} */
const beside = (window, corner) => (corner.left + corner.right < 0
  ? { ...window, left: Math.max(window.left, corner.right) } : { ...window, right: Math.min(window.right, corner.left) });
/** @type {(window: Window, corner: Window) => Window} */
const aboveOrBelow = (window, corner) => (corner.down + corner.up < 0
  ? { ...window, down: Math.max(window.down, corner.up) } : { ...window, up: Math.min(window.up, corner.down) });

/** Beside or above each corner that is in the way: whichever shows things larger.
 *  @type {(balls: Ball[], shape: ViewShape) => Seat} */
function bestSeat(balls, shape) {
  const whole = windowOf(shape.area.free);
  let corners = shape.area.corners.map(windowOf), best = seatIn(balls, shape, filled(whole, FILL));
  const hit = /** @type {Window[]} */ ([]);
  for (;;) {
    const shown = shownAround(best, balls, shape.aspect);
    const inTheWay = corners.find((corner) => overlaps(shown, corner));
    if (inTheWay === undefined) return best;
    hit.push(inTheWay);
    corners = corners.filter((corner) => corner !== inTheWay);
    const seats = Array.from({ length: 1 << hit.length }, (_, choice) =>
      hit.reduce((window, corner, i) => (choice >> i & 1 ? aboveOrBelow : beside)(window, corner), whole))
      .filter(({ left, right, down, up }) => right - left >= LEAST_WINDOW && up - down >= LEAST_WINDOW)
      .map((window) => seatIn(balls, shape, filled(window, FILL)));
    if (seats.length > 0) best = seats.reduce((a, b) => (b.eye[2] > a.eye[2] ? b : a));
  }
}

/** Shows the hull as large as a live view has it.
 *  @param {ViewHull} hull
 *  @param {ViewShape} shape
 *  @returns {ViewPlace} */
export function placeFor(hull, shape) {
  const placeOf = (/** @type {Ball[]} */ shown) => {
    const [right, up, depth] = bestSeat(shown, shape).eye;
    return { right, up, height: -2 * shape.slope * depth };
  };
  const place = placeOf(hull);
  if (place.height >= LEAST_HEIGHT) return place;
  const center = [0, 1, 2].map((axis) => {
    const along = hull.map((ball) => ball.center[axis]);
    return (Math.min(...along) + Math.max(...along)) / 2;
  });
  return placeOf([...hull, { center, radius: FILL * LEAST_HEIGHT / 2 }]);
}

/** Whether the view from there shows all of the hull, not too near to the edge of what is free.
 *  @param {ViewHull} hull
 *  @param {ViewPlace} place
 *  @param {ViewShape} shape */
export function isWithin(hull, { right, up, height }, { aspect, slope, area }) {
  const seat = { eye: [right, up, -height / 2 / slope], slope };
  const window = filled(windowOf(area.free), MOST_FILL), shown = shownAround(seat, hull, aspect);
  return shown.left >= window.left && shown.right <= window.right && shown.down >= window.down && shown.up <= window.up
    && !area.corners.map(windowOf).some((corner) => overlaps(shown, corner));
}

/** The place, so far to the side that people who have gone away from the middle are beside the covered corners that are at
 *  their height; without room between these, in the middle between them.
 *  @param {ViewPlace} place
 *  @param {ViewHull} people
 *  @param {Vector} away  from the middle to that of the people, in the camera's axes; m
 *  @param {ViewShape} shape
 *  @returns {ViewPlace} */
export function besideCorners({ right, up, height }, people, away, { aspect, slope, area }) {
  const balls = people.map(({ center, radius }) => ({ center: center.map((v, i) => v + away[i]), radius }));
  const seat = { eye: [right, up, -height / 2 / slope], slope };
  const shown = shownAround(seat, balls, aspect), whole = windowOf(area.free);
  const free = area.corners.map(windowOf).filter((corner) => corner.down < shown.up && shown.down < corner.up)
    .reduce(beside, whole);
  if (free.left === whole.left && free.right === whole.right) return { right, up, height };
  let toRight = -Infinity, toLeft = -Infinity;  // m, that people must go at least
  for (const { center, radius } of balls) {
    const metres = aspect * slope * Math.max(center[2] - seat.eye[2], 1e-6), x = center[0] - right;
    toRight = Math.max(toRight, metres * free.left - (x - radius));
    toLeft = Math.max(toLeft, x + radius - metres * free.right);
  }
  const step = toRight + toLeft > 0 ? (toRight - toLeft) / 2 : toRight > 0 ? toRight : Math.min(-toLeft, 0);
  return { right: right - step, up, height };
}
