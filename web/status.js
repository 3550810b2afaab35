// The status indicator. One pure function decides, from the newest state and from the connection: a page without a
// connection must not show "live" any longer.
import { age, lag, place } from './format.js';
import { lossText } from './stream_health.js';

/** Time without a message after which the server counts as disconnected: several times kHeartbeat of
 *  server/http/hub.h. */
export const SILENCE_MILLIS = 1500;
/** Age from which a sample counts as stale, even if the server reports it as live: the server does not respond. */
export const OLD_MILLIS = 2000;

/** Time that a sample waited in the server's machine from which on the server is overloaded: kOverloadNanos of
 *  core/scene_state.h. */
export const BEHIND_MILLIS = 250;

/** @typedef {'live'|'losing'|'recording'|'behind'|'stale'|'no-data'|'disconnected'|'wait'} Level
 *  @typedef {{level: Level, word: string, note: string, banner: string}} StreamStatus  note: the second line of the lamp,
 *    what the word is about; banner "": none
 *  @typedef {StreamStatus & {isFresh: boolean}} Status  isFresh: the newest sample is of now
 *  @typedef {{connected: boolean, everConnected: boolean, silentMillis: number,
 *    liveness: 'no data'|'live'|'stale'|'no person'|null, ageMillis: number|null, waitedMillis: number,
 *    source: string, reason: string, behindMillis?: number|null, isGone?: boolean, loss?: number|null, isLosing?: boolean,
 *    recording?: import('./messages.js').Recording|null, stampMicros?: number}} Situation  reason: why the server
 *    rejected the connection; "" otherwise; behindMillis: by which the viewer looks back; null or absent: not; isGone: the
 *    moment that the viewer wants to see is no longer kept; loss: share of the samples lost or incomplete in the last 10 s, null or
 *    absent: not known; isLosing: too many; recording: null or absent: the stream is live; stampMicros: of the sample on
 *    the screen
 */

/** Of a viewer who looks back, the word says so, and the banner what is wrong with the live stream.
 *  @param {Situation} now
 *  @returns {Status} */
export function statusOf(now) {
  const stream = streamStatusOf(now), isFresh = stream.level === 'live' || stream.level === 'losing';
  const isBehind = now.behindMillis !== undefined && now.behindMillis !== null;
  const hasEnded = stream.level === 'stale' && (now.recording?.ended_micros ?? null) !== null;
  if (now.recording && (isFresh || isBehind || hasEnded)) return { ...recordingStatusOf(now, stream), isFresh };
  if (!isBehind || stream.level === 'wait') return { ...stream, isFresh };
  const trouble = isFresh ? goneText(now) : `Live stream: ${stream.word}. ${stream.banner}`;
  const note = stream.level === 'live' ? 'Esc returns to live' : `live stream: ${stream.word}`;
  return { level: 'behind', word: `Behind ${lag(now.behindMillis ?? 0)}`, note, banner: trouble, isFresh };
}

/** @param {Situation} now */
const goneText = (now) => (now.isGone ? 'This moment is no longer kept: you see the oldest one' : '');

/** A recording is never live. At its end, it is no trouble that no more samples come.
 *  @param {Situation} now
 *  @param {StreamStatus} stream
 *  @returns {StreamStatus} */
function recordingStatusOf(now, stream) {
  const { recording, stampMicros = 0 } = now;
  const length = recording?.length_secs ?? null;
  const word = `Recording ${place(placeIn(recording, stampMicros))}${length === null ? '' : ` of ${place(length, 0)}`}`;
  const isOver = recording?.ended_micros !== null && now.connected && now.silentMillis <= SILENCE_MILLIS;
  const isGood = stream.level === 'live' || stream.level === 'losing';
  const trouble = isGood || isOver ? goneText(now) : `${stream.word}. ${stream.banner}`;
  const note = stream.level === 'losing' ? stream.word : isOver && (now.behindMillis ?? 0) === 0 ? 'ended'
    : now.behindMillis === undefined || now.behindMillis === null ? 'plays' : `${lag(now.behindMillis)} from its newest sample`;
  return { level: 'recording', word, note, banner: trouble };
}

/** @param {import('./messages.js').Recording|null|undefined} recording
 *  @param {number} stampMicros  of a sample
 *  @returns {number} s from the beginning of the recording */
export function placeIn(recording, stampMicros) {
  if (!recording) return 0;
  const seconds = Math.max(0, (stampMicros - recording.start_micros) / 1e6);
  return recording.round_secs ? seconds % recording.round_secs : seconds;
}

/** @param {Situation} now
 *  @returns {StreamStatus} */
function streamStatusOf(now) {
  if (!now.connected || now.silentMillis > SILENCE_MILLIS) return disconnected(now);
  if (now.liveness === null) return { level: 'wait', word: 'Connecting', note: 'to the server', banner: '' };
  if (now.liveness === 'no data') {
    const source = now.source || 'the source';
    return { level: 'no-data', word: 'No data', note: 'waiting for the first sample', banner: `Waiting for ${source}` };
  }
  if (now.liveness === 'live' && now.waitedMillis > BEHIND_MILLIS) {
    const banner = `The server is too busy: behind by ${age(now.waitedMillis / 1000)}`;
    return { level: 'stale', word: 'Overloaded', note: 'the server is too busy', banner };
  }
  const isOld = now.ageMillis !== null && now.ageMillis > OLD_MILLIS;
  if (now.liveness === 'stale' || isOld) {
    const since = now.ageMillis === null ? '' : `: last sample received ${age(now.ageMillis / 1000)} ago`;
    return { level: 'stale', word: 'Stale', note: 'the stream has stopped', banner: `The stream has stopped${since}` };
  }
  if (now.liveness === 'no person') return { level: 'live', word: 'Live', note: 'no person', banner: '' };
  const loss = now.loss ?? null;
  if (now.isLosing && loss !== null) {
    return { level: 'losing', word: `Losing data ${lossText(loss)}`, note: 'lost or incomplete in 10 s', banner: '' };
  }
  const note = loss === null ? 'the newest sample' : `${lossText(loss)} lost or incomplete`;
  return { level: 'live', word: 'Live', note, banner: '' };
}

/** @param {import('./messages.js').LeftOut} person */
export const nameOfLeftOut = ({ name, character }) => name || `Character ${character}`;

/** What the banner says about people who are not shown; '' without any. The problems list each of them.
 *  @param {import('./messages.js').LeftOut[]} people */
export function leftOutText(people) {
  if (people.length === 0) return '';
  const who = people.length === 1 ? `${nameOfLeftOut(people[0])} is` : `${people.length} people are`;
  return `${who} left out: ${people[0].reason}`;
}

/** @param {Situation} now
 *  @returns {StreamStatus} */
function disconnected(now) {
  if (now.reason) return { level: 'disconnected', word: 'Rejected', note: 'by the server', banner: now.reason };
  if (!now.everConnected) return { level: 'wait', word: 'Connecting', note: 'to the server', banner: 'Connecting to the server' };
  return {
    level: 'disconnected',
    word: 'Disconnected',
    note: 'trying again',
    banner: 'No connection to the server; reconnecting',
  };
}
