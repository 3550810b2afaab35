// The map of the body, seen from the front: a shape at each joint with a load, and beside it percent, trend and
// exposure. The class is told by shape besides colour: circle, diamond, octagon with "!", dashed ring. A joint that is
// pressed is plotted.
import { exposureShares, exposureText } from './load_list.js';
import { percent } from './format.js';
import { LOAD_CLASSES } from './messages.js';

/** Where the joints are on the drawing of index.html, in its units; the person's right is on the left. */
export const PLACES = /** @type {const} */ ({
  t1_c7: [0, 66], t9_t8: [0, 112], l5_s1: [0, 172],
  right_shoulder: [-40, 82], left_shoulder: [40, 82], right_elbow: [-55, 141], left_elbow: [55, 141],
  right_wrist: [-64, 197], left_wrist: [64, 197], right_hip: [-21, 198], left_hip: [21, 198],
  right_knee: [-23, 284], left_knee: [23, 284], right_ankle: [-23, 366], left_ankle: [23, 366],
});
const TREND_MICROS = 1_000_000, SPARE_MICROS = 500_000;
const LEAST_TREND = 0.05;  // of the capacity

/** @typedef {{name: string, label: string, loadClass: import('./messages.js').LoadClass, ratio: number,
 *    secs?: import('./messages.js').Secs}} Joint
 *  @typedef {{element: HTMLElement, mark: Element, word: HTMLElement, ratio: HTMLElement, trend: HTMLElement, more: HTMLElement,
 *    shares: HTMLElement[]}} Row  word, more: for screen readers */

/** Which way the loads go: compares with those a second before. */
export class Trend {
  /** @type {{micros: number, ratios: Map<string, number>}[]} */ #past = [];

  /** @param {number} micros  moment of the loads
   *  @param {Joint[]} joints
   *  @returns {(name: string) => '▲'|'▼'|''}  '': about the same, or unknown */
  add(micros, joints) {
    const ratios = new Map(joints.map(({ name, ratio }) => [name, ratio]));
    const before = this.#past.find((each) => Math.abs(micros - TREND_MICROS - each.micros) < SPARE_MICROS);
    // Moments come in any order: a viewer goes back and forth.
    this.#past = this.#past.filter((each) => each.micros < micros && each.micros > micros - TREND_MICROS - SPARE_MICROS);
    this.#past.push({ micros, ratios });
    return (name) => {
      const change = (ratios.get(name) ?? NaN) - (before?.ratios.get(name) ?? NaN);
      return change >= LEAST_TREND ? '▲' : change <= -LEAST_TREND ? '▼' : '';
    };
  }
}

export class BodyMap {
  /** @type {Map<string, Row>} */ #rows = new Map();
  #trend = new Trend();
  #shown = '';

  /** @param {{panel: HTMLElement, mark: HTMLTemplateElement, middle: HTMLElement, right: HTMLElement,
   *    left: HTMLElement}} parts  mark: template of a <g>; the lists get a button for each joint
   *  @param {((name: string) => void)|null} onPress  null: the joints cannot be pressed */
  constructor(parts, onPress) {
    const marks = parts.panel.querySelector('#body-marks');
    if (marks === null) throw new Error('the map of the body has no place for its marks');
    this.marks = marks;
    this.parts = parts;
    this.onPress = onPress;
  }

  /** @param {number} micros  moment of the loads
   *  @param {Joint[]} joints
   *  @param {readonly string[]} plotted */
  show(micros, joints, plotted) {
    const shown = JSON.stringify([micros, joints, plotted]);
    if (this.parts.panel.clientWidth === 0 || shown === this.#shown) return;
    this.#shown = shown;
    if (joints.some(({ name }) => !this.#rows.has(name))) this.#make(joints);
    const trend = this.#trend.add(micros, joints);
    for (const joint of joints) {
      const row = this.#rows.get(joint.name);
      if (row) this.#fill(row, joint, trend(joint.name), plotted.includes(joint.name));
    }
  }

  /** @param {Joint[]} joints */
  #make(joints) {
    const { marks, parts: { mark, middle, right, left } } = this;
    this.#rows.clear();
    for (const list of [marks, middle, right, left]) list.replaceChildren();
    for (const { name, label } of joints) {
      const place = Object.entries(PLACES).find(([key]) => key === name)?.[1] ?? [0, 0];
      const group = document.importNode(mark.content, true).querySelector('g');
      if (!group) return;
      group.setAttribute('transform', `translate(${place.join()})`);
      marks.append(group);
      const row = this.#rowOf(group, label, name);
      (place[0] === 0 ? middle : place[0] < 0 ? right : left).append(row.element);
      this.#rows.set(name, row);
    }
  }

  /** @param {Element} mark
   *  @param {string} label
   *  @param {string} name
   *  @returns {Row} */
  #rowOf(mark, label, name) {
    const { onPress } = this, element = document.createElement(onPress ? 'button' : 'div');
    const [side, title, word, ratio, trend, more, bar] = [
      'visually-hidden', 'joint-name', 'visually-hidden', 'ratio', 'trend', 'visually-hidden', 'exposure'].map((className) => {
      const part = document.createElement('span');
      part.className = className;
      return part;
    });
    const shares = LOAD_CLASSES.map((loadClass) => {
      const share = document.createElement('span');
      share.className = 'share';
      share.dataset.class = loadClass;
      return share;
    });
    if (element instanceof HTMLButtonElement) element.type = 'button';
    element.classList.add('joint-card');
    element.dataset.joint = name;
    // What the place beside the figure says, and what its colour says, is there for screen readers as words.
    side.textContent = /^(?:Right|Left) /.exec(label)?.[0] ?? '';
    title.textContent = label.replace(/^(?:Right|Left) (.)/, (_, /** @type {string} */ first) => first.toUpperCase());
    trend.ariaHidden = 'true';
    bar.append(...shares);
    element.append(side, title, word, ratio, trend, more, bar);
    if (onPress) for (const part of [element, mark]) part.addEventListener('click', () => onPress(name));
    return { element, mark, word, ratio, trend, more, shares };
  }

  /** @param {Row} row
   *  @param {Joint} joint
   *  @param {string} trend
   *  @param {boolean} isPlotted */
  #fill({ element, mark, word, ratio, trend: arrow, more, shares }, { loadClass, ratio: value, secs }, trend, isPlotted) {
    element.dataset.class = loadClass;
    mark.setAttribute('data-class', loadClass);
    mark.querySelector('use')?.setAttribute('href', `#shape-${loadClass}`);
    word.textContent = `, ${loadClass}, `;
    ratio.textContent = percent(value);
    arrow.textContent = trend;
    const words = [trend === '▲' ? 'rising' : trend === '▼' ? 'falling' : '', exposureText(secs)].filter(Boolean);
    more.textContent = [...words.map((text) => `, ${text}`), this.onPress ? '; plot' : ''].join('');
    exposureShares(secs).forEach((share, i) => { shares[i].style.flexGrow = share.toFixed(3); });
    element.title = exposureText(secs);
    if (this.onPress) element.ariaPressed = String(isPlotted);
  }
}
