// How much the view shows: as little as the people need, but it seldom changes; as in the server's live picture
// (render/camera/held_room.cc). World frame: z up, metres.

/** @typedef {{height: number, below: number}} ViewRoom  height: of the view, m; below: by which what comes towards the
 *    camera seems to be below the floor, m */

const FILL = 0.74, MOST_FILL = 0.85, LEAST_FILL = 0.65;  // of the height; the first: where what is needed is shown
const SPARE_BELOW = 0.03;       // of the height, that people may use up
const SHORT_WAIT = 2, LONG_WAIT = 10;  // s
const REGRET = 10;              // s after coming nearer, in which going back was a mistake
const BACK = 0.9;               // of the height from which it came nearer
const INTERVAL = 0.1;           // s, between rooms that are remembered
const QUICK = 4, SLOW = 1.5;    // 1/s; more room is needed sooner than less
const ARRIVED = 0.005;          // m and m/s

/** @type {(a: ViewRoom, b: ViewRoom) => ViewRoom} */
const union = (a, b) => ({ height: Math.max(a.height, b.height), below: Math.max(a.below, b.below) });

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

export class HeldRoom {
  #seen = /** @type {{secs: number, needed: ViewRoom}[]} */ ([]);
  #held = { height: 0, below: 0 };
  #speed = { height: 0, below: 0 };
  #atSecs = 0;
  #wait = SHORT_WAIT;
  #cameNearerAt = 0;
  #cameNearerFrom = 0;
  #mayRegret = false;
  #isGliding = false;

  /** What is shown at this moment: what was needed during the last two seconds. It goes over to more as soon as people
   *  would fill too much or be cut off, and slowly to less where they have filled little. If that was too soon, because
   *  they rise again, it waits twice as long the next time.
   *  @param {ViewRoom} needed
   *  @param {number} secs  if it goes back, what was before is forgotten
   *  @returns {ViewRoom} */
  follow(needed, secs) {
    const dt = Math.max(0, secs - this.#atSecs);
    if (this.#seen.length === 0 || secs < this.#atSecs) this.#begin(needed);
    this.#atSecs = secs;
    const goal = this.#recent(needed, secs);
    const fill = (FILL * goal.height) / this.#held.height;
    const isTooLittle = fill > MOST_FILL || goal.below > this.#held.below + SPARE_BELOW * this.#held.height;
    const isTooMuch = fill < LEAST_FILL;
    this.#learnToWait(goal, isTooMuch, secs);
    this.#isGliding ||= isTooLittle || isTooMuch;
    if (this.#isGliding) this.#glide(goal, dt);
    return { ...this.#held };
  }

  /** @param {ViewRoom} needed */
  #begin(needed) {
    this.#seen = [];
    this.#held = { ...needed };
    this.#speed = { height: 0, below: 0 };
    this.#wait = SHORT_WAIT;
    this.#mayRegret = false;
    this.#isGliding = false;
  }

  /** @param {ViewRoom} needed
   *  @param {number} secs */
  #recent(needed, secs) {
    const last = this.#seen.at(-1);
    if (!last || secs - last.secs >= INTERVAL) this.#seen.push({ secs, needed });
    while (secs - this.#seen[0].secs > LONG_WAIT) this.#seen.shift();
    return this.#seen.filter((seen) => secs - seen.secs <= this.#wait)
      .reduce((room, seen) => union(room, seen.needed), needed);
  }

  /** @param {ViewRoom} goal
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

  /** @param {ViewRoom} goal
   *  @param {number} dt  s */
  #glide(goal, dt) {
    const stiffness = goal.height < this.#held.height ? SLOW : QUICK;
    for (const part of /** @type {(keyof ViewRoom)[]} */ (['height', 'below'])) {
      [this.#held[part], this.#speed[part]] = glide(this.#held[part], this.#speed[part], goal[part], stiffness, dt);
    }
    const hasArrived = (/** @type {keyof ViewRoom} */ part) =>
      Math.abs(this.#held[part] - goal[part]) < ARRIVED && Math.abs(this.#speed[part]) < ARRIVED;
    if (!hasArrived('height') || !hasArrived('below')) return;
    this.#isGliding = false;
    this.#speed = { height: 0, below: 0 };
  }
}
