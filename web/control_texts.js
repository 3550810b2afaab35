// Texts of the controls. Pure functions.
import { place } from './format.js';

/** 3400000 -> "3.4 MB".
 *  @param {number} bytes */
export function size(bytes) {
  const units = ['kB', 'MB', 'GB', 'TB'];
  let value = bytes / 1000, unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${value < 10 ? value.toFixed(1) : Math.round(value)} ${units[unit]}`;
}

/** 5400 -> "1 h 30 min".
 *  @param {number} seconds */
export function duration(seconds) {
  if (seconds < 120) return `${Math.floor(seconds)} s`;
  const minutes = Math.floor(seconds / 60);
  if (minutes < 120) return `${minutes} min`;
  const hours = Math.floor(minutes / 60);
  if (hours < 48) return minutes % 60 > 0 ? `${hours} h ${minutes % 60} min` : `${hours} h`;
  return `${Math.floor(hours / 24)} days`;
}

/** @param {import('./control_messages.js').RecordingState} now
 *  @returns {string} what is recorded, and how long it can go on */
export function recordingText(now) {
  if (now.why_not !== '') return `Not possible: ${now.why_not}`;
  const free = now.free_bytes === null ? '' : `${size(now.free_bytes)} free`;
  const left = now.secs_left === null ? '' : `, enough for ${duration(now.secs_left)} of this stream`;
  const lost = now.dropped > 0 ? `; ${now.dropped} datagrams not recorded: the disk is too slow` : '';
  if (now.state === 'on') return `Recording ${now.file}: ${place(now.secs, 0)}, ${size(now.bytes)}${lost}; ${free}${left}`;
  if (now.state === 'saving') return `Saving ${now.file} …`;
  const last = now.file === '' ? '' : now.problem === ''
    ? `Saved ${now.file}: ${place(now.secs)}, ${size(now.bytes)}${lost}. ` : `${now.file}: ${now.problem}. `;
  return `${last}${free}${left}`;
}

const ORIGIN_TEXTS = {
  operator: 'set by an operator', option: 'set at the start', assumed: 'assumed', stream: 'from the stream',
  poses: 'measured in the poses', bridge: 'as the node of the suit was told',
};

/** @param {import('./control_messages.js').Origin} origin */
export const originText = (origin) => ORIGIN_TEXTS[origin];

/** @param {import('./control_messages.js').ControlledPerson} person
 *  @returns {string} where its stature comes from */
export function heightText({ height_m: { value, from, stated } }) {
  if (stated !== null && from !== 'operator') return `as stated; the lengths ${originText(from)} give ${value.toFixed(2)} m`;
  return originText(from);
}

/** @param {import('./control_messages.js').Hands} hands
 *  @returns {string} what is held, since when */
export function handsText(hands) {
  const kilograms = (/** @type {number} */ mass) => `${Number(mass.toFixed(2))} kg`;
  const parts = [
    hands.right_kg > 0 ? `${kilograms(hands.right_kg)} right` : '',
    hands.left_kg > 0 ? `${kilograms(hands.left_kg)} left` : '',
    hands.both_kg > 0 ? `${kilograms(hands.both_kg)} in both hands` : '',
  ].filter(Boolean);
  const what = !hands.is_known ? 'not known' : parts.length > 0 ? parts.join(', ') : 'nothing';
  if (hands.since_micros === null) return `Held now: ${what} (as the node of the suit was told)`;
  return `Held now: ${what}, since ${clock(hands.since_micros)} (${hands.by})`;
}

/** @param {number} micros  since 1970
 *  @returns {string} on this machine's clock */
export const clock = (micros) => new Date(micros / 1000).toLocaleTimeString('en-GB');

/** The number of the next trial of this person in this condition.
 *  @param {readonly import('./control_messages.js').Trial[]} trials
 *  @param {string} person
 *  @param {string} condition */
export const nextNumber = (trials, person, condition) => 1 + Math.max(0, ...trials
  .filter((trial) => trial.person === person && trial.condition === condition).map((trial) => trial.number));

/** @param {import('./control_messages.js').Trial} trial */
export const trialTitle = (trial) => `${trial.person} · ${trial.condition} · trial ${trial.number}`;

/** @param {import('./control_messages.js').Job} job */
export const jobText = ({ state, progress, problem }) => (state === 'making' && progress > 0
  ? `${Math.round(100 * progress)} %` : state === 'failed' ? problem : state);
