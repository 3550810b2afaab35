// Estimate of the server's clock, and latencies measured with it. All times are in milliseconds and are passed as
// arguments.

const KEPT_PINGS = 16;

/** Estimates server time - browser time from pings. The recent ping with the shortest round trip is the most exact:
 *  its error is at most half the round trip. */
export class ServerClock {
  /** @type {{roundTrip: number, offset: number}[]} */
  #pings = [];

  /** @param {number} sentAt  browser clock
   *  @param {number} receivedAt  browser clock
   *  @param {number} serverAt  server's clock when it answered */
  addPing(sentAt, receivedAt, serverAt) {
    const roundTrip = receivedAt - sentAt;
    if (!(roundTrip >= 0)) return;
    this.#pings.push({ roundTrip, offset: serverAt - (sentAt + receivedAt) / 2 });
    if (this.#pings.length > KEPT_PINGS) this.#pings.shift();
  }

  /** Call after a reconnection: a restarted server has another clock. */
  reset() {
    this.#pings = [];
  }

  /** @returns {number|null} null before the first ping */
  get offset() {
    if (this.#pings.length === 0) return null;
    return this.#pings.reduce((best, ping) => (ping.roundTrip < best.roundTrip ? ping : best)).offset;
  }

  /** Server time at browser time `now`; null before the first ping.
   *  @param {number} now */
  at(now) {
    return this.offset === null ? null : now + this.offset;
  }
}

/** Median and 95th percentile of the values of the last `keptMillis`. */
export class RecentValues {
  /** @type {{at: number, value: number}[]} */
  #values = [];

  constructor(keptMillis = 5000) {
    this.keptMillis = keptMillis;
  }

  /** @param {number} value
   *  @param {number} now */
  add(value, now) {
    this.#values.push({ at: now, value });
    this.#forget(now);
  }

  clear() {
    this.#values = [];
  }

  /** @param {number} now
   *  @returns {{median: number, p95: number}|null} */
  summary(now) {
    this.#forget(now);
    if (this.#values.length === 0) return null;
    const sorted = this.#values.map(({ value }) => value).sort((a, b) => a - b);
    const at = (/** @type {number} */ share) =>
      sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
    return { median: at(0.5), p95: at(0.95) };
  }

  /** @param {number} now */
  #forget(now) {
    const first = this.#values.findIndex(({ at }) => now - at <= this.keptMillis);
    if (first !== 0) this.#values.splice(0, first === -1 ? this.#values.length : first);
  }
}
