// A camera that goes round its target by keys. World frame: z up, metres. Pure functions.

const LEAST_POLE = 0.02;  // rad, from straight up and down

/** @typedef {{position: number[], target: number[]}} Place */

/** @param {Place} place
 *  @param {number} azimuth  by which the camera goes round the target, counter-clockwise seen from above, rad
 *  @param {number} elevation  by which it rises, rad; it stops above and below the target
 *  @returns {Place} */
export function turned({ position, target }, azimuth, elevation) {
  const [x, y, z] = position.map((v, i) => v - target[i]);
  const distance = Math.hypot(x, y, z), most = Math.PI / 2 - LEAST_POLE;
  const around = Math.atan2(y, x) + azimuth, up = Math.max(-most, Math.min(most, Math.asin(z / distance) + elevation));
  const offset = [Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up)];
  return { position: offset.map((v, i) => target[i] + distance * v), target };
}

/** @param {Place} place
 *  @param {number} factor  of the distance
 *  @param {{least: number, most: number}} range  of the distance, m
 *  @returns {Place} */
export function zoomed({ position, target }, factor, { least, most }) {
  const offset = position.map((v, i) => v - target[i]), distance = Math.hypot(...offset);
  const next = Math.max(least, Math.min(most, factor * distance));
  return { position: offset.map((v, i) => target[i] + v * next / distance), target };
}

/** To the side and up, as the viewer sees it.
 *  @param {Place} place
 *  @param {number} right  share of the distance
 *  @param {number} up
 *  @returns {Place} */
export function shifted({ position, target }, right, up) {
  const [x, y] = position.map((v, i) => v - target[i]), flat = Math.hypot(x, y) || 1;
  const distance = Math.hypot(...position.map((v, i) => v - target[i]));
  const by = [-y / flat * right * distance, x / flat * right * distance, up * distance];
  return { position: position.map((v, i) => v + by[i]), target: target.map((v, i) => v + by[i]) };
}

/** The place of a camera that was moved by hand, as a text for the address: position and target, m, from the middle of
 *  the people on the floor.
 *  @param {Place} place
 *  @param {number[]} middle */
export const placeText = ({ position, target }, middle) =>
  [...position, ...target].map((v, i) => String(Number((v - middle[i % 3]).toFixed(2)))).join();

/** @param {string} text
 *  @returns {Place|null}  from the middle of the people on the floor; null: it is no such text */
export function placeOf(text) {
  const numbers = text.split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  if (numbers.length !== 6 || numbers.some((v) => !(Math.abs(v) <= 100))) return null;
  const place = { position: numbers.slice(0, 3), target: numbers.slice(3) };
  return Math.hypot(...place.position.map((v, i) => v - place.target[i])) > 0.05 ? place : null;
}
