// How much height the view shows: as little as the people need, but it seldom changes; as in the server's live picture
// (render/camera/held_height.cc). World frame: z up, metres.
const FILL = 0.72, MOST_FILL = 0.85, LEAST_FILL = 0.60;  // of the height; the first: where `needed` is shown
const MEMORY = 10;              // s
const INTERVAL = 0.1;           // s, between heights that are remembered
const QUICK = 4, SLOW = 1.5;    // 1/s; more room is needed sooner than less
const ARRIVED = 0.005;          // m and m/s

export class HeldHeight {
  #seen = /** @type {{secs: number, needed: number}[]} */ ([]);
  #held = 0;
  #speed = 0;
  #atSecs = 0;
  #isGliding = false;

  /** The height for this moment: what was needed during the last seconds. It goes over to more as soon as people would
   *  fill too much, and to less only where they have filled little for some time.
   *  @param {number} needed  m
   *  @param {number} secs  if it goes back, what was before is forgotten
   *  @returns {number} m */
  follow(needed, secs) {
    const dt = Math.max(0, secs - this.#atSecs);
    if (this.#seen.length === 0 || secs < this.#atSecs) {
      this.#seen = [];
      this.#held = needed;
      this.#speed = 0;
      this.#isGliding = false;
    }
    this.#atSecs = secs;
    const last = this.#seen.at(-1);
    if (!last || secs - last.secs >= INTERVAL) this.#seen.push({ secs, needed });
    while (secs - this.#seen[0].secs > MEMORY) this.#seen.shift();
    const goal = Math.max(needed, ...this.#seen.map((seen) => seen.needed));
    const fill = (FILL * goal) / this.#held;
    this.#isGliding ||= fill > MOST_FILL || fill < LEAST_FILL;
    if (!this.#isGliding) return this.#held;
    const stiffness = goal > this.#held ? QUICK : SLOW;
    const decay = Math.exp(-stiffness * dt);
    const away = this.#held - goal, pull = this.#speed + stiffness * away;
    this.#held = goal + decay * (away + dt * pull);
    this.#speed = decay * (this.#speed - stiffness * dt * pull);
    if (Math.abs(this.#held - goal) < ARRIVED && Math.abs(this.#speed) < ARRIVED) {
      this.#isGliding = false;
      this.#speed = 0;
    }
    return this.#held;
  }
}
