// The list of joint loads, in order of severity.
import { age, limitPercent, moment, percent, personLabel } from './format.js';
import { LOAD_CLASSES } from './messages.js';

/** @typedef {import('./messages.js').LoadClass} LoadClass
 *  @typedef {import('./messages.js').Secs} Secs
 *  @typedef {{key: string, label: string, loadClass: LoadClass, ratio: number, moment: number,
 *    capacity: number, channel: string, reason: string, isExternal?: boolean, secs?: Secs, heldTo?: number}} Row
 *    heldTo: the ratio below which the class falls, of a load that is below the limit of its class; else NaN */

const RANK = { high: 0, medium: 1, low: 2, unknown: 3 };

/** Rows whose ratios differ by less keep their order, so that the list can be read while the numbers fluctuate. */
const CALM = 0.02;

/** @param {Row} a
 *  @param {Row} b */
function isMoreUrgent(a, b) {
  if (a.loadClass !== b.loadClass) return RANK[a.loadClass] < RANK[b.loadClass];
  return Number.isFinite(a.ratio) && !(b.ratio >= a.ratio - CALM);
}

/** Highest class first, within a class the largest ratio. Starts from the order shown before.
 *  @param {Row[]} rows
 *  @param {string[]} shownKeys  in the order shown before
 *  @returns {Row[]} */
export function byUrgency(rows, shownKeys = []) {
  const place = new Map(shownKeys.map((key, i) => [key, i]));
  const at = (/** @type {Row} */ row) => place.get(row.key) ?? shownKeys.length;
  const sorted = [...rows].sort((a, b) => at(a) - at(b));
  for (let i = 1; i < sorted.length; ++i) {
    for (let k = i; k > 0 && isMoreUrgent(sorted[k], sorted[k - 1]); --k) {
      [sorted[k - 1], sorted[k]] = [sorted[k], sorted[k - 1]];
    }
  }
  return sorted;
}

/** The second line of a row: moment, capacity and direction, or why the load is unknown.
 *  @param {Row} row */
export function explain(row) {
  if (row.loadClass === 'unknown' && row.reason) return row.reason;
  const now = moment(row.moment, row.capacity); // of this sample; the percentage beside it is held
  const held = Number.isFinite(row.heldTo) ? `${row.loadClass} until below ${limitPercent(row.heldTo ?? NaN)}` : '';
  const amount = [held, now && `now ${now}`].filter(Boolean).join(', ');
  const channel = row.isExternal && row.channel !== 'external' ? `${row.channel}, external` : row.channel;
  return channel && amount ? `${amount}, ${channel}` : amount || channel;
}

/** "low 40 s, medium 12 s, high 3 s since the first sample", without classes below 1 s; "" if there are no others.
 *  @param {Secs|undefined} secs */
export function exposureText(secs) {
  if (!secs) return '';
  const parts = LOAD_CLASSES.filter((name) => secs[name] >= 1).map((name) => `${name} ${age(secs[name])}`);
  return parts.length > 0 ? `${parts.join(', ')} since the first sample` : '';
}

/** Widths of the exposure strip: shares of the time, which add up to 1; all 0 at the start.
 *  @param {Secs|undefined} secs
 *  @returns {number[]}  low, medium, high, unknown */
export function exposureShares(secs) {
  const all = secs ? LOAD_CLASSES.reduce((sum, name) => sum + secs[name], 0) : 0;
  return LOAD_CLASSES.map((name) => (secs && all > 0 ? secs[name] / all : 0));
}

/** @param {{loadClass: LoadClass, ratio: number}} load
 *  @param {{class_limits: number[], class_falls_below: number[]}} limits */
function heldTo({ loadClass, ratio }, limits) {
  const border = ['medium', 'high'].indexOf(loadClass);
  return border >= 0 && ratio <= limits.class_limits[border] ? limits.class_falls_below[border] : NaN;
}

/** The rows of a state. With several people, each row has the name of the person.
 *  @param {import('./state_codec.js').State} state
 *  @param {{label: string}[]} joints
 *  @param {{people: import('./messages.js').PersonDetails[], class_limits: number[], class_falls_below: number[]}} details
 *  @returns {Row[]} */
