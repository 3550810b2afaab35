// Texts of the header about the stream, and next to the view about one person. Pure functions.
import { centimetres, kilonewtons, latency, rate, timeCode } from './format.js';
import { handLoadText } from './hand_load.js';

/** @typedef {import('./state_codec.js').State} State
 *  @typedef {import('./state_codec.js').Person} Person
 *  @typedef {import('./messages.js').PersonDetails} PersonDetails
 *  @typedef {{hint: string, isDoubtful: boolean, com: string, cop: string, support: string,
 *    compression: string}} Readings  isDoubtful: the hint is highlighted as a warning; compression "": unknown */

/** @param {State|null} state  the newest one
 *  @param {{median: number, p95: number}|null} latencies  ms; null: unknown
 *  @param {boolean} isLive */
export function streamReadingsOf(state, latencies, isLive) {
  const hasTime = state !== null && state.liveness !== 'no data', hasSample = hasTime && state.liveness !== 'no person';
  return {
    rate: isLive && state ? rate(state.rateHz) : '–',
    latency: latency(latencies?.median ?? null),
    latencyP95: latencies ? `p95 ${latency(latencies.p95)}` : '',
    sample: hasSample ? String(state.counter) : '–',
    timeCode: hasTime ? timeCode(state.timeCodeMillis) : '–',
    viewers: state ? `${state.viewers} ${state.viewers === 1 ? 'viewer' : 'viewers'}` : '',
  };
}

/** @param {number} count  of meshes that could not be loaded
 *  @returns {string} "" for none */
export function meshesText(count) {
  if (count === 0) return '';
  return `${count} ${count === 1 ? 'mesh' : 'meshes'} of the body model could not be loaded`;
}

/** @param {Person|undefined} person  of the newest state
 *  @param {PersonDetails|undefined} details  of the same character; they arrive separately from the state, and later
 *  @param {boolean} isLive
 *  @returns {Readings} */
export function readingsOf(person, details, isLive) {
  if (!person) {
    return { hint: '', isDoubtful: false, com: 'Centre of mass', cop: 'Centre of pressure',
      support: 'Support polygon', compression: '' };
  }
  return {
    hint: loadsHint(person, details),
    isDoubtful: details?.mass_is_assumed === true || person.comDisagrees,
    com: comText(person),
    cop: copText(person, details),
    support: isLive && Number.isFinite(person.margin)
      ? `Margin of stability ${centimetres(person.margin)}` : 'Support polygon',
    compression: isLive && Number.isFinite(person.compression)
      ? `L5/S1 compression ${kilonewtons(person.compression)}` : '',
  };
}

/** Load metric, and the assumptions behind the loads.
 *  @param {Person} person
 *  @param {PersonDetails|undefined} details */
export function loadsHint(person, details) {
  const motion = person.metric === 'external' ? '' : person.isDynamic ? ', dynamic' : ', static';
  return [
    `load metric: ${person.metric}${motion}`,
    details && details.delay_secs > 0 ? `${Math.round(1000 * details.delay_secs)} ms late (${details.filter} filter)` : '',
    floorText(details),
    details?.mass_is_assumed ? `body mass assumed: ${details.mass_kg} kg` : '',
    handLoadText(details?.hand_load),
    person.comDisagrees ? `centre of mass differs from MVN by ${centimetres(person.comMinusMvn)}` : '',
    details?.why_other_metric ?? '',
  ].filter(Boolean).join(' · ');
}

/** @param {PersonDetails|undefined} details */
function floorText(details) {
  if (!details) return '';
  return details.floor_z_m === null ? 'floor not found' : `floor at z = ${details.floor_z_m.toFixed(2)} m`;
}

/** @param {Person} person */
export const comText = (person) => (person.comSource === 'body_model' ? 'Centre of mass (body model)' : 'Centre of mass');

/** @param {Person} person
 *  @param {PersonDetails|undefined} details */
export function copText(person, details) {
  if (person.cop) return person.groundIsMeasured ? 'Centre of pressure (measured)' : 'Centre of pressure';
  return `Centre of pressure: ${details?.why_no_ground || 'unknown'}`;
}
