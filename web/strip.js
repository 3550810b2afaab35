// The strip of time: all moments that the server keeps, its right end is now. Per person each 2 px show the worst class
// of their samples, told by height besides colour: low is a base line, medium 22 to 60 % of the row by the number of
// joints, high the whole row, unknown hatched. Below are lost samples and gaps, and the clock.
import { flagsApart } from './flags.js';
import { Series } from './series.js';
import { theme } from './theme.js';

export const STRIP_KEYS = /** @type {const} */ (['high_joints', 'medium_joints', 'unknown_joints', 'loss']);
const LABEL_PX = 12, LEAST_LABEL_PX = 10, LABEL_GAP_PX = 0.5;  // smaller where rows are lower, with a gap between two names
const COLOR_PX = 5;  // of a person, beside the row
const SIGN_PX = 21;  // of a mark, two letters
const COLUMN_PX = 2, GUTTER_PX = 58, RIGHT_PX = 8, AXIS_PX = 16, MARKS_PX = 18, LOSS_PX = 13, ALARMS_PX = 8;
const LOW_PX = 64;  // below this height people and alarms have all of it
const MOST_ROWS = 6;  // the last one has the worst of all further people
/** The strip covers one of these times, so that it does not move with each sample while the history grows. */
const SPANS_SECS = [10, 20, 30, 60, 120, 180, 300, 600, 900, 1200, 1800, 2700, 3600];
const SPARE = 1.01;  // a history of ten minutes keeps a second or two more
const MOST_COLUMNS = 2400, LEAST_WIDTH = 50_000;
const MANY_JOINTS = 8;  // more than half of them
const MEDIUM_LEAST = 0.22, MEDIUM_MOST = 0.6, MEDIUM_JOINTS = 10;  // a medium column by its joints, of the row
const MOST_LOSS = 0.08;  // fills the row

/** @typedef {{high: number, medium: number, isUnknown: boolean, loss: number}} Look  numbers of joints; share of samples
 *  @typedef {{micros: number, endMicros: number|null, label: string}} Mark  endMicros: of a span
 *  @typedef {{character: number, label: string, color: number}} StripPerson  color: number of the person's colour
 *  @typedef {{label: string, color: number|null, series: Series[]}} Row  color: null: of several people
 *  @typedef {import('./messages.js').Alarm} Alarm
 *  @typedef {{oldest: number, newest: number, moment: number, isLive: boolean, wallMillis: (micros: number) => number}} When
 *    µs of the server's clock; wallMillis: the time of day of a moment, ms
 *  @typedef {{text: string, px: number, y: number, top: number, bottom: number}} Label  px: of the font; y: of
 *    its middle; top, bottom: of its letters */

/** @param {number} micros  length of the history
 *  @returns {number}  that the strip covers, µs */
export const spanOf = (micros) =>
  Math.round(SPARE * 1e6 * (SPANS_SECS.find((secs) => SPARE * secs * 1e6 >= micros) ?? Math.ceil(micros / 1e6)));

/** @param {number} span
 *  @returns {number}  width of the columns that are asked for, µs */
export const widthOf = (span) => Math.max(LEAST_WIDTH, Math.ceil(span / MOST_COLUMNS / 1000) * 1000);

/** The worst of all samples from `from` to `to`.
 *  @param {Series[]} all  of the people of one row
 *  @param {number} from  µs
 *  @param {number} to
 *  @returns {Look|null}  null: no sample */
export function worstOf(all, from, to) {
  const looks = all.flatMap((series) => lookOf(series, from, to) ?? []);
  if (looks.length === 0) return null;
  const most = (/** @type {'high'|'medium'|'loss'} */ name) => Math.max(...looks.map((look) => look[name]));
  return { high: most('high'), medium: most('medium'), loss: most('loss'), isUnknown: looks.some(({ isUnknown }) => isUnknown) };
}

/** @param {Series} series
 *  @param {number} from
 *  @param {number} to
 *  @returns {Look|null} */
function lookOf(series, from, to) {
  const [high, medium, unknown, loss] = STRIP_KEYS.map((key) => series.worst(from, to, key)?.max ?? null);
  if (unknown === null) return null;
  return { high: high ?? 0, medium: medium ?? 0, isUnknown: unknown >= MANY_JOINTS, loss: loss ?? 0 };
}

