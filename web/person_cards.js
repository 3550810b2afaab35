// A card for each person: name, highest joint load, compression of L5/S1 and margin of stability. Where there are
// controls, a card chooses its person for the whole page. The digits are written a few times a second, a change of class
// at once, so that a number and the colour beside it belong together.
import { percent, personLabel } from './format.js';
import { byUrgency } from './load_list.js';
import { shortJoint } from './plots.js';

export const PERSON_COLORS = 6;
const WALL_PEOPLE = 4;  // a wall has room for so many (layouts.css); alarms name the others, too

/** @typedef {import('./load_list.js').Row} Row
 *  @typedef {import('./messages.js').LoadClass} LoadClass
 *  @typedef {{character: number, label: string, loadClass: LoadClass, joint: string, key: string, ratio: number,
 *    compression: number, margin: number}} Summary  of one person; joint '': none is known; compression in N, margin in m,
 *    NaN where unknown
 *  @typedef {{pause: number, digits: {compression: number, margin: number}, unknown: string}} Kind  pause: ms between two texts;
 *    digits: after the point; unknown: instead of a joint */

const NEAR = { pause: 250, digits: { compression: 2, margin: 1 }, unknown: 'Load unknown' };
const WALL = { pause: 500, digits: { compression: 1, margin: 0 }, unknown: 'Unknown' };

/** Which of the colours of people.css a person has: the same on every page.
 *  @param {number} character */
export const colorNumber = (character) => (((character % PERSON_COLORS) + PERSON_COLORS) % PERSON_COLORS) + 1;

/** @param {import('./state_codec.js').Person} person
 *  @param {Row[]} rows  of this person
 *  @param {string} label
 *  @param {string} before  key of the row that was the highest, which stays so while others are about as high
 *  @returns {Summary} */
export function summaryOf({ character, compression, margin }, rows, label, before) {
  const [worst] = byUrgency(rows, [before]);
  if (!worst || worst.loadClass === 'unknown') {
    return { character, label, loadClass: 'unknown', joint: '', key: '', ratio: NaN, compression: NaN, margin: NaN };
  }
  const joint = shortJoint(worst.label.startsWith(`${label}: `) ? worst.label.slice(label.length + 2) : worst.label);
  return { character, label, loadClass: worst.loadClass, joint, key: worst.key, ratio: worst.ratio, compression, margin };
}

/** A number and its unit: "3.72", "kN"; "–" where it is unknown.
 *  @param {number} value  of the unit
 *  @param {number} digits
 *  @param {string} unit
 *  @returns {[string, string]} */
const figureText = (value, digits, unit) =>
  (Number.isFinite(value) ? [value.toFixed(digits).replace('-', '−'), unit] : ['–', '']);

/** @param {string} className
 *  @param {string} [tag] */
function part(className, tag = 'span') {
  const element = document.createElement(tag);
  element.className = className;
  return element;
}

/** @param {Element} element
 *  @param {string} text */
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

class Card {
  /** @type {HTMLElement} */ element;
  #name = document.createElement('b');
  #ratio = part('ratio');
  #joint = part('joint');
  #where = document.createElement('span');
  #class = part('class-word');
  #values = { compression: this.#figure('compression', 'Compression', 'L5/S1'), margin: this.#figure('margin', 'Margin', 'Margin') };
  /** @type {SVGUseElement|null} */ #use;
  #writtenAt = -Infinity;
  #loadClass = '';

