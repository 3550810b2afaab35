// How finely the view is drawn: reduced while the machine cannot keep up, and whole again when it can.

const SLOW_FRAME_MILLIS = 34;  // a view at 30 pictures a second is not slow
const QUICK_FRAME_MILLIS = 20;
const FRAMES_MEASURED = 24;
const MEASURED_MILLIS = 1500, LEAST_FRAMES = 5;  // a very slow view is not watched for 24 frames
const HIDDEN_MILLIS = 2000;  // between two frames: the view was hidden, not slow
const MOST_REDUCTIONS = 3;
const FIRST_PATIENCE = 5;  // quick measurements before the next level is tried again
const MOST_PATIENCE = 320;
/** A view that has not changed for so long is drawn as finely as it can be, ms. */
export const REST_MILLIS = 300;

export class Quality {
  #reductions = 0;
  #frameMillis = /** @type {number[]} */ ([]);
  #measuredMillis = 0;
  #quickMeasurements = 0;
  #patience = FIRST_PATIENCE;
  #isFixed;

  /** @param {boolean} isFixed  never reduced */
  constructor(isFixed) { this.#isFixed = isFixed; }

  /** Of a view that changes: 0 to 3. */
  get reductions() { return this.#reductions; }

  /** @param {number} elapsed  since the last frame, ms */
  measure(elapsed) {
    if (this.#isFixed || elapsed >= HIDDEN_MILLIS) return;
    this.#frameMillis.push(elapsed);
    this.#measuredMillis += elapsed;
    const count = this.#frameMillis.length;
    if (count < FRAMES_MEASURED && (count < LEAST_FRAMES || this.#measuredMillis < MEASURED_MILLIS)) return;
    const median = this.#frameMillis.sort((a, b) => a - b)[Math.floor(count / 2)];
    this.#frameMillis = [];
    this.#measuredMillis = 0;
    this.#quickMeasurements = median <= QUICK_FRAME_MILLIS ? this.#quickMeasurements + 1 : 0;
    if (median >= SLOW_FRAME_MILLIS && this.#reductions < MOST_REDUCTIONS) {
      this.#reductions += 1;
    } else if (this.#reductions > 0 && this.#quickMeasurements >= this.#patience) {
      this.#reductions -= 1;
      this.#quickMeasurements = 0;
      this.#patience = Math.min(4 * this.#patience, MOST_PATIENCE);  // it may well be too much again
    }
  }
}
