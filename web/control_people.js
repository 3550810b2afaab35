// The person, what is held, and the limits of the classes: as they are, where that comes from, and to be changed.
import { handsText, heightText, originText } from './control_texts.js';
import { showPeople } from './people_choice.js';

/** @typedef {import('./control_messages.js').ControlState} ControlState
 *  @typedef {import('./control_messages.js').ControlledPerson} ControlledPerson
 *  @typedef {{select: HTMLSelectElement, form: HTMLFormElement, name: HTMLInputElement, mass: HTMLInputElement,
 *    sex: HTMLSelectElement, height: HTMLInputElement, note: HTMLElement, handsForm: HTMLFormElement,
 *    right: HTMLInputElement, left: HTMLInputElement, both: HTMLInputElement, handsNote: HTMLElement}} PersonParts
 *  @typedef {{form: HTMLFormElement, medium: HTMLInputElement, high: HTMLInputElement, note: HTMLElement}} LimitParts
 *  @typedef {ReturnType<typeof import('./control_orders.js').makeOrders>} SendOrder */

/** A form that shows the values of now until its user types.
 *  @param {HTMLFormElement} form
 *  @param {() => Promise<unknown>} send  null: refused; what was typed stays
 *  @returns {() => boolean} whether it may be filled with the values of now */
function mountForm(form, send) {
  let isTyped = false;
  form.addEventListener('input', () => { isTyped = true; });
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    if (await send() !== null) isTyped = false;
  });
  return () => !isTyped;
}

/** @param {HTMLInputElement|HTMLSelectElement} field
 *  @param {string} value */
function fill(field, value) {
  if (field.value !== value) field.value = value;
}

/** @param {HTMLElement} note
 *  @param {string} text */
function say(note, text) {
  if (note.textContent !== text) note.textContent = text;
}

/** @param {PersonParts} parts
 *  @param {SendOrder} order
 *  @returns {(state: ControlState) => void} */
export function mountPerson(parts, order) {
  /** @type {ControlledPerson[]} */
  let people = [];
  const chosen = () => people.find(({ character }) => String(character) === parts.select.value) ?? people.at(0);
  const mayFill = mountForm(parts.form, async () => {
    const person = chosen();
    if (!person) return null;
    return order('api/v1/person', { person: person.character, ...changesOf(parts, person) }, 'change the person');
  });
  const mayFillHands = mountForm(parts.handsForm, async () => {
    const person = chosen();
    if (!person) return null;
    const { right, left, both } = parts;
    return order('api/v1/hand_load', {
      person: person.character, right_kg: right.valueAsNumber, left_kg: left.valueAsNumber, both_kg: both.valueAsNumber,
    }, 'replace the hand load');
  });
  return (state) => {
    people = state.people;
    showPeople(parts.select, people.map(({ character, name }) => ({ character, name: name.value })));
    const person = chosen();
    parts.form.inert = parts.handsForm.inert = !person;
    if (!person) return say(parts.note, 'No person in the stream');
    if (mayFill()) {
      fill(parts.name, person.name.value);
      fill(parts.mass, String(Number(person.mass_kg.value.toFixed(1))));
      fill(parts.sex, person.sex.value);
      fill(parts.height, (person.height_m.stated ?? person.height_m.value).toFixed(2));
    }
    say(parts.note, `Name ${originText(person.name.from)} · mass ${originText(person.mass_kg.from)} · sex ${
      originText(person.sex.from)} · stature ${heightText(person)}`);
    const { hands } = person;
    if (mayFillHands()) {
      fill(parts.right, String(hands.right_kg));
      fill(parts.left, String(hands.left_kg));
      fill(parts.both, String(hands.both_kg));
    }
    say(parts.handsNote, handsText(hands));
  };
}

/** What the form says that is not so already; all of it if nothing was changed, which states what was assumed.
 *  @param {PersonParts} parts
 *  @param {ControlledPerson} person */
function changesOf({ name, mass, sex, height }, person) {
  const typed = { mass_kg: mass.valueAsNumber, sex: sex.value, height_m: height.valueAsNumber, name: name.value.trim() };
  const now = {
    mass_kg: Number(person.mass_kg.value.toFixed(1)), sex: person.sex.value, name: person.name.value,
    height_m: Number((person.height_m.stated ?? person.height_m.value).toFixed(2)),
  };
  const changes = Object.entries(typed).filter(([key, value]) => value !== Reflect.get(now, key) && value !== '');
  return changes.length > 0 ? Object.fromEntries(changes) : { mass_kg: typed.mass_kg, sex: typed.sex };
}

/** @param {LimitParts} parts
 *  @param {SendOrder} order
 *  @returns {(state: ControlState) => void} */
export function mountLimits({ form, medium, high, note }, order) {
  const percent = (/** @type {number} */ ratio) => String(Number((100 * ratio).toFixed(2)));
  const mayFill = mountForm(form, () => order('api/v1/class_limits', {
    medium: medium.valueAsNumber / 100, high: high.valueAsNumber / 100,
  }, 'change the class limits'));
  return ({ class_limits: { value: [mediumFrom, highFrom], from } }) => {
    if (mayFill()) {
      fill(medium, percent(mediumFrom));
      fill(high, percent(highFrom));
    }
    say(note, `Medium above ${percent(mediumFrom)} %, high above ${percent(highFrom)} % of the capacity: ${originText(from)}`);
  };
}
