// The form that sets the hand load of a person: hand and mass.
import { rejectionOf } from './server_api.js';

/** @typedef {import('./messages.js').HandLoad} HandLoad
 *  @typedef {{form: HTMLFormElement, hand: HTMLSelectElement, mass: HTMLInputElement}} Parts */

/** The hand load with `kilograms` in `hand` ("right_kg", "left_kg", "both_kg"); the other masses are kept.
 *  @param {HandLoad|undefined} current
 *  @param {string} hand
 *  @param {number} kilograms
 *  @returns {HandLoad} */
export const withHand = (current, hand, kilograms) => ({
  right_kg: current?.right_kg ?? 0, left_kg: current?.left_kg ?? 0, both_kg: current?.both_kg ?? 0,
  [hand]: kilograms,
});

/** "hand load 5 kg right, 2 kg left", or "" for empty hands.
 *  @param {HandLoad|undefined} current */
export function handLoadText(current) {
  if (!current) return '';
  const kilograms = (/** @type {number} */ n) => `${Number(n.toFixed(2))} kg`;
  const parts = [
    current.right_kg > 0 ? `${kilograms(current.right_kg)} right` : '',
    current.left_kg > 0 ? `${kilograms(current.left_kg)} left` : '',
    current.both_kg > 0 ? `${kilograms(current.both_kg)} in both hands` : '',
  ].filter(Boolean);
  return parts.length > 0 ? `hand load ${parts.join(', ')}` : '';
}

/** Sends the hand load to the server. The page shows the new hand load with the next details.
 *  @param {Parts} parts
 *  @param {() => {character: number, hand_load?: HandLoad}|undefined} person  whose hand load is set, if any
 *  @param {(text: string) => void} showNotice */
export function mountHandLoad({ form, hand, mass }, person, showNotice) {
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const who = person();
    if (!who) return showNotice('No person in the stream');
    const load = withHand(who.hand_load, hand.value, mass.valueAsNumber);
    try {
      const answer = await fetch('api/hand_load', {
        method: 'POST', headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ person: who.character, ...load }),
      });
      if (!answer.ok) showNotice(await rejectionOf(answer));
    } catch {
      showNotice('No connection to the server');
    }
  });
}
