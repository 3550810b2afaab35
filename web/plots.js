// The panel of plots: joint loads, compression, margin of stability, rate and losses of one person over 10 s to 10 min,
// and the ways of CoM and CoP on the floor.
import { FloorPlan } from './floor_plan.js';
import { personLabel } from './format.js';
import { DASHES, Plot } from './plot.js';
import { csvOf, download, fileNameOf, pictureOf } from './plot_files.js';
import { PlotWindow, WINDOWS_SECS, windowName } from './plot_window.js';
import { GAP_MICROS, Series } from './series.js';
import { theme } from './theme.js';

const COLUMNS = 400;  // of a window
const LATE_MICROS = 2_000_000;  // by which what was loaded may be behind the moment on the screen
const MOST_LINES = DASHES.length;
export const FIRST_JOINTS = ['l5_s1', 'right_shoulder', 'right_knee'];
const PLACES = ['com_x', 'com_y', 'cop_x', 'cop_y'];

/** @type {import('./plot.js').Kind[]} */
export const KINDS = [
  { id: 'loads', title: 'Joint loads', unit: '% of capacity', factor: 100, digits: 0, least: [0, 80], height: 146,
    hint: 'The load of each sample. The list of loads and the spheres hold a peak for a moment.' },
  { id: 'compression', title: 'L5/S1 compression', unit: 'kN', factor: 1e-3, digits: 2, least: [0, 4], height: 70 },
  { id: 'margin', title: 'Margin of stability', unit: 'cm', factor: 100, digits: 1, least: [0, 10], height: 70 },
  { id: 'rate', title: 'Rate', unit: 'Hz', factor: 1, digits: 1, least: [0, 60], height: 48 },
  { id: 'loss', title: 'Lost samples', unit: '%', factor: 100, digits: 1, least: [0, 4], height: 48 },
];

/** @typedef {import('./series.js').Wanted} Wanted
 *  @typedef {{oldest: number, newest: number, moment: number, isLive: boolean, wallMillis: (micros: number) => number}} When
 *  @typedef {{panel: HTMLElement, windows: HTMLElement, joints: HTMLElement,
 *    chosen: HTMLElement, list: HTMLElement, plan: HTMLCanvasElement, dash: HTMLTemplateElement,
 *    csv: HTMLButtonElement, png: HTMLButtonElement}} Parts
 *  @typedef {{character: number, name: string}} Person
 *  @typedef {{name: string, label: string}} Joint
 *  @typedef {{seek: (micros: number) => void, source: () => string, failed: (text: string) => void,
 *    person: import('./chosen_person.js').ChosenPerson}} Page  source: the trial or recording, for files */

/** "Right shoulder" -> "R shoulder".
 *  @param {string} label */
export const shortJoint = (label) => label.replace(/^Right /, 'R ').replace(/^Left /, 'L ');

/** The trials that ran in this time.
 *  @param {import('./plot.js').Flag[]} flags
 *  @param {number} from
 *  @param {number} to  µs */
export const trialsIn = (flags, from, to) =>
  flags.filter(({ isTrial, micros, endMicros }) => isTrial && micros < to && (endMicros ?? Infinity) > from).map(({ text }) => text);

/** One plot with its title, the names of its lines and their values. */
class Figure {
  element = document.createElement('figure');
  #lines = document.createElement('ul');
  #note = document.createElement('small');
  /** @type {HTMLElement[]} */ #values = [];

  /** @param {import('./plot.js').Kind} kind
   *  @param {import('./plot.js').Events} events
   *  @param {HTMLTemplateElement} dash  a sample of a line */
  constructor(kind, events, dash) {
    this.kind = kind;
    this.dash = dash;
    const caption = document.createElement('figcaption'), title = document.createElement('b');
    title.textContent = `${kind.title}, ${kind.unit}`;
    title.append(this.#note);
    if (kind.hint) caption.title = kind.hint;
    caption.append(title, this.#lines);
    const box = document.createElement('div');
    box.className = 'plot';
    this.element.append(caption, box);
    this.element.dataset.plot = kind.id;
    this.plot = new Plot(box, kind, events);
  }

  /** @param {import('./plot.js').Line[]} lines
   *  @param {boolean} hasClock */
  setLines(lines, hasClock) {
    this.plot.setLines(lines, hasClock);
    this.#values = lines.map(() => document.createElement('output'));
    this.#lines.replaceChildren(...lines.map((line, i) => {
      const entry = document.createElement('li');
      entry.className = `line-${i + 1}`;
      if (line.name) entry.append(this.#dashOf(i), line.name, ' ');
      entry.append(this.#values[i]);
      return entry;
    }));
  }

  /** @param {string} text */
  setNote(text) {
    this.#note.textContent = ` · ${text}`;
  }

  get title() {
    return `${this.kind.title}, ${this.kind.unit}${this.#note.textContent}`;
  }

  /** @param {number} index  of a line */
  #dashOf(index) {
    const sample = document.importNode(this.dash.content, true).children[0];
    sample.querySelector('line')?.setAttribute('stroke-dasharray', DASHES[index].join(' '));
    return sample;
  }

