// The alarms of the server: those that are on or wait for being acknowledged, and what was.
import { readAlarmLog } from './messages.js';
import { ask, request } from './server_api.js';

/** @typedef {import('./messages.js').Alarm} Alarm
 *  @typedef {import('./messages.js').ShownAlarms} ShownAlarms */

const HEADERS = { 'Content-Type': 'application/json' };
const LEAST_PAUSE_MILLIS = 1000;  // between two requests for the log
const RECENT_MICROS = 600e6;
const SERVER_LOST_SECS = 2;  // without a connection
export const SERVER_LOST = 0;  // the id of that alarm, which is this page's own: a server counts from 1

/** @param {number} secs  since it does not answer
 *  @param {number} micros  of its clock, when it last did
 *  @returns {Alarm} */
const serverLost = (secs, micros) => ({
  id: SERVER_LOST, rule: 'seen by this page', priority: 'high', quantity: 'server', unit: 's', limit: SERVER_LOST_SECS,
  person: null, name: '', joint: null, value: secs, worst: secs, times: 1, began: { state: 0, micros, stamp_micros: 0 },
  over: null, is_on: true, is_shown: true, acknowledged: null,
});

/** What is still to be acknowledged.
 *  @param {Alarm} alarm */
export const isNew = (alarm) => alarm.acknowledged === null;

export class Alarms {
  /** @type {ShownAlarms|null} */ #state = null;
  /** @type {Alarm[]} */ #log = [];  // newest first
  #wanted = '';  // of the log: changes when an alarm begins, is over or is acknowledged
  #loaded = '';
  #askedAt = -Infinity;
  /** @type {number|null} */ #goneAt = null;  // browser's clock, ms
  /** @type {Alarm|null} */ #serverLost = null;

  /** Without a connection, no alarm of the server can come.
   *  @param {boolean} isConnected  or has not been yet
   *  @param {number} now  browser's clock, ms
   *  @param {number} micros  of the server's clock, of what came last */
  setConnected(isConnected, now, micros) {
    this.#goneAt = isConnected ? null : this.#goneAt ?? now;
    const secs = this.#goneAt === null ? 0 : (now - this.#goneAt) / 1000;
    if (secs < SERVER_LOST_SECS) this.#serverLost = null;
    else this.#serverLost = { ...serverLost(secs, micros), acknowledged: this.#serverLost?.acknowledged ?? null };
  }

  /** Whether the server tells them now. */
  get isCurrent() { return this.#goneAt === null; }

  /** @param {ShownAlarms} state */
  set(state) {
    this.#state = state;
    const { last, shown } = state;
    this.#wanted = JSON.stringify([last, ...shown].map((alarm) => alarm && [alarm.id, alarm.is_on, alarm.times, !isNew(alarm)]));
  }

  /** Whether the server has told them: an older one has none.
   *  @returns {boolean} */
  get isKnown() { return this.#state !== null; }

  /** Whether what the server has told is here, the log included. */
  get isComplete() { return this.isKnown && this.#wanted === this.#loaded; }

  /** Highest priority first; those that are not acknowledged before the others.
   *  @returns {Alarm[]} */
  get shown() {
    const shown = [...this.#serverLost === null ? [] : [this.#serverLost], ...this.#state?.shown ?? []];
    return [...shown.filter(isNew), ...shown.filter((alarm) => !isNew(alarm))];
  }

  /** How many are shown, also of those that are too many for a message. */
  get count() { return (this.#state?.count ?? 0) + (this.#serverLost === null ? 0 : 1); }

  /** The one that began last; null: there was none. */
  get last() { return this.#state?.last ?? null; }

  /** Newest first; those that are shown are as they are now.
   *  @returns {Alarm[]} */
  log() {
    const now = new Map(this.shown.map((alarm) => [alarm.id, alarm]));
    return this.#log.map((alarm) => now.get(alarm.id) ?? alarm);
  }

  /** How many began in the ten minutes before a moment.
   *  @param {number} micros  of the server's clock */
  countBefore(micros) {
    return this.#log.filter(({ began }) => began.micros > micros - RECENT_MICROS).length;
  }

  /** Of another server the log is another one, although its alarms may look the same. */
  forget() {
    this.#loaded = '';
  }

  /** Loads the log if it has changed; call it several times a second.
   *  @param {number} now  ms
   *  @returns {Promise<void>} */
  async update(now) {
    if (this.#wanted === this.#loaded || now - this.#askedAt < LEAST_PAUSE_MILLIS) return;
    this.#askedAt = now;
    const wanted = this.#wanted;
    const answer = await ask('api/v1/alarms', readAlarmLog);
    if (answer === null) return;
    this.#log = answer.alarms;
    this.#loaded = wanted;
  }

  /** @param {Alarm} alarm
   *  @throws {Error} with the reason if the server refuses */
  async acknowledge({ id }) {
    if (id === SERVER_LOST) {
      if (this.#serverLost) this.#serverLost.acknowledged = { role: 'this page', micros: this.#serverLost.began.micros };
      return;
    }
    await request('api/v1/acknowledge', { method: 'POST', headers: HEADERS, body: JSON.stringify({ id }) });
  }
}