/** Those that have room beside the ones before them.
 *  @template {{top: number, bottom: number}} L
 *  @param {readonly L[]} labels
 *  @returns {L[]} */
export function labelsThatFit(labels) {
  /** @type {L[]} */ const fitting = [];
  for (const label of labels) {
    const isApart = fitting.every(({ top, bottom }) => label.top >= bottom + LABEL_GAP_PX || label.bottom <= top - LABEL_GAP_PX);
    if (isApart) fitting.push(label);
  }
  return fitting;
}

/** The text, or its beginning and an ellipsis.
 *  @param {string} text
 *  @param {number} most  px
 *  @param {(text: string) => number} widthOf  px */
export function shortened(text, most, widthOf) {
  if (widthOf(text) <= most) return text;
  const letters = [...text];
  while (letters.length > 0 && widthOf(`${letters.join('')}…`) > most) letters.pop();
  return `${letters.join('')}…`;
}

/** "high", "medium", "unknown", "low"; "no samples".
 *  @param {Look|null} look */
export const wordOf = (look) =>
  (look === null ? 'no samples' : look.high > 0 ? 'high' : look.medium > 0 ? 'medium' : look.isUnknown ? 'unknown' : 'low');

/** Part of the row that says the class; 0: only a base line.
 *  @param {Look} look */
export function heightOf({ high, medium }) {
  if (high > 0) return 1;
  if (medium === 0) return 0;
  return MEDIUM_LEAST + (MEDIUM_MOST - MEDIUM_LEAST) * Math.min(1, (medium - 1) / (MEDIUM_JOINTS - 1));
}

export class Strip {
  /** @type {Map<number, Series>} */ #series = new Map();  // by person
  /** @type {Mark[]|null} */ #marks = null;
  /** @type {Alarm[]} */ #alarms = [];  // newest first
  #drawn = '';

