// The names of several people over their heads, as text over the view: never as markup, and as sharp as all other text.
import { labelText, personLabel } from './format.js';
import { colorNumber } from './person_cards.js';

const GAP_PX = 3;

/** @typedef {{character: number, x: number, y: number}} Head  where the top of a head is in the view, px
 *  @typedef {{character: number, x: number, y: number, width: number, height: number}} Box  left upper corner, px */

/** Places for labels over heads: inside the view, and none over another one. A label that would cover another one moves
 *  up; where the view ends, those below it move down.
 *  @param {Box[]} labels  x, y: the middle of the lower edge
 *  @param {{width: number, height: number}} view
 *  @returns {Box[]}  x, y: the left upper corner */
export function placed(labels, view) {
  const boxes = labels.map((label) => ({
    ...label, x: Math.max(0, Math.min(view.width - label.width, label.x - label.width / 2)),
    y: Math.min(view.height, label.y) - label.height,
  }));
  const touch = (/** @type {Box} */ a, /** @type {Box} */ b) => a.x < b.x + b.width + GAP_PX && b.x < a.x + a.width + GAP_PX
    && a.y < b.y + b.height + GAP_PX && b.y < a.y + a.height + GAP_PX;
  const lowestFirst = [...boxes].sort((a, b) => b.y - a.y);
  lowestFirst.forEach((box, i) => {
    for (const other of lowestFirst.slice(0, i)) if (touch(box, other)) box.y = other.y - box.height - GAP_PX;
  });
  const highestFirst = [...boxes].sort((a, b) => a.y - b.y);
  highestFirst.forEach((box, i) => {
    box.y = Math.max(0, box.y);
    for (const other of highestFirst.slice(0, i)) if (touch(box, other)) box.y = other.y + other.height + GAP_PX;
  });
  return boxes;
}

export class HeadNames {
  /** @type {Map<number, {element: HTMLElement, text: HTMLElement}>} */ #labels = new Map();
  /** @type {Map<number, {width: number, height: number}>} */ #sizes = new Map();  // of labels: looked up when they change

  /** @param {HTMLElement} box  over the view */
  constructor(box) {
    this.box = box;
    new ResizeObserver(() => this.#sizes.clear()).observe(box);
  }

  /** @param {Head[]} heads  that are in front of the camera
   *  @param {{character: number, name: string}[]} names */
  show(heads, names) {
    const several = heads.length > 1 ? heads : [];
    for (const [character, { element }] of this.#labels) {
      if (several.some((head) => head.character === character)) continue;
      element.remove();
      this.#sizes.delete(character);
      this.#labels.delete(character);
    }
    if (several.length === 0) return;
    const { clientWidth: width, clientHeight: height } = this.box;
    const sized = several.map((head) => ({ ...head, ...this.#sizeOf(head.character, names) }));
    for (const { character, x, y } of placed(sized, { width, height })) {
      const label = this.#labels.get(character);
      if (label) label.element.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    }
  }

  /** @param {number} character
   *  @param {{character: number, name: string}[]} names */
  #sizeOf(character, names) {
    const { element, text } = this.#labels.get(character) ?? this.#add(character);
    const label = labelText(personLabel({ character, name: names.find((each) => each.character === character)?.name ?? '' }));
    if (text.textContent !== label) {
      text.textContent = label;
      this.#sizes.delete(character);
    }
    const size = this.#sizes.get(character) ?? { width: element.offsetWidth, height: element.offsetHeight };
    this.#sizes.set(character, size);
    return size;
  }

  /** @param {number} character */
  #add(character) {
    const element = document.createElement('div'), text = document.createElement('span');
    element.className = 'head-name';
    element.dataset.person = String(colorNumber(character));
    element.append(text);
    this.box.append(element);
    const label = { element, text };
    this.#labels.set(character, label);
    return label;
  }
}
