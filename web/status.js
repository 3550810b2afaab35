// The status indicator. One pure function decides, from the newest state and from the connection: a page without a
// connection must not show "live" any longer.
import { age, lag } from './format.js';
import { lossText } from './stream_health.js';

/** Time without a message after which the server counts as disconnected: several times kHeartbeat of
 *  server/http/hub.h. */
export const SILENCE_MILLIS = 1500;
/** Age from which a sample counts as stale, even if the server reports it as live: the server does not respond. */
export const OLD_MILLIS = 2000;

/** Time that a sample waited in the server's machine from which on the server is overloaded: kOverloadNanos of
 *  core/scene_state.h. */
export const BEHIND_MILLIS = 250;

/** @typedef {'live'|'losing'|'behind'|'stale'|'no-data'|'disconnected'|'wait'} Level
 *  @typedef {{level: Level, word: string, note: string, banner: string}} Status  note: the second line of the lamp, what
 *    the word is about; banner "": none
 *  @typedef {{connected: boolean, everConnected: boolean, silentMillis: number,
 *    liveness: 'no data'|'live'|'stale'|null, ageMillis: number|null, waitedMillis: number,
 *    source: string, reason: string, behindMillis?: number|null, isGone?: boolean,
 *    loss?: number|null, isLosing?: boolean}} Situation  reason: why the server rejected the
 *    connection; "" otherwise; behindMillis: by which the viewer looks back; null or absent: not; isGone: the moment
 *    that the viewer wants to see is no longer kept; loss: share of the samples lost in the last 10 s, null or
 *    absent: not known; isLosing: too many
 */

/** Whether the newest sample is shown, and is new.
 *  @param {Level|undefined} level */
export const showsLive = (level) => level === 'live' || level === 'losing';

/** Of a viewer who looks back, the word says so, and the banner what is wrong with the live stream.
 *  @param {Situation} now
 *  @returns {Status} */
export function statusOf(now) {
  const live = streamStatusOf(now);
  if (now.behindMillis === undefined || now.behindMillis === null || live.level === 'wait') return live;
  const gone = now.isGone ? 'This moment is no longer kept: you see the oldest one' : '';
  const trouble = showsLive(live.level) ? gone : `Live stream: ${live.word}. ${live.banner}`;
  const note = live.level === 'live' ? 'Esc returns to live' : `live stream: ${live.word}`;
  return { level: 'behind', word: `Behind ${lag(now.behindMillis)}`, note, banner: trouble };
}

/** @param {Situation} now
 *  @returns {Status} */
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
  const loss = now.loss ?? null;
  if (now.isLosing && loss !== null) {
    return { level: 'losing', word: `Losing data ${lossText(loss)}`, note: 'lost in the last 10 s', banner: '' };
  }
  const note = loss === null ? 'the newest sample' : `${lossText(loss)} lost in the last 10 s`;
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
 *  @returns {Status} */
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