  /** @param {{canvas: HTMLCanvasElement, slider: HTMLInputElement}} parts  the slider lies over the kept moments */
  constructor(parts) {
    this.parts = parts;
    theme?.follow(() => { this.#drawn = ''; });
  }

  /** Flags in a row of their own, which is there from the first call on.
   *  @param {Mark[]} marks */
  setMarks(marks) {
    this.#marks = marks;
    this.#drawn = '';
  }

  /** Bars over the time that they were on.
   *  @param {Alarm[]} alarms  newest first */
  setAlarms(alarms) {
    if (JSON.stringify(alarms.map(signOf)) === JSON.stringify(this.#alarms.map(signOf))) return;
    this.#alarms = alarms;
    this.#drawn = '';
  }

  forget() {
    this.#series.clear();
    this.#drawn = '';
  }

  /** @param {number} character */
  hasSamplesOf(character) {
    return this.#series.get(character)?.hasSamples ?? false;
  }

  /** What is to be loaded.
   *  @param {{character: number}[]} people
   *  @param {{oldest: number, newest: number}} kept  µs
   *  @returns {import('./series.js').Wanted[]} */
  wanted(people, { oldest, newest }) {
    const width = widthOf(spanOf(newest - oldest));
    for (const character of this.#series.keys()) {
      if (!people.some((each) => each.character === character)) this.#series.delete(character);
    }
    for (const { character } of people) {
      if (this.#series.get(character)?.grid.width === width) continue;
      this.#series.set(character, new Series({ person: character, keys: STRIP_KEYS, width }));
    }
    return [...this.#series.values()].map((series) => ({ series, from: oldest, to: newest }));
  }

  /** @param {StripPerson[]} people
   *  @returns {Row[]} */
  #rows(people) {
    const rows = people.map(({ character, label, color }) => ({ label, color, series: [this.#series.get(character) ?? []].flat() }));
    const rest = rows.slice(MOST_ROWS - 1);
    if (rest.length < 2) return rows;
    return [...rows.slice(0, MOST_ROWS - 1), { label: `+ ${rest.length}`, color: null, series: rest.flatMap(({ series }) => series) }];
  }

  /** The worst classes at a moment in words: "Anna high, Ben low".
   *  @param {StripPerson[]} people
   *  @param {number} micros */
  wordsAt(people, micros) {
    return this.#rows(people).filter(({ series }) => series.length > 0).map(({ label, series }) => {
      const from = Math.floor(micros / series[0].grid.width) * series[0].grid.width;
      return `${label} ${wordOf(worstOf(series, from, from + series[0].grid.width))}`;
    }).join(', ');
  }

  /** @param {StripPerson[]} people
   *  @param {When} when */
  draw(people, when) {
    const { canvas, slider } = this.parts;
    const width = canvas.clientWidth, height = canvas.clientHeight, dpr = devicePixelRatio || 1;
    const inner = Math.floor((width - GUTTER_PX - RIGHT_PX) / COLUMN_PX) * COLUMN_PX;
    if (inner <= 0 || height <= 0) return;
    const rows = this.#rows(people);
    const changes = rows.map(({ label, series }) => [label, ...series.map((each) => each.changes)]);
    const drawn = JSON.stringify([width, height, dpr, when, when.wallMillis(0), changes]);
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    const span = spanOf(when.newest - when.oldest), right = GUTTER_PX + inner;
    const xOf = (/** @type {number} */ micros) => right - (when.newest - micros) / span * inner;
    slider.style.left = `${xOf(when.oldest)}px`;
    slider.style.width = `${right - xOf(when.oldest)}px`;
    if (canvas.width !== Math.round(width * dpr) || canvas.height !== Math.round(height * dpr)) {
      canvas.width = Math.round(width * dpr);
      canvas.height = Math.round(height * dpr);
    }
    const context = canvas.getContext('2d');
    if (context === null) return;
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.clearRect(0, 0, width, height);
    new Painter(context, getComputedStyle(canvas), { right, inner, height, span, when, xOf }).paint(rows, this.#marks, this.#alarms);
  }
}

/** What of an alarm the strip shows.
 *  @param {Alarm} alarm */
const signOf = ({ id, over }) => [id, over?.micros ?? null];

/** @typedef {{right: number, inner: number, height: number, span: number, when: When, xOf: (micros: number) => number}} Frame
 *    right: of the rows, px; inner: their width */

/** Draws one picture of the strip. */
class Painter {
  /** @param {CanvasRenderingContext2D} context
   *  @param {CSSStyleDeclaration} style  has the colours
   *  @param {Frame} frame */
  constructor(context, style, frame) {
    this.context = context;
    this.style = style;
    this.frame = frame;
    this.font = style.fontFamily;
  }

  /** @param {string} name */
  #use(name) {
    this.context.fillStyle = this.style.getPropertyValue(`--${name}`);
  }

  /** @param {Row[]} rows
   *  @param {Mark[]|null} marks
   *  @param {Alarm[]} alarms */
  paint(rows, marks, alarms) {
    const { context, frame } = this;
    context.textBaseline = 'middle';
    const isLow = frame.height < LOW_PX, bottom = frame.height - AXIS_PX;
    const top = marks === null || isLow ? 0 : MARKS_PX, losses = bottom - ALARMS_PX - (isLow ? 0 : LOSS_PX);
    const each = (losses - top) / Math.max(1, rows.length);
    const px = Math.min(LABEL_PX, Math.max(LEAST_LABEL_PX, Math.floor(each - LABEL_GAP_PX)));
    const isNamed = this.#labels([
      ...(top > 0 ? [this.#labelOf('Marks', MARKS_PX / 2, LABEL_PX)] : []),
      ...(isLow ? [] : [this.#labelOf('Lost', losses + LOSS_PX / 2 - 1, LABEL_PX)]),
      ...rows.map(({ label }, i) => this.#labelOf(label, top + (i + 0.5) * each - 0.5, px)),
    ]);
    rows.forEach((row, i) => this.#row(row, top + i * each + 1, each - 3, !isNamed));
    if (!isLow) this.#losses(rows, losses, LOSS_PX - 2);
    this.#alarms(alarms, bottom - ALARMS_PX);
    this.#clock(bottom);
    this.#playhead(bottom);
    if (marks !== null && !isLow) this.#flags(marks);
  }

  /** Names at the left. Those that would touch the ones before them are left out.
   *  @param {Label[]} labels
   *  @returns {boolean} whether all are drawn */
  #labels(labels) {
    const { context } = this, fitting = labelsThatFit(labels);
    context.textAlign = 'left';
    this.#use('quiet');
    for (const { text, px, y } of fitting) {
      context.font = `${px}px ${this.font}`;
      context.fillText(text, 0, y);
    }
    return fitting.length === labels.length;
  }

  /** @param {string} label
   *  @param {number} middle  px
   *  @param {number} px  of the font
   *  @returns {Label} */
  #labelOf(label, middle, px) {
    const { context } = this;
    context.font = `${px}px ${this.font}`;
    const text = shortened(label, GUTTER_PX - COLOR_PX - 2, (part) => context.measureText(part).width);
    const { actualBoundingBoxAscent: above, actualBoundingBoxDescent: below } = context.measureText(text);
    const capital = context.measureText('M');  // the middle of a font is above that of its capitals
    const centred = middle + (capital.actualBoundingBoxAscent - capital.actualBoundingBoxDescent) / 2;
    const y = Math.max(centred, above);  // not above the strip
    return { text, px, y, top: y - above, bottom: y + below };
  }

  /** Columns from the left to the right: where they are, and the time that they cover.
   *  @param {(x: number, from: number, to: number) => void} draw */
  #columns(draw) {
    const { right, inner, span, when } = this.frame;
    const width = span / (inner / COLUMN_PX), newest = Math.floor(when.newest / width);
    for (let x = right - COLUMN_PX, n = newest; x >= right - inner; x -= COLUMN_PX, --n) {
      if ((n + 1) * width <= when.oldest) return;
      draw(x, n * width, (n + 1) * width);
    }
  }

  /** @param {Row} row
   *  @param {number} top
   *  @param {number} height
   *  @param {boolean} hasColor  that of its person, as names are missing */
  #row({ series, color }, top, height, hasColor) {
    const { context, frame } = this;
    if (hasColor && color !== null) {
      this.#use(`person-${color}`);
      context.fillRect(GUTTER_PX - COLOR_PX, top, COLOR_PX - 1, height);
    }
    this.#use('track');
    const left = Math.max(frame.right - frame.inner, frame.xOf(frame.when.oldest));
    context.fillRect(left, top, frame.right - left, height);
    /** @type {Look|null} */ let after = null;  // of the column on the right: a slow stream has columns without samples
    this.#columns((x, from, to) => {
      const look = worstOf(series, from, to) ?? (this.#isGap(series, from) ? null : after);
      after = look;
      if (look === null) return;
      if (look.isUnknown) {
        this.#use('class-unknown');
        for (let y = x % 6; y < height; y += 6) context.fillRect(x, top + y, COLUMN_PX, Math.min(2, height - y));
      }
      this.#use('class-low');
      context.fillRect(x, top + height - 2, COLUMN_PX, 2);
      const part = heightOf(look);
      if (part === 0) return;
      this.#use(part === 1 ? 'class-high' : 'class-medium');
      context.fillRect(x, top + height * (1 - part), COLUMN_PX, height * part);
    });
  }

  /** @param {Series[]} all
   *  @param {number} micros */
  #isGap(all, micros) {
    return all.length > 0 && all.every((series) => {
      const number = series.numberAt(micros);
      return series.column(number)?.samples === 0 && series.isGap(number, this.frame.when.newest);
    });
  }

  /** @param {Row[]} rows
   *  @param {number} top
   *  @param {number} height */
  #losses(rows, top, height) {
    const { context, frame } = this;
    const all = rows.flatMap(({ series }) => series);
    this.#use('line');
    context.fillRect(frame.right - frame.inner, top + height, frame.inner, 1);
    this.#use('loss');
    this.#columns((x, from, to) => {
      const loss = worstOf(all, from, to)?.loss ?? 0;
      if (loss > 0) {
        const tall = Math.max(3, Math.min(1, loss / MOST_LOSS) * height);
        context.fillRect(x, top + height - tall, COLUMN_PX, tall);
      } else if (this.#isGap(all, from)) {
        for (let y = x % 4; y < height; y += 4) context.fillRect(x, top + y, COLUMN_PX, Math.min(2, height - y));
      }
    });
  }

  /** @param {Alarm[]} alarms
   *  @param {number} top */
  #alarms(alarms, top) {
    const { context, frame: { when, xOf, right, inner } } = this;
    for (const { began, over, priority } of [...alarms].reverse()) {
      const until = over?.micros ?? when.newest;
      if (until < when.oldest) continue;
      const from = Math.max(right - inner, xOf(Math.max(began.micros, when.oldest)));
      this.#use(`alarm-${priority}`);
      context.fillRect(from, top + 1, Math.max(3, xOf(until) - from), ALARMS_PX - 3);
    }
  }

  /** @param {number} top */
  #clock(top) {
    const { context, frame: { right, inner, span, when, xOf } } = this;
    const steps = [2, 5, 10, 30, 60, 120, 300, 600, 1200].map((secs) => 1000 * secs);
    const step = steps.find((millis) => millis * 1000 / span * inner >= 76) ?? 3_600_000;
    const shift = 60_000 * new Date(when.wallMillis(when.newest)).getTimezoneOffset();
    const first = Math.ceil((when.wallMillis(when.oldest) - shift) / step) * step + shift;
    context.font = `11px ${this.font}`;
    context.textAlign = 'center';
    this.#use('quiet');
    const offset = when.wallMillis(0);
    for (let wall = first; wall <= when.wallMillis(when.newest); wall += step) {
      const x = xOf(1000 * (wall - offset));
      if (x < GUTTER_PX + 26 || x > right - 64) continue;
      context.fillRect(Math.round(x), top, 1, 3);
      context.fillText(clockText(wall, step), x, top + AXIS_PX / 2 + 2);
    }
    this.#use('ink');
    context.font = `700 11px ${this.font}`;
    context.textAlign = 'right';
    context.fillText('now', right, top + AXIS_PX / 2 + 2);
  }

