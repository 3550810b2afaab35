// Numbers and names as text for the page. Pure functions.

/** @param {number} hz */
export const rate = (hz) => (hz > 0 ? `${hz.toFixed(1)} Hz` : '–');

/** @param {number|null} ms */
export function latency(ms) {
  if (ms === null || !Number.isFinite(ms)) return '–';
  return ms < 9.95 ? `${ms.toFixed(1)} ms` : `${Math.round(ms)} ms`;
}

/** 83456 -> "00:01:23.456".
 *  @param {number} millis */
export function timeCode(millis) {
  if (!(millis >= 0)) return '–';
  const whole = Math.floor(millis);
  const two = (/** @type {number} */ n) => String(n).padStart(2, '0');
  return `${two(Math.floor(whole / 3600000))}:${two(Math.floor(whole / 60000) % 60)}:`
    + `${two(Math.floor(whole / 1000) % 60)}.${String(whole % 1000).padStart(3, '0')}`;
}

/** @param {number} seconds */
export function age(seconds) {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 120) return `${Math.floor(seconds)} s`;
  return seconds < 7200 ? `${Math.floor(seconds / 60)} min` : `${Math.floor(seconds / 3600)} h`;
}

/** 12400 -> "−12.4 s", 133000 -> "−2:13 min".
 *  @param {number} millis  by which something is behind */
export function lag(millis) {
  const tenths = Math.round(Math.max(0, millis) / 100);
  if (tenths < 600) return `−${(tenths / 10).toFixed(1)} s`;
  const seconds = Math.round(tenths / 10);
  return `−${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, '0')} min`;
}

/** A place in a recording: 42000 -> "0:42.0".
 *  @param {number} seconds
 *  @param {number} [digits]  after the point */
export function place(seconds, digits = 1) {
  const step = 10 ** digits, whole = Math.max(0, Math.round(seconds * step)) / step;
  const minutes = Math.floor(whole / 60), hours = Math.floor(minutes / 60);
  const two = (/** @type {number|string} */ n) => String(n).padStart(2, '0');
  const rest = (whole - 60 * minutes).toFixed(digits).padStart(digits > 0 ? 3 + digits : 2, '0');
  return hours > 0 ? `${hours}:${two(minutes % 60)}:${rest}` : `${minutes}:${rest}`;
}

/** @param {number} ratio of capacity; NaN where unknown */
export const percent = (ratio) => (Number.isFinite(ratio) ? `${Math.round(100 * ratio)} %` : '–');

/** A limit as it was set, to a tenth of a percent.
 *  @param {number} ratio */
export const limitPercent = (ratio) => `${Number((100 * ratio).toFixed(1))} %`;

/** @param {number} metres */
export const centimetres = (metres) => `${(100 * metres).toFixed(1)} cm`;

/** @param {number} newtons */
export const kilonewtons = (newtons) => `${(newtons / 1000).toFixed(2)} kN`;

/** "12.3 of 60 N·m": moment and capacity.
 *  @param {number} moment  N m, signed
 *  @param {number} capacity  N m */
export function moment(moment, capacity) {
  if (!Number.isFinite(moment)) return '';
  const digits = Math.abs(moment) < 10 ? 1 : 0;
  const size = Math.abs(moment).toFixed(digits);
  return capacity > 0 ? `${size} of ${Math.round(capacity)} N·m` : `${size} N·m`;
}

/** "three_quarter" -> "three quarter".
 *  @param {string} name */
export const cameraLabel = (name) => name.replaceAll('_', ' ');

/** Camera label for places with little room.
 *  @param {string} name */
export const shortCameraLabel = (name) => (name === 'three_quarter' ? '¾' : cameraLabel(name));

/** sRGB 0..1 -> "#rrggbb".
 *  @param {number[]} rgb */
export const hexColor = (rgb) =>
  `#${rgb.map((part) => Math.round(255 * part).toString(16).padStart(2, '0')).join('')}`;

const LONGEST_LABEL = 24;  // characters; names in a stream may have any length

/** @param {{character: number, name: string}} person */
export const personLabel = ({ character, name }) => name || `Person ${character + 1}`;

/** Shortens a name so that it fits over an object in the view.
 *  @param {string} name */
export function labelText(name) {
  const letters = [...name];
  return letters.length > LONGEST_LABEL ? `${letters.slice(0, LONGEST_LABEL - 1).join('')}…` : name;
}
