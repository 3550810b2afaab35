// Which time the plots show. Live, their right edge is now. Behind, the window stays and the playhead moves in it; only
// at its edges it takes the window along, so that moments can be compared. Pure: times are arguments, in µs.

export const WINDOWS_SECS = /** @type {const} */ ([10, 30, 60, 300, 600]);

const FIRST_SECS = 60;

/** "10 s", "5 min".
 *  @param {number} secs */
export const windowName = (secs) => (secs < 60 ? `${secs} s` : `${secs / 60} min`);

export class PlotWindow {
  #to = NaN;  // NaN: where now or the moment is
  secs = FIRST_SECS;

  /** Whether it is as long as in the beginning. */
  get isFirst() {
    return this.secs === FIRST_SECS;
  }

  /** @param {number} secs  one of WINDOWS_SECS */
  setSecs(secs) {
    this.secs = secs;
    this.#to = NaN;
  }

  /** @param {{moment: number, newest: number, isLive: boolean}} now
   *  @returns {{from: number, to: number}} */
  at({ moment, newest, isLive }) {
    const length = 1e6 * this.secs;
    if (isLive) this.#to = newest;
    else if (Number.isNaN(this.#to)) this.#to = Math.min(newest, moment + length / 2);
    else this.#to = Math.min(Math.max(this.#to, moment), moment + length);
    return { from: this.#to - length, to: this.#to };
  }
}
