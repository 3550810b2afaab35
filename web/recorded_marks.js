// Marks of a recording that were set while an earlier server played it. The moments of that server are gone; the time code
// of a sample is the same each time that its recording is played. Pure functions.
import { placeIn } from './status.js';

const TOLERANCE_SECS = 0.02;
const FASTEST_HZ = 240;  // of suits
const DRIFT_MICROS = 5000, MOST_LATE_MICROS = 100_000;

/** @typedef {import('./messages.js').Mark} Mark
 *  @typedef {{recording: import('./messages.js').Recording, stampMicros: number, madeMicros: number, timeCodeMillis: number,
 *    rateHz: number}} Anchor  the recording and one of the samples that this server has played of it */

/** Null: it is of another recording, or this one has no time codes.
 *  @param {Mark['at']} at
 *  @param {Anchor} anchor
 *  @returns {Mark['at']|null} */
function momentIn(at, { recording, stampMicros, madeMicros, timeCodeMillis, rateHz }) {
  const placeOfAnchor = placeIn(recording, stampMicros);
  if (timeCodeMillis === 0 && placeOfAnchor > TOLERANCE_SECS) return null;
  const place = placeOfAnchor + (at.time_code_millis - timeCodeMillis) / 1000;
  if (place < -TOLERANCE_SECS || place > (recording.length_secs ?? Infinity) + TOLERANCE_SECS) return null;
  let secs = place - placeOfAnchor;
  if (secs > TOLERANCE_SECS && recording.round_secs) secs -= recording.round_secs;  // of the round before
  const half = 0.5e6 / (rateHz > 0 ? rateHz : FASTEST_HZ);  // samples do not become states at even times
  return { ...at, stamp_micros: Math.round(stampMicros + 1e6 * secs), micros: Math.round(madeMicros + 1e6 * secs + half) };
}

/** The mark where this server plays it; null: it does not.
 *  @param {Mark} mark
 *  @param {Anchor} anchor
 *  @returns {Mark|null} */
export function placedIn(mark, anchor) {
  const at = momentIn(mark.at, anchor), end = mark.end && momentIn(mark.end, anchor);
  return at === null || (mark.end !== null && end === null) ? null : { ...mark, at, end };
}

/** Whether marks have about the same places by both. States are made late, never early: by the least delay, places are best.
 *  @param {Anchor|null} before
 *  @param {Anchor|null} now */
export function areAlike(before, now) {
  if (before === null || now === null) return before === now;
  const delayOf = (/** @type {Anchor} */ { madeMicros, stampMicros }) => madeMicros - stampMicros;
  const codeOf = (/** @type {Anchor} */ { stampMicros, timeCodeMillis }) => stampMicros - 1000 * timeCodeMillis;
  const later = delayOf(now) - delayOf(before);
  return before.recording.length_secs === now.recording.length_secs && Math.abs(codeOf(now) - codeOf(before)) < DRIFT_MICROS
    && later > -DRIFT_MICROS && later < MOST_LATE_MICROS;
}