  /** @param {Series} series
   *  @param {number} micros
   *  @param {boolean} isWorst  the worst of the column, else its newest value */
  showValues(series, micros, isWorst) {
    const column = series.newest(micros, isWorst ? GAP_MICROS : LATE_MICROS);
    this.plot.lines.forEach(({ key }, i) => {
      const value = column?.values[key];
      const shown = isWorst ? (key === 'margin' ? value?.min : value?.max) : value?.last;
      const text = shown === undefined || shown === null ? '–' : (this.kind.factor * shown).toFixed(this.kind.digits)
        .replace('-', '−');
      if (this.#values[i].textContent !== text) this.#values[i].textContent = text;
    });
  }
}

export class Plots {
  window = new PlotWindow();
  /** @type {Series|null} */ #series = null;
  /** @type {Joint[]} */ #joints = [];
  /** @type {Person[]} */ #people = [];
  /** @type {readonly string[]} */ #chosen = FIRST_JOINTS;
  /** @type {number|null} */ #hover = null;  // µs
  #drawn = '';
  /** @type {When|null} */ #when = null;

  /** @param {Parts} parts
   *  @param {Page} page */
  constructor(parts, page) {
    this.parts = parts;
    this.page = page;
    const events = { onSeek: page.seek, onHover: (/** @type {number|null} */ micros) => { this.#hover = micros; this.#showValues(); } };
    this.figures = KINDS.map((kind) => new Figure(kind, events, parts.dash));
    this.plan = new FloorPlan(parts.plan);
    parts.list.replaceChildren(...this.figures.map(({ element }) => element));
    parts.windows.replaceChildren(...WINDOWS_SECS.map((secs) => this.#windowButton(secs)));
    parts.csv.addEventListener('click', () => this.#save('csv'));
    parts.png.addEventListener('click', () => this.#save('png'));
    this.#setLines();
    theme?.follow(() => {
      for (const { plot } of this.figures) plot.recolor();
      this.#drawn = '';
    });
  }

  /** @param {number} secs */
  #windowButton(secs) {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = windowName(secs);
    button.ariaPressed = String(secs === this.window.secs);
    button.addEventListener('click', () => this.chooseWindow(secs));
    return button;
  }

  /** @param {number} secs  one that has no button changes nothing */
  chooseWindow(secs) {
    const at = WINDOWS_SECS.findIndex((each) => each === secs);
    if (at < 0) return;
    this.window.setSecs(secs);
    [...this.parts.windows.children].forEach((button, i) => { button.ariaPressed = String(i === at); });
    this.#drawn = '';
  }

  /** @param {Joint[]} joints  with a load, in their order
   *  @param {readonly number[]} classLimits  ratios
   *  @param {readonly number[]} compressionLimits  N */
  setJoints(joints, classLimits, compressionLimits) {
    const limits = JSON.stringify([joints, classLimits, compressionLimits]);
    if (limits === this.#limits) return;
    this.#limits = limits;
    this.#joints = joints;
    this.#chosen = this.#chosen.filter((chosen) => joints.some(({ name }) => name === chosen));  // an address may name any
    const [mediumFrom, highFrom] = classLimits.map((limit) => 100 * limit);
    this.#figureOf('loads').plot.setLimits([
      { value: mediumFrom, tone: 'class-medium' }, { value: highFrom, tone: 'class-high' }]);
    const [action, upper] = compressionLimits.map((limit) => limit / 1000);
    this.#figureOf('compression').plot.setLimits([
      { value: action, tone: 'class-medium' }, { value: upper, tone: 'class-high' }]);
    this.#figureOf('compression').setNote(`limits ${action} and ${upper}`);
    this.parts.joints.replaceChildren(...joints.map((joint) => this.#jointBox(joint)));
    this.#setLines();
  }
  #limits = '';

  /** @param {string} id */
  #figureOf(id) {
    const found = this.figures.find(({ kind }) => kind.id === id);
    if (!found) throw new Error(`there is no plot ${id}`);
    return found;
  }

  /** @param {Joint} joint */
  #jointBox({ name, label }) {
    const box = document.createElement('input'), text = document.createElement('label');
    box.type = 'checkbox';
    box.value = name;
    box.checked = this.#chosen.includes(name);
    box.addEventListener('change', () => this.#chooseJoints());
    text.append(box, label);
    return text;
  }

  get chosen() {
    return this.#chosen;
  }

  /** Adds a joint, in the place of the oldest one if there is no line left, or takes it away.
   *  @param {string} name */
  toggle(name) {
    const others = this.#chosen.filter((each) => each !== name);
    this.choose(others.length < this.#chosen.length ? others : [...others.slice(1 - MOST_LINES), name]);
  }

  /** @param {readonly string[]} names  of joints */
  choose(names) {
    this.#chosen = names.slice(0, MOST_LINES);
    for (const box of this.#boxes()) box.checked = this.#chosen.includes(box.value);
    this.#setLines();
  }

  #boxes() {
    return [...this.parts.joints.querySelectorAll('input')];
  }

  #chooseJoints() {
    const chosen = this.#boxes().filter(({ checked }) => checked).map(({ value }) => value);
    // Those that are shown keep their line.
    this.#chosen = [...this.#chosen.filter((name) => chosen.includes(name)), ...chosen.filter((name) => !this.#chosen.includes(name))];
    this.#setLines();
  }

  #setLines() {
    const names = this.#chosen.flatMap((name) => this.#joints.find((joint) => joint.name === name) ?? []);
    const last = this.figures.length - 1;
    this.figures.forEach((figure, i) => figure.setLines(
      figure.kind.id === 'loads' ? names.map(({ name, label }) => ({ key: name, name: shortJoint(label) }))
        : [{ key: figure.kind.id, name: '' }], i === last));
    for (const box of this.#boxes()) box.disabled = !box.checked && names.length >= MOST_LINES;
    this.parts.chosen.textContent = names.length === 0 ? 'Choose joints' : names.map(({ label }) => shortJoint(label)).join(', ');
    this.#drawn = '';
  }

  /** @param {Person[]} people */
  setPeople(people) {
    this.#people = people;
  }

  get #person() {
    return this.page.person.of(this.#people);
  }

  get character() {
    return this.#person?.character;
  }

  get isVisible() {
    return this.parts.panel.clientWidth > 0;
  }

  /** What is to be loaded; nothing while the panel cannot be seen.
   *  @param {When} when
   *  @returns {Wanted[]} */
  wanted(when) {
    const person = this.#person;
    if (!this.isVisible || person === undefined || this.#joints.length === 0) return [];
    const width = 1e6 * this.window.secs / COLUMNS;
    const keys = [...this.#chosen, ...KINDS.slice(1).map(({ id }) => id), ...PLACES];
    const grid = { person: person.character, keys, width };
    if (JSON.stringify(grid) !== JSON.stringify(this.#series?.grid)) this.#series = new Series(grid);
    const { from, to } = this.window.at(when);
    return this.#series ? [{ series: this.#series, from, to }] : [];
  }

  forget() {
    this.#series = null;
    this.#drawn = '';
  }

  /** @param {import('./plot.js').Flag[]} flags  of all marks whose moments may be shown */
  setFlags(flags) {
    this.#flags = flags;
    for (const { plot } of this.figures) plot.setFlags(flags);
    this.#drawn = '';
  }
  /** @type {import('./plot.js').Flag[]} */ #flags = [];

  /** @param {When} when
   *  @param {import('./floor_plan.js').Now & {heading: number}} now  what is on the screen, of this person */
  draw(when, now) {
    const series = this.#series;
    if (series === null || !this.isVisible) return;
    this.#when = when;
    const window = { ...this.window.at(when), moment: when.moment, wallMillis: when.wallMillis };
    const drawn = JSON.stringify([window, window.wallMillis(0), series.changes, series.grid.person, this.parts.list.clientWidth, now]);
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    for (const { plot } of this.figures) plot.draw(series, window);
    this.plan.draw(this.#ways(series, window), now, now.heading);
    this.#showValues();
  }

  /** @param {Series} series
   *  @param {{from: number, moment: number}} window
   *  @returns {import('./floor_plan.js').Ways} */
  #ways(series, { from, moment }) {
    /** @type {import('./floor_plan.js').Ways} */ const ways = { com: [], cop: [] };
    for (let n = series.numberAt(from); n <= series.numberAt(moment); ++n) {
      const column = series.column(n);
      if (column === undefined || column.samples === 0) continue;
      for (const name of /** @type {const} */ (['com', 'cop'])) {
        const x = column.values[`${name}_x`].last, y = column.values[`${name}_y`].last;
        ways[name].push(x === null || y === null ? null : { x, y });
      }
    }
    return ways;
  }

  #showValues() {
    const series = this.#series, when = this.#when;
    if (series === null || when === null) return;
    for (const figure of this.figures) figure.showValues(series, this.#hover ?? when.moment, this.#hover !== null);
  }

  /** @param {'csv'|'png'} kind */
  async #save(kind) {
    const series = this.#series, when = this.#when, person = this.#person;
    if (series === null || when === null || person === undefined) return this.page.failed('There is nothing to save yet');
    const { from, to } = this.window.at(when);
    const about = {
      person: personLabel(person), source: [...trialsIn(this.#flags, from, to), this.page.source()].join(' · '), from, to,
      wallMillis: when.wallMillis, flags: this.#flags,
    };
    try {
      const parts = [...this.figures.map(({ title, plot }) => ({ title, canvas: plot.canvas, lines: plot.lines })),
        { title: 'CoM and CoP on the floor, from above', canvas: this.parts.plan, lines: [] }];
      const file = kind === 'csv' ? csvOf(series, about) : await pictureOf(parts, about, this.parts.panel);
      download(file, fileNameOf(about, kind));
    } catch (error) {
      this.page.failed(`Could not save the plots: ${error instanceof Error ? error.message : error}`);
    }
  }
}
