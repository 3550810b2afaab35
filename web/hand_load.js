// The form that sets the hand load of a person: person, hand and mass.
import { labelText, personLabel } from './format.js';
import { messageOf, request } from './server_api.js';

/** @typedef {import('./messages.js').HandLoad} HandLoad
 *  @typedef {import('./messages.js').PersonDetails} PersonDetails
 *  @typedef {{form: HTMLFormElement, person: HTMLSelectElement, hand: HTMLSelectElement, mass: HTMLInputElement}} Parts */

/** The hand load with `kilograms` in `hand` ("right_kg", "left_kg", "both_kg") and nothing else: it replaces what is held.
 *  @param {string} hand
 *  @param {number} kilograms
 *  @returns {HandLoad} */
export const onlyIn = (hand, kilograms) => ({ right_kg: 0, left_kg: 0, both_kg: 0, [hand]: kilograms });

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

/** Sends hand loads to the server. The page shows a new hand load with the next details. The list of people is visible
 *  only if there are several.
 *  @param {Parts} parts
 *  @param {(text: string) => void} showNotice
 *  @returns {{setPeople: (people: PersonDetails[]) => void, selected: () => PersonDetails|undefined}} */
export function mountHandLoad({ form, person, hand, mass }, showNotice) {
  let people = /** @type {PersonDetails[]} */ ([]);
  const selected = () => people.find(({ character }) => String(character) === person.value);
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const target = selected();
    if (!target) return showNotice('No person in the stream');
    const load = onlyIn(hand.value, mass.valueAsNumber);
    try {
      await sendHandLoad(target.character, load);
    } catch (error) {
      showNotice(`Could not set the hand load: ${messageOf(error)}`);
    }
  });
  return {
    setPeople(newPeople) {
      people = newPeople;
      showPeople(person, people);
    },
    selected,
  };
}

/** Keeps the selection. Unchanged options stay, because a browser closes an open list whose options are replaced.
 *  @param {HTMLSelectElement} list
 *  @param {PersonDetails[]} people */
function showPeople(list, people) {
  const options = people.map((each) => new Option(labelText(personLabel(each)), String(each.character)));
  const isUnchanged = options.length === list.options.length
    && options.every(({ value, text }, i) => value === list.options[i].value && text === list.options[i].text);
  if (isUnchanged) return;
  const before = list.value;
  list.replaceChildren(...options);
  if (people.some(({ character }) => String(character) === before)) list.value = before;
  list.hidden = people.length < 2;
}

/** @param {number} person
 *  @param {HandLoad} load */
const sendHandLoad = (person, load) => request('api/v1/hand_load', {
  method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ person, ...load }),
});