  /** What lies between the playhead and now has the colour of the mode, too: the lag is a length.
   *  @param {number} height */
  #playhead(height) {
    const { context, frame: { right, inner, when, xOf } } = this;
    const x = Math.min(right - 1, Math.max(right - inner + 1, xOf(when.moment)));
    this.#use('mode');
    if (!when.isLive) {
      context.globalAlpha = 0.16;
      context.fillRect(x, 0, right - x, height);
      context.globalAlpha = 1;
    }
    context.fillRect(x - 1.25, 0, 2.5, height);
    context.beginPath();
    context.moveTo(x - 7, 0);
    context.lineTo(x + 7, 0);
    context.lineTo(x, 9);
    context.fill();
  }

  /** @param {Mark[]} marks */
  #flags(marks) {
    const { context, frame: { when, xOf, right } } = this;
    context.font = `700 11px ${this.font}`;
    context.textAlign = 'center';
    for (const { micros, endMicros, label, hasRoom } of flagsApart(marks, { from: when.oldest, to: when.newest }, xOf, SIGN_PX)) {
      if (endMicros !== null) {
        const from = Math.max(xOf(micros), xOf(when.oldest));
        this.#use('quiet');
        context.fillRect(from, MARKS_PX - 4, Math.max(2, xOf(endMicros) - from), 3);
      }
      if (micros < when.oldest) continue;
      const x = Math.round(xOf(micros)), text = [...label].slice(0, 2).join('') || '•';
      this.#use('quiet');
      context.fillRect(x - 1, 1, 2, MARKS_PX - 1);
      if (!hasRoom) continue;
      const wide = 6 + 7 * [...text].length, left = Math.min(x, right - wide);
      context.fillRect(left, 1, wide, MARKS_PX - 4);
      this.#use('panel');
      context.fillText(text, left + wide / 2, MARKS_PX / 2);
    }
  }
}

/** "10:31", or "10:31:20" where a minute has several labels.
 *  @param {number} wall  ms; NaN: not known
 *  @param {number} step  ms from label to label */
export function clockText(wall, step) {
  if (Number.isNaN(wall)) return '–';
  const time = new Date(wall);
  const parts = [time.getHours(), time.getMinutes(), ...(step < 60_000 ? [time.getSeconds()] : [])];
  return parts.map((part) => String(part).padStart(2, '0')).join(':');
}
