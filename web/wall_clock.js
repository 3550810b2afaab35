// Which time of day the moments of the server's history have, by the clock of the browser. Pure: times are arguments.

const JUMP_MILLIS = 1000;  // a clock was set, or the page slept

export class WallClock {
  #offset = NaN;

  /** @param {number} newest  moment of the newest sample, ms of the server's clock
   *  @param {number} wall  now, ms of the browser's clock */
  add(newest, wall) {
    const offset = wall - newest;
    // The least of all is that of the sample which came quickest, so the clock does not tremble with the network.
    this.#offset = offset < this.#offset || !(offset - this.#offset < JUMP_MILLIS) ? offset : this.#offset;
  }

  /** @param {number} micros  a moment of the server's clock
   *  @returns {number}  ms of the browser's clock, as Date has it */
  at(micros) {
    return micros / 1000 + this.#offset;
  }
}
