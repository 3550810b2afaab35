// How the view shows people: they fill most of what is free of it, but it seldom moves; as in the server's live picture
// (render/camera/held_view.cc).
import { FILL, isWithin, placeFor, union } from './view_frame.js';

/** @typedef {import('./view_frame.js').ViewHull} ViewHull
 *  @typedef {import('./view_frame.js').ViewPlace} ViewPlace
 *  @typedef {import('./view_frame.js').ViewShape} ViewShape */

const LEAST_FILL = 0.65;        // of the free height or width
const SHORT_WAIT = 2, LONG_WAIT = 10;  // s
const REGRET = 10;              // s after coming nearer, in which going back was a mistake
const BACK = 0.9;               // of the height from which it came nearer
const INTERVAL = 0.1;           // s, between hulls that are remembered
const QUICK = 4, SLOW = 1.5;    // 1/s; more room is needed sooner than less
const ARRIVED = 0.005;          // m and m/s
const OTHER = 0.05;             // of the height, by which a place is another
const PARTS = /** @type {const} */ (['right', 'up', 'height']);

/** One step of a critically damped spring: exact, so that the number of pictures does not matter.
 *  @param {number} value
 *  @param {number} speed
 *  @param {number} goal
 *  @param {number} stiffness  1/s
 *  @param {number} dt  s
 *  @returns {[number, number]} value and speed */
function glide(value, speed, goal, stiffness, dt) {
  const decay = Math.exp(-stiffness * dt);
  const away = value - goal, pull = speed + stiffness * away;
  return [goal + decay * (away + dt * pull), decay * (speed - stiffness * dt * pull)];
}

export class HeldView {
  #seen = /** @type {{secs: number, needed: ViewHull}[]} */ ([]);
  #held = { right: 0, up: 0, height: 0 };
  #speed = { right: 0, up: 0, height: 0 };
  #atSecs = 0;
  #wait = SHORT_WAIT;
  #cameNearerAt = 0;
  #cameNearerFrom = 0;
  #mayRegret = false;
  #isGliding = false;
  #area = /** @type {ViewShape['area']} */ ({ free: { left: 0, top: 0, right: 1, bottom: 1 }, corners: [] });

  /** Where the view is at this moment: it shows what was needed during the last two seconds. It goes over to more as soon
   *  as people would fill more than 85 % of what is free, or be covered, and slowly to less where they fill less than
   *  65 %. If that was too soon, because they rise again, it waits twice as long the next time. Where an overlay that comes
   *  or goes makes a difference, it does not glide: the stream may have stopped.
   *  @param {ViewHull} needed
   *  @param {ViewShape} shape
   *  @param {number} secs  if it goes back, what was before is forgotten
   *  @returns {ViewPlace} */
  follow(needed, shape, secs) {
    const dt = Math.max(0, secs - this.#atSecs);
    if (this.#seen.length === 0 || secs < this.#atSecs) this.#begin(needed, shape);
    this.#atSecs = secs;
    const recent = this.#recent(needed, secs), goal = placeFor(recent, shape);
    const isTooLittle = !isWithin(recent, this.#held, shape);
    if (shape.area !== this.#area) {
      const before = placeFor(recent, { ...shape, area: this.#area });
      this.#area = shape.area;
      const isOther = PARTS.some((part) => Math.abs(goal[part] - before[part]) > OTHER * goal.height);
      if (isTooLittle || isOther) return this.#goTo(goal);
    }
    const isTooMuch = goal.height < LEAST_FILL / FILL * this.#held.height;
    this.#learnToWait(goal, isTooMuch, secs);
    this.#isGliding ||= isTooLittle || isTooMuch;
    if (this.#isGliding) this.#glide(goal, isTooLittle || goal.height >= this.#held.height ? QUICK : SLOW, dt);
    return { ...this.#held };
  }

  /** What was before is forgotten: the view looks from another side. */
  cut() {
    this.#seen = [];
  }

  /** @param {ViewHull} needed
   *  @param {ViewShape} shape */
  #begin(needed, shape) {
    this.#seen = [];
    this.#area = shape.area;
    this.#wait = SHORT_WAIT;
    this.#mayRegret = false;
    this.#goTo(placeFor(needed, shape));
  }

  /** @param {ViewPlace} place */
  #goTo(place) {
    this.#held = { ...place };
    this.#speed = { right: 0, up: 0, height: 0 };
    this.#isGliding = false;
    return { ...place };
  }

  /** @param {ViewHull} needed
   *  @param {number} secs */
  #recent(needed, secs) {
    const last = this.#seen.at(-1);
    if (!last || secs - last.secs >= INTERVAL) this.#seen.push({ secs, needed });
    while (secs - this.#seen[0].secs > LONG_WAIT) this.#seen.shift();
    return union([needed, ...this.#seen.filter((seen) => secs - seen.secs <= this.#wait).map((seen) => seen.needed)]);
  }

  /** @param {ViewPlace} goal
   *  @param {boolean} isTooMuch
   *  @param {number} secs */
  #learnToWait(goal, isTooMuch, secs) {
    if (isTooMuch) {
      if (!this.#mayRegret) this.#cameNearerFrom = this.#held.height;
      this.#mayRegret = true;
      this.#cameNearerAt = secs;
    }
    if (!this.#mayRegret) return;
    const isSoon = secs - this.#cameNearerAt < REGRET;
    const goesBack = goal.height > BACK * this.#cameNearerFrom;
    if (isSoon && !goesBack) return;
    this.#mayRegret = false;
    this.#wait = isSoon ? Math.min(2 * this.#wait, LONG_WAIT) : SHORT_WAIT;
  }

  /** @param {ViewPlace} goal
   *  @param {number} stiffness  1/s
   *  @param {number} dt  s */
  #glide(goal, stiffness, dt) {
    for (const part of PARTS) {
      [this.#held[part], this.#speed[part]] = glide(this.#held[part], this.#speed[part], goal[part], stiffness, dt);
    }
    const hasArrived = PARTS.every((part) =>
      Math.abs(this.#held[part] - goal[part]) < ARRIVED && Math.abs(this.#speed[part]) < ARRIVED);
    if (!hasArrived) return;
    this.#isGliding = false;
    this.#speed = { right: 0, up: 0, height: 0 };
  }
}
