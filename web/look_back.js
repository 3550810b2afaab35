// Asks the server for former states. One moment at a time: the next one is asked for when the last has come, so a slow
// connection shows fewer moments and is never late. A viewer who plays asks for runs of states; a single moment, such as
// that of a slider, does not wait for a run.

const PATIENCE_MILLIS = 2000;  // then the answer is lost: the connection was interrupted

/** @typedef {{micros: number}|{number: number}} Moment  of the server's clock, or the number of a state
 *  @typedef {{micros: number, until_micros: number, every_micros: number}} Run  the states from one moment to another, with
 *    at least so much time between them
 *  @typedef {{wanted: Moment|Run, tookMillis: number, leastMillis: number}} Answered  leastMillis: that any answer took */

export class LookBack {
  #id = 0;
  #askedAt = -Infinity;
  /** @type {Moment|Run|null} */ #asked = null;  // under way
  /** @type {Moment|null} */ #next = null;
  #leastMillis = Infinity;
  #isOff = true;

  /** @param {(command: object) => void} send */
  constructor(send) {
    this.send = send;
  }

  /** @param {Moment} wanted
   *  @param {number} now */
  ask(wanted, now) {
    this.#isOff = false;
    if (this.#isWaiting(now) && !this.#isForRun) this.#next = wanted;
    else this.#send(wanted, now);
  }

  /** Does nothing while an answer is under way.
   *  @param {Run} run
   *  @param {number} now */
  askRun(run, now) {
    this.#isOff = false;
    if (!this.#isWaiting(now)) this.#send(run, now);
  }

  /** What is answered; null: it is not wanted any longer.
   *  @param {number} id
   *  @param {number} now
   *  @returns {Answered|null} */
  onAnswer(id, now) {
    const wanted = this.#asked;
    if (id !== this.#id || wanted === null) return null;
    const tookMillis = now - this.#askedAt;
    this.#leastMillis = Math.min(this.#leastMillis, tookMillis);
    this.#asked = null;
    if (this.#next !== null) this.#send(this.#next, now);
    return this.#isOff ? null : { wanted, tookMillis, leastMillis: this.#leastMillis };
  }

  /** Answers that still come are of no use. */
  stop() {
    this.#isOff = true;
    this.#next = null;
  }

  /** After a new connection, no answer of an earlier one comes. */
  onConnected() {
    this.#asked = null;
    this.#next = null;
    this.#leastMillis = Infinity;
  }

  /** Whether no answer is under way. */
  get isIdle() {
    return this.#asked === null;
  }

  get #isForRun() {
    return this.#asked !== null && 'until_micros' in this.#asked;
  }

  /** @param {number} now */
  #isWaiting(now) {
    return this.#asked !== null && now - this.#askedAt <= PATIENCE_MILLIS;
  }

  /** @param {Moment|Run} wanted
   *  @param {number} now */
  #send(wanted, now) {
    this.#id = (this.#id + 1) % 2 ** 32;
    this.send({ look: { id: this.#id, ...wanted } });
    this.#next = null;
    this.#asked = wanted;
    this.#askedAt = now;
  }
}