export function rowsOf(state, joints, details) {
  const several = state.people.length > 1;
  return state.people.flatMap((person) => {
    const its = details.people.find(({ character }) => character === person.character);
    const who = several ? `${personLabel({ character: person.character, name: its?.name ?? '' })}: ` : '';
    return person.loads.map((load) => {
      const words = its?.loads.find(({ joint }) => joint === load.joint);
      return {
        key: `${person.character}/${load.joint}`,
        label: `${who}${joints[load.joint]?.label ?? `joint ${load.joint}`}`,
        loadClass: load.loadClass,
        ratio: load.ratio,
        moment: load.moment,
        capacity: load.capacity,
        channel: words?.channel ?? '',
        reason: words?.reason ?? '',
        isExternal: words?.is_external ?? false,
        secs: words?.secs_in_band,
        heldTo: heldTo(load, details),
      };
    });
  });
}

/** The row of a person without live data: the load is unknown.
 *  @param {Row} row
 *  @returns {Row} */
export const asUnknown = (row) =>
  ({ ...row, loadClass: 'unknown', ratio: NaN, moment: NaN, heldTo: NaN, reason: row.reason || 'no live data' });

/** @param {HTMLElement} list  an <ol>
 *  @returns {(rows: Row[]) => void} function that shows these rows */
export function mountLoadList(list) {
  /** @type {Map<string, RowElements>} */
  const shown = new Map();
  let order = /** @type {string[]} */ ([]);
  return (rows) => {
    const sorted = byUrgency(rows, order);
    const keys = sorted.map(({ key }) => key);
    for (const row of sorted) {
      if (!shown.has(row.key)) shown.set(row.key, new RowElements());
      shown.get(row.key)?.show(row);
    }
    if (keys.join() === order.join()) return;
    for (const key of shown.keys()) if (!keys.includes(key)) shown.delete(key);
    order = keys;
    list.replaceChildren(...keys.flatMap((key) => shown.get(key)?.element ?? []));
  };
}

/** @param {string} className */
function makeSpan(className) {
  const span = document.createElement('span');
  span.className = className;
  return span;
}

/** @param {HTMLElement} part
 *  @param {string} text */
function setText(part, text) {
  if (part.textContent !== text) part.textContent = text;
}

/** The elements of one row. Bar and strip are hidden from screen readers: ratio and title have the same content. */
class RowElements {
  element = document.createElement('li');
  #label = makeSpan('label');
  #note = makeSpan('note');
  #loadClass = makeSpan('word');
  #ratio = makeSpan('ratio');
  #fill = makeSpan('fill');
  #exposure = LOAD_CLASSES.map((name) => {
    const share = makeSpan('share');
    share.dataset.class = name;
    return share;
  });

  constructor() {
    const bar = makeSpan('bar');
    bar.append(this.#fill);
    const strip = makeSpan('exposure');
    strip.append(...this.#exposure);
    for (const part of [bar, strip]) part.ariaHidden = 'true';
    this.element.append(this.#label, this.#note, this.#loadClass, this.#ratio, bar, strip);
  }

  /** @param {Row} row */
  show(row) {
    this.element.dataset.class = row.loadClass;
    setText(this.#label, row.label);
    setText(this.#note, explain(row));
    setText(this.#loadClass, row.loadClass);
    setText(this.#ratio, percent(row.ratio));
    const filled = Number.isFinite(row.ratio) ? Math.min(1, Math.max(0, row.ratio)) : 0;
    this.#fill.style.transform = `scaleX(${filled.toFixed(3)})`;
    const title = [explain(row), exposureText(row.secs)].filter(Boolean).join('\n');
    if (this.element.title !== title) this.element.title = title;
    exposureShares(row.secs).forEach((share, i) => {
      const grow = share.toFixed(3);
      if (this.#exposure[i].style.flexGrow !== grow) this.#exposure[i].style.flexGrow = grow;
    });
  }
}

/** Class and text of each entry of the legend.
 *  @param {number[]} limits  the two load ratios at which a rising load becomes medium and high */
export function legendWords(limits) {
  return [
    ['low', 'low'],
    ['medium', `medium > ${limitPercent(limits[0])}`],
    ['high', `high > ${limitPercent(limits[1])}`],
    ['unknown', 'unknown'],
  ];
}

/** @param {HTMLElement} legend  a <ul>
 *  @param {number[]} limits */
export function fillLegend(legend, limits) {
  legend.replaceChildren(...legendWords(limits).map(([loadClass, text]) => {
    const entry = document.createElement('li');
    entry.dataset.class = loadClass;
    entry.textContent = text;
    return entry;
  }));
}