  /** @param {number} character
   *  @param {((character: number) => void)|null} choose  null: the card is no control
   *  @param {HTMLTemplateElement} shape  an <svg> that uses the shape of a class */
  constructor(character, choose, shape) {
    this.element = document.createElement(choose ? 'button' : 'div');
    this.element.classList.add('person');
    this.element.dataset.character = String(character);
    this.element.dataset.person = String(colorNumber(character));
    if (choose) this.element.addEventListener('click', () => choose(character));
    const name = part('person-name'), drawn = document.importNode(shape.content, true);
    this.#use = drawn.querySelector('use');
    name.append(this.#name);
    const { compression, margin } = this.#values;
    const highest = part('highest');
    this.#joint.append(this.#where, this.#class);
    highest.append(this.#ratio, ' ', this.#joint);
    this.element.append(name, drawn, highest, ' ', compression.element, ' ', margin.element);
  }

  /** @param {string} className
   *  @param {string} name
   *  @param {string} short  where there is little room */
  #figure(className, name, short) {
    const element = part(`figure ${className}`), label = part('figure-name'), value = part('figure-value');
    const number = document.createElement('b'), unit = part('unit');
    label.textContent = name;
    label.dataset.short = short;
    value.append(number, ' ', unit);
    element.append(label, value);
    return { element, number, unit };
  }

  /** @param {Summary} person
   *  @param {number} now  ms
   *  @param {Kind} kind
   *  @returns {boolean}  whether it has written the numbers */
  show(person, now, { pause, digits, unknown }) {
    const isSame = person.loadClass === this.#loadClass && this.#name.textContent === person.label;
    if (isSame && now - this.#writtenAt < pause) return false;
    this.#writtenAt = now;
    this.#loadClass = person.loadClass;
    this.element.dataset.class = person.loadClass;
    this.#use?.setAttribute('href', `#shape-${person.loadClass}`);
    setText(this.#name, person.label);
    this.element.title = person.label;
    setText(this.#ratio, percent(person.ratio));
    setText(this.#where, person.joint || unknown);
    setText(this.#class, person.joint ? ` ${person.loadClass}` : '');
    this.#write('compression', figureText(person.compression / 1000, digits.compression, 'kN'));
    this.#write('margin', figureText(100 * person.margin, digits.margin, 'cm'));
    return true;
  }

  /** @param {'compression'|'margin'} which
   *  @param {[string, string]} text */
  #write(which, [number, unit]) {
    const { number: shown, unit: shownUnit } = this.#values[which];
    setText(shown, number);
    setText(shownUnit, unit);
  }

  /** @param {boolean} isChosen */
  press(isChosen) {
    this.element.toggleAttribute('data-chosen', isChosen);
    if (this.element instanceof HTMLButtonElement) this.element.ariaPressed = String(isChosen);
  }
}

export class PersonCards {
  /** @type {Map<number, Card>} */ #cards = new Map();
  /** @type {Map<number, string>} */ #highest = new Map();  // key of the row, by person
  #order = '';
  #chosen = /** @type {number|undefined} */ (undefined);

  /** @param {HTMLElement} list
   *  @param {((character: number) => void)|null} choose  null: cards are no controls
   *  @param {HTMLTemplateElement} shape  an <svg> that uses the shape of a class
   *  @param {boolean} isWall  seen from far: fewer digits, which change less often */
  constructor(list, choose, shape, isWall) {
    this.shape = shape;
    this.list = list;
    this.choose = choose;
    this.kind = isWall ? WALL : NEAR;
  }

  /** @param {import('./state_codec.js').State} state
   *  @param {{character: number, name: string}[]} names
   *  @param {Row[]} rows  of all
   *  @param {number|undefined} chosen  character
   *  @param {number} now  ms
   *  @returns {boolean}  whether the numbers of the chosen person have been written, or another one has been chosen */
  show(state, names, rows, chosen, now) {
    let isWritten = chosen !== this.#chosen;
    this.#chosen = chosen;
    const people = state.people.map((person) => {
      const name = names.find(({ character }) => character === person.character)?.name ?? '';
      const its = rows.filter(({ key }) => key.startsWith(`${person.character}/`));
      const label = personLabel({ character: person.character, name }), before = this.#highest.get(person.character) ?? '';
      const summary = summaryOf(person, its, label, before);
      this.#highest.set(person.character, summary.key);
      return summary;
    });
    for (const person of people) {
      const card = this.#cards.get(person.character) ?? new Card(person.character, this.choose, this.shape);
      this.#cards.set(person.character, card);
      const isNew = card.show(person, now, this.kind);
      if (person.character === chosen) isWritten ||= isNew;
      card.press(person.character === chosen);
    }
    const order = people.map(({ character }) => character).join();
    if (order === this.#order) return isWritten;
    this.#order = order;
    for (const character of this.#cards.keys()) {
      if (!people.some((person) => person.character === character)) this.#cards.delete(character);
    }
    this.list.dataset.count = String(people.length);
    this.list.dataset.more = people.length > WALL_PEOPLE ? `and ${people.length - WALL_PEOPLE} more, on the desk` : '';
    this.list.replaceChildren(...people.flatMap(({ character }) => this.#cards.get(character)?.element ?? []));
    return isWritten;
  }
}
