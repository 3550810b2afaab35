// How the stream is: what the table "Stream" says, and when the lamp warns. What is over is over: only the last ten
// seconds warn, all before is history. Pure functions and one small state.
import { age, latency } from './format.js';

/** @typedef {import('./messages.js').StreamHealth} StreamHealth
 *  @typedef {import('./messages.js').StreamEvents} StreamEvents
 *  @typedef {import('./messages.js').NodeClock} NodeClock
 *  @typedef {{name: string, recent: string, all: string, last: string, isRecent: boolean}} Row  isRecent: a problem of
 *    the last 10 s */

/** Share of lost samples in 10 s above which a stream loses data. */
export const LOSING_FROM = 0.02;
const ON_MILLIS = 1000;   // a single burst raises no alarm
const OFF_MILLIS = 5000;  // and one that comes and goes stays one

/** Whether the stream loses data, with delays so that the lamp does not flicker. */
export class LossAlarm {
  isOn = false;
  /** @type {number|null} */ #since = null;  // the loss says otherwise

  /** @param {number|null} loss  share of the last 10 s; null: no samples
   *  @param {number} now  ms
   *  @returns {boolean} */
  update(loss, now) {
    const isLosing = loss !== null && loss > LOSING_FROM;
    if (isLosing === this.isOn) {
      this.#since = null;
      return this.isOn;
    }
    this.#since ??= now;
    if (now - this.#since >= (isLosing ? ON_MILLIS : OFF_MILLIS)) {
      this.isOn = isLosing;
      this.#since = null;
    }
    return this.isOn;
  }
}

/** 0.054 -> "5.4 %".
 *  @param {number|null} share */
export const lossText = (share) => (share === null ? '–' : `${(100 * share).toFixed(1)} %`);

/** Losses over hours are small: "0.027 %".
 *  @param {number|null} share */
const longLossText = (share) =>
  (share === null || share === 0 || share >= 0.001 ? lossText(share) : `${(100 * share).toPrecision(2)} %`);

/** 45678 -> "45\u2009678".
 *  @param {number} count */
export const countText = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, '\u2009');

/** @param {number|null} micros  of the server's clock; null: never
 *  @param {number|null} serverNow  ms; null: not known yet */
function agoText(micros, serverNow) {
  if (micros === null) return 'never';
  if (serverNow === null) return '–';
  const seconds = Math.max(0, Math.floor((serverNow - micros / 1000) / 1000));
  return `${seconds < 10 ? `${seconds} s` : age(seconds)} ago`;
}

/** @param {number|null} a
 *  @param {number|null} b */
const latestOf = (a, b) => (a === null || b === null ? a ?? b : Math.max(a, b));

/** @param {string} name
 *  @param {StreamEvents} events
 *  @param {number|null} serverNow
 *  @returns {Row} */
const eventRow = (name, events, serverNow) => ({
  name, recent: countText(events.count_10s), all: countText(events.count), last: agoText(events.last_micros, serverNow),
  isRecent: events.count_10s > 0,
});

/** 2980 -> "2.98 s".
 *  @param {number} millis */
function timeText(millis) {
  const size = Math.abs(millis);
  if (size < 999.5) return latency(size);
  return size < 120_000 ? `${(size / 1000).toFixed(2)} s` : age(size / 1000);
}

/** "2.98 s ± 1.2 ms behind", and "equal ± 1.2 ms" for a difference within the uncertainty.
 *  @param {number} millis  of a clock minus that of the server
 *  @param {number|null} uncertainty */
function offsetText(millis, uncertainty) {
  const within = uncertainty === null ? '' : ` ± ${timeText(uncertainty)}`;
  if (uncertainty !== null && Math.abs(millis) <= uncertainty) return `equal${within}`;
  return `${timeText(millis)}${within} ${millis < 0 ? 'behind' : 'ahead'}`;
}

/** @param {number} least  ms
 *  @param {number} most  ms */
function rangeText(least, most) {
  const from = timeText(least), to = timeText(most);
  const minus = least <= -0.05 ? '−' : '';
  return minus === '' && from === to ? from : `${minus}${from} to ${most <= -0.05 ? '−' : ''}${to}`;
}

/** @param {NodeClock} clock
 *  @returns {Row[]} */
