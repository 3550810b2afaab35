// Alarms in words. Pure functions.
import { age } from './format.js';

/** @typedef {import('./messages.js').Alarm} Alarm */

const STARS = { high: '***', medium: '**', low: '*' };
/** By priority, as monitors in hospitals write it. */
export const stars = (/** @type {Alarm} */ { priority }) => STARS[priority];

/** @param {Alarm['value']} value
 *  @param {Alarm} alarm  whose it is */
export function valueText(value, { quantity, unit }) {
  if (typeof value !== 'number') return value ?? '';
  if (unit === 'N') return `${(value / 1000).toFixed(2)} kN`;
  if (unit === 'm') return `${(100 * value).toFixed(1).replace('-', '−')} cm`;
  if (unit === 's') return age(value);
  return quantity === 'loss' ? `${(100 * value).toFixed(1)} %` : `${Math.round(100 * value)} %`;
}

/** What is wrong, without whose and how much. @type {Record<string, string>} */
const QUANTITIES = {
  ratio: 'load', class: 'load class', exposure: 'of the time', compression: 'compression', margin: 'margin', loss: 'of the samples lost',
};

/** "Anna 3.72 kN compression": the least useful word is last, so that it is what a narrow page cuts.
 *  @param {Alarm} alarm
 *  @param {(name: string) => string} jointLabel */
export function headline(alarm, jointLabel) {
  const who = alarm.name || 'Stream';
  // While it lasts, the value of now; afterwards the worst.
  const value = valueText(alarm.is_on ? alarm.value : alarm.worst, alarm);
  if (alarm.quantity === 'stale') return `${who}: no sample for ${value}`;
  if (alarm.quantity === 'server') return `Server lost for ${value}`;
  if (alarm.quantity === 'lost') return `${who} lost for ${value}`;
  const joint = alarm.joint === null ? '' : `${jointLabel(alarm.joint)} `;
  return `${who} ${joint}${value} ${QUANTITIES[alarm.quantity] ?? alarm.rule}`;
}

/** @param {Alarm} alarm */
export function limitText(alarm) {
  if (typeof alarm.limit !== 'number' || alarm.unit === 's') return alarm.rule;
  return `${alarm.rule}: limit ${valueText(alarm.limit, alarm)}`;
}

/** How long it lasts or lasted.
 *  @param {Alarm} alarm
 *  @param {number} micros  now, of the server's clock */
export const lengthText = ({ began, over }, micros) => age(Math.max(0, ((over?.micros ?? micros) - began.micros) / 1e6));

/** The second line: rule, since when, and how many others there are.
 *  @param {Alarm} alarm
 *  @param {number} others
 *  @param {number} micros  now */
export function detailText(alarm, others, micros) {
  const parts = [limitText(alarm)];
  if (alarm.unit !== 's') parts.push(`${alarm.is_on ? 'for' : 'over after'} ${lengthText(alarm, micros)}`);
  if (alarm.times > 1) parts.push(`${alarm.times} times`);
  if (alarm.acknowledged) parts.push(`acknowledged by ${alarm.acknowledged.role}`);
  if (others > 0) parts.push(`${others} more`);
  return parts.join(' · ');
}
