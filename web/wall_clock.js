// Relates the moments of the server's history to times of day. For a live stream, these are times of the viewer's clock, as
// in the header of the page: pings tell how long ago a moment was, also after the stream has stopped, and all times follow
// when that clock is set. For a recording, they are its stamps: when the server played it, or when it was recorded with
// `serve --stop_at`, whose page is the same in each run. Pure: times are arguments.
import { runs } from './state_codec.js';

const STEADY_MILLIS = 10;  // about a pixel of the strip; pings and delays of states differ by less most of the time

/** @typedef {{newest: import('./state_codec.js').State|null, recording: import('./messages.js').Recording|null,
 *    serverMillis: number|null, wallMillis: number}} Known
 *    newest: the newest state; recording: null while the stream is live; serverMillis: now, by the server's clock, null before
 *    its first answer; wallMillis: now, as Date has it */

export class WallClock {
  #offset = NaN;  // from the server's clock to the time of day, ms

  /** Call it several times a second.
   *  @param {Known} known */
  update(known) {
    const offset = known.recording === null ? offsetNow(known) : offsetOfStamps(known.recording, known.newest);
    if (offset === null || Math.abs(offset - this.#offset) < STEADY_MILLIS) return;
    this.#offset = offset;
  }

  /** @param {number} micros  a moment of the server's clock
   *  @returns {number}  ms, as Date has it; NaN: not known yet */
  at(micros) {
    return micros / 1000 + this.#offset;
  }
}

/** @param {Known} known */
const offsetNow = ({ serverMillis, wallMillis }) => (serverMillis === null ? null : wallMillis - serverMillis);

/** @param {import('./messages.js').Recording} recording
 *  @param {Known['newest']} newest
 *  @returns {number|null} */
function offsetOfStamps({ ended_micros: endedMicros }, newest) {
  if (newest === null || newest.stampMicros === 0) return null;
  // The state that says that it is over is made later than its last sample was played.
  const playedMicros = endedMicros ?? (runs(newest) ? newest.madeMicros : null);
  return playedMicros === null ? null : (newest.stampMicros - playedMicros) / 1000;
}
