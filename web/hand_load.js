// The small form that says what a person holds: a hand, a mass.
import { refusalOf } from './server_api.js';

/** @typedef {import('./messages.js').HandLoad} HandLoad
 *  @typedef {{form: HTMLFormElement, hand: HTMLSelectElement, mass: HTMLInputElement}} Parts */

/** What is held once `kilograms` are in `hand` ("right_kg", "left_kg", "both_kg"): the rest stays.
 *  @param {HandLoad|undefined} told
 *  @param {string} hand
 *  @param {number} kilograms
 *  @returns {HandLoad} */
export const withHand = (told, hand, kilograms) => ({
  right_kg: told?.right_kg ?? 0, left_kg: told?.left_kg ?? 0, both_kg: told?.both_kg ?? 0,
  [hand]: kilograms,
});

/** "holds 5 kg right, 2 kg left", or "" for empty hands.
 *  @param {HandLoad|undefined} told */
export function heldText(told) {
  if (!told) return '';
  const kilograms = (/** @type {number} */ n) => `${Number(n.toFixed(2))} kg`;
  const parts = [
    told.right_kg > 0 ? `${kilograms(told.right_kg)} right` : '',
    told.left_kg > 0 ? `${kilograms(told.left_kg)} left` : '',
    told.both_kg > 0 ? `${kilograms(told.both_kg)} in both hands` : '',
  ].filter(Boolean);
  return parts.length > 0 ? `holds ${parts.join(', ')}` : '';
}

/** Tells the server; what comes back is shown by the next details.
 *  @param {Parts} parts
 *  @param {() => {character: number, hand_load?: HandLoad}|undefined} person  whose hands, if anybody's
 *  @param {(text: string) => void} say */
export function mountHandLoad({ form, hand, mass }, person, say) {
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const who = person();
    if (!who) return say('Nobody is here who could hold it');
    const load = withHand(who.hand_load, hand.value, mass.valueAsNumber);
    try {
      const answer = await fetch('api/hand_load', {
        method: 'POST', headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ person: who.character, ...load }),
      });
      if (!answer.ok) say(await refusalOf(answer));
    } catch {
      say('The server does not answer');
    }
  });
}
