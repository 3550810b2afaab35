// A list of the people in the stream, to choose one of them.
import { personLabel } from './format.js';

/** Shows `people`, and keeps the one who is chosen. With one person there is nothing to choose.
 *  @param {HTMLSelectElement} select
 *  @param {{character: number, name: string}[]} people */
export function showPeople(select, people) {
  const options = people.map((each) => ({ value: String(each.character), text: personLabel(each) }));
  const now = [...select.options].map(({ value, text }) => ({ value, text }));
  if (JSON.stringify(now) === JSON.stringify(options)) return;
  const before = select.value;
  select.replaceChildren(...options.map(({ value, text }) => new Option(text, value)));
  if (options.some(({ value }) => value === before)) select.value = before;
  select.hidden = options.length < 2;
}
