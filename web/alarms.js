// The alarms of the server: those that are on or wait for being acknowledged, and what was.
import { readAlarmLog } from './messages.js';
import { ask, request } from './server_api.js';

/** @typedef {import('./messages.js').Alarm} Alarm
 *  @typedef {import('./messages.js').ShownAlarms} ShownAlarms */

const HEADERS = { 'Content-Type': 'application/json' };
const LEAST_PAUSE_MILLIS = 1000;  // between two requests for the log
const RECENT_MICROS = 600e6;

/** What is still to be acknowledged.
 *  @param {Alarm} alarm */
export const isNew = (alarm) => alarm.acknowledged === null;

export class Alarms {
  /** @type {ShownAlarms|null} */ #state = null;
  /** @type {Alarm[]} */ #log = [];  // newest first
  #wanted = '';  // of the log: changes when an alarm begins, is over or is acknowledged
  #loaded = '';
  #askedAt = -Infinity;

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
    const shown = this.#state?.shown ?? [];
    return [...shown.filter(isNew), ...shown.filter((alarm) => !isNew(alarm))];
  }

  /** How many are shown, also of those that are too many for a message. */
  get count() { return this.#state?.count ?? 0; }

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
    await request('api/v1/acknowledge', { method: 'POST', headers: HEADERS, body: JSON.stringify({ id }) });
  }
}
