// The former states that a viewer who plays holds, so that it asks the server twice a second and not for each of them.
// Pure; moments are in µs of the server's clock.

const RUN_MILLIS = 500;    // of playing, in one request
const EVERY_MILLIS = 12;   // of playing, between two states: more than 83 per second are not seen
const MOST_THINNED = 8;    // times that, on a slow connection

/** @typedef {import('./state_codec.js').FormerState} FormerState
 *  @typedef {import('./look_back.js').Run} Run */

export class HeldRun {
  /** @type {FormerState[]} */ #formers = [];  // oldest first
  #from = NaN;   // there are no other states from here
  #until = NaN;  // to here
  #shown = NaN;  // the last moment that was shown
  #thinned = 1;

  /** The state to be shown at a moment; null: another one has to be asked for.
   *  @param {number} micros
   *  @param {number} speed
   *  @returns {FormerState|null} */
  at(micros, speed) {
    if (!this.#isNear(micros, speed)) return null;
    this.#shown = micros;
    return this.#formers[this.#placeAt(micros)] ?? null;
  }

  /** What to ask for while this moment is shown; null: nothing yet. Elsewhere than in the run it is the moment alone, which
   *  comes at once; a run continues it.
   *  @param {number} micros
   *  @param {number} speed
   *  @returns {{micros: number}|Run|null} */
  next(micros, speed) {
    if (!this.#isNear(micros, speed)) return { micros };
    if (micros < (this.#from + this.#until) / 2) return null;
    const from = Math.max(micros, this.#until);
    return {
      micros: from, until_micros: from + lengthOf(speed), every_micros: Math.round(1000 * EVERY_MILLIS * speed * this.#thinned),
    };
  }

  /** @param {FormerState[]} formers  an answer; oldest first
   *  @param {number} from  the first moment asked for
   *  @param {number} until  up to when the answer is complete */
  add(formers, from, until) {
    const isNext = from >= this.#from && from <= this.#until;
    if (isNext) {
      const last = this.#formers.at(-1)?.stateNumber ?? -1;
      const used = this.#placeAt(this.#shown), kept = this.#formers.slice(used);
      if (used > 0) this.#from = kept[0].madeMicros;
      this.#formers = [...kept, ...formers.filter(({ stateNumber }) => stateNumber > last)];
    } else {
      this.#formers = formers;
      this.#from = from;
    }
    this.#until = until;
  }

  /** If the states of a run take long to come, the next one has fewer.
   *  @param {number} millis  that the run took longer than the quickest answer */
  setPace(millis) {
    if (millis > RUN_MILLIS / 2) this.#thinned = Math.min(MOST_THINNED, 2 * this.#thinned);
    else if (millis < RUN_MILLIS / 8) this.#thinned = Math.max(1, this.#thinned / 2);
  }

  /** Of the newest state at a moment; of the first one if all are newer.
   *  @param {number} micros */
  #placeAt(micros) {
    const after = this.#formers.findIndex(({ madeMicros }) => madeMicros > micros);
    return Math.max(0, (after === -1 ? this.#formers.length : after) - 1);
  }

  /** In the run, or so little after it that the next one may have it.
   *  @param {number} micros
   *  @param {number} speed */
  #isNear(micros, speed) {
    return micros >= this.#from && micros <= this.#until + lengthOf(speed);
  }
}

/** @param {number} speed */
const lengthOf = (speed) => Math.ceil(1000 * RUN_MILLIS * speed);