function clockRows(clock) {
  const row = (/** @type {string} */ name, /** @type {string} */ recent, isRecent = false) =>
    ({ name, recent, all: '–', last: '–', isRecent });
  const differs = clock.warning !== '';
  if (clock.offset_ms === null || clock.delay_ms === null) {
    return [row(`Stamp to arrival, ${clock.node}`, rangeText(clock.lag_ms, clock.most_lag_ms), differs)];
  }
  return [
    row(`Clock of ${clock.node}`, offsetText(clock.offset_ms, clock.uncertainty_ms), differs),
    row(`Delay from ${clock.node}`, rangeText(clock.delay_ms, clock.most_delay_ms ?? clock.delay_ms)),
  ];
}

/** @param {StreamHealth} stream
 *  @param {number|null} ageMillis  of the newest sample; null: not known
 *  @param {number|null} serverNow  ms
 *  @param {string} [frame]  of ROS, in which the scene stands; '': without ROS
 *  @returns {Row[]} */
export function streamRows(stream, ageMillis, serverNow, frame = '') {
  const newestFirst = [...stream.rejected].sort((a, b) => (b.last_micros ?? 0) - (a.last_micros ?? 0));
  const refused = newestFirst.map((each) => eventRow(`Refused: ${each.reason}`, each, serverNow));
  const none = { name: 'Refused datagrams', recent: '0', all: '0', last: 'never', isRecent: false };
  return [
    {
      name: 'Loss', recent: lossText(stream.loss_10s), all: longLossText(stream.loss),
      last: agoText(latestOf(stream.gaps.last_micros, stream.incomplete.last_micros), serverNow),
      isRecent: (stream.loss_10s ?? 0) > LOSING_FROM,
    },
    eventRow('Gaps', stream.gaps, serverNow),
    eventRow('Incomplete', stream.incomplete, serverNow),
    { name: 'Jitter', recent: latency(stream.jitter_ms), all: '–', last: '–', isRecent: false },
    { name: 'Age', recent: ageMillis === null ? '–' : ageText(ageMillis), all: '–', last: '–', isRecent: false },
    ...(stream.clock_steps?.count ? [eventRow('Clock of the server set', stream.clock_steps, serverNow)] : []),
    ...stream.clocks.flatMap(clockRows),
    ...(refused.length > 0 ? refused : [none]),
    ...(frame === '' ? [] : [{ name: `Frame of the scene: ${frame}`, recent: '–', all: '–', last: '–', isRecent: false }]),
  ];
}

/** @param {StreamEvents|undefined} steps  of the server's clock
 *  @returns {string} what the banner says for ten seconds; '' */
export const clockStepsText = (steps) => (steps !== undefined && steps.count_10s > 0
  ? 'The clock of the server was set: samples and marks have the new time of day from now on' : '');

/** @param {number} millis */
const ageText = (millis) => (millis < 1000 ? latency(Math.max(0, millis)) : age(millis / 1000));

/** Of those that differ: "clock of /bridge_a 2.98 s behind".
 *  @param {NodeClock[]} clocks */
function clocksText(clocks) {
  const wrong = clocks.filter(({ warning }) => warning !== '');
  if (wrong.length === 0) return '';
  const [{ node, offset_ms: offset, lag_ms: lag, excess_ms: excess }] = wrong;
  if (wrong.length > 1) return `${wrong.length} clocks differ`;
  // Of stamps alone, it may be the network.
  if (offset === null) return `stamps of ${node} ${offsetText(-lag, null)}`;
  return `clock of ${node} ${offsetText(offset, null)}${excess > 0 ? ', its stamps slowed down' : ''}`;
}

/** In one line: "0.0 % lost · jitter 0.8 ms".
 *  @param {StreamHealth} stream */
export function streamLine(stream) {
  const refused = stream.rejected.reduce((sum, each) => sum + each.count_10s, 0);
  return [
    stream.loss_10s === null ? 'no samples in 10 s' : `${lossText(stream.loss_10s)} lost`,
    stream.jitter_ms === null ? '' : `jitter ${latency(stream.jitter_ms)}`,
    refused > 0 ? `${countText(refused)} refused` : '',
    clocksText(stream.clocks),
  ].filter(Boolean).join(' · ');
}
