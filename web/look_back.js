// Asks the server for former states, one at a time: the next one is asked for when the last has come, so a slow
// connection shows fewer moments and is never late.

const PATIENCE_MILLIS = 2000;  // then the answer is lost: the connection was interrupted

/** @typedef {{micros: number}|{number: number}} Wanted  a moment of the server's clock, or the number of a state */

export class LookBack {
  #id = 0;
  #askedAt = -Infinity;
  #isWaiting = false;
  /** @type {Wanted|null} */ #next = null;
  #isOff = true;

  /** @param {(command: object) => void} send */
  constructor(send) {
    this.send = send;
  }

  /** @param {Wanted} wanted
   *  @param {number} now */
  ask(wanted, now) {
    this.#isOff = false;
    this.#next = wanted;
    if (!this.#isWaiting || now - this.#askedAt > PATIENCE_MILLIS) this.#askNext(now);
  }

  /** Whether the answer is wanted still.
   *  @param {number} id
   *  @param {number} now */
  onAnswer(id, now) {
    if (id !== this.#id) return false;
    this.#isWaiting = false;
    if (this.#next !== null) this.#askNext(now);
    return !this.#isOff;
  }

  /** Answers that still come are of no use. */
  stop() {
    this.#isOff = true;
    this.#next = null;
  }

  /** @param {number} now */
  #askNext(now) {
    this.#id = (this.#id + 1) % 2 ** 32;
    this.send({ look: { id: this.#id, ...this.#next } });
    this.#next = null;
    this.#askedAt = now;
    this.#isWaiting = true;
  }
}
