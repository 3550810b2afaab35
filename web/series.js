// The numbers of past samples, /api/v1/series: the smallest and largest value of each column of time. Columns lie on a
// fixed grid of the server's clock, so that a column that is over never changes, and only new ones are asked for.
// Pure, but for `Feed`, which asks the server.
import { readSeries } from './messages.js';
import { ask, messageOf } from './server_api.js';

/** A request has no more columns, and no more columns times keys, than the server permits (docs/http.md). */
const MOST_COLUMNS = 4096, MOST_VALUES = 20_000;
/** A column may still grow for so long after its end: the page hears of a sample before the series have it. */
const SETTLED_MICROS = 200_000;
/** Shorter gaps between samples are those of a slow stream. */
export const GAP_MICROS = 500_000;

/** @typedef {{min: number|null, max: number|null, last: number|null}} Value  null: unknown in all samples
 *  @typedef {{samples: number, values: Record<string, Value>}} Column
 *  @typedef {{person: number, keys: readonly string[], width: number}} Grid  width: of a column, µs
 *  @typedef {{first: number, end: number}} Span  numbers of columns, without the last: column n begins at n * width */

/** Columns of one person that the server has sent. */
export class Series {
  /** @type {Column[]} */ #columns = [];
  #first = 0;  // number of the first of them
  #settled = 0;  // number of the first column that may still grow
  #newest = -Infinity;  // moment of the newest sample when the last answer was asked for, µs
  changes = 0;  // grows with every answer

  /** @param {Grid} grid */
  constructor(grid) {
    this.grid = grid;
  }

  get hasSamples() {
    return this.#columns.some(({ samples }) => samples > 0);
  }

  /** @param {number} micros */
  numberAt(micros) {
    return Math.floor(micros / this.grid.width);
  }

  /** What is to be asked for next to have all columns from `from` to `to`; null: nothing is missing.
   *  @param {number} from  µs of the server's clock
   *  @param {number} to
   *  @param {number} newest  moment of the newest sample
   *  @returns {Span|null} */
  missing(from, to, newest) {
    const first = Math.max(0, this.numberAt(from)), end = this.numberAt(Math.min(to, newest)) + 1;
    const most = Math.min(MOST_COLUMNS, Math.floor(MOST_VALUES / this.grid.keys.length));
    const loaded = this.#first + this.#columns.length;
    const touches = this.#columns.length > 0 && first <= loaded && end >= this.#first;
    if (!touches) return { first: Math.max(first, end - most), end };
    if (this.#settled < end && newest !== this.#newest) return { first: this.#settled, end: Math.min(end, this.#settled + most) };
    if (first < this.#first) return { first: Math.max(first, this.#first - most), end: this.#first };
    return null;
  }

  /** @param {Span} span  that was asked for
   *  @param {Column[]} columns
   *  @param {number} newest  moment of the newest sample when it was asked for, µs */
  put(span, columns, newest) {
    const loaded = this.#first + this.#columns.length;
    const settled = Math.min(span.end, this.numberAt(newest - SETTLED_MICROS));
    ++this.changes;
    if (span.first >= this.#first) this.#newest = newest;
    if (this.#columns.length === 0 || span.first > loaded || span.end < this.#first) {
      this.#columns = columns;
      this.#first = span.first;
      this.#settled = Math.max(span.first, settled);
    } else if (span.first < this.#first) {
      this.#columns = [...columns, ...this.#columns.slice(Math.max(0, span.end - this.#first))];
      this.#first = span.first;
    } else {
      this.#columns.splice(span.first - this.#first, columns.length, ...columns);
      this.#settled = Math.max(this.#settled, settled);
    }
  }

  /** Forgets columns that the server forgets, too.
   *  @param {number} oldest  µs */
  forget(oldest) {
    const gone = Math.min(this.#columns.length, this.numberAt(oldest) - this.#first);
    if (gone <= 0) return;
    this.#columns.splice(0, gone);
    this.#first += gone;
  }

  /** @param {number} number
   *  @returns {Column|undefined} */
  column(number) {
    return this.#columns[number - this.#first];
  }

  /** The newest column with samples at a moment or shortly before.
   *  @param {number} micros
   *  @param {number} late  by which it may end before that, µs
   *  @returns {Column|undefined} */
  newest(micros, late) {
    const end = Math.min(this.numberAt(micros), this.#first + this.#columns.length - 1);
    for (let n = end; (n + 1) * this.grid.width > micros - late; --n) {
      const column = this.column(n);
      if (column === undefined || column.samples > 0) return column;
    }
    return undefined;
  }

  /** What is not sampled for GAP_MICROS or longer, between the first sample and `until`, with that many columns before.
   *  @param {number} number  of a column without samples
   *  @param {number} until  µs */
  isGap(number, until) {
    const least = Math.ceil(GAP_MICROS / this.grid.width);
    let before = number, after = number;
    const isEmpty = (/** @type {number} */ at) => this.column(at)?.samples === 0;
    while (isEmpty(before - 1) && number - before < least) --before;
    while (isEmpty(after + 1) && after - number < least && (after + 2) * this.grid.width <= until) ++after;
    return after - before + 1 >= least;
  }

  /** The worst of the columns that cover [from, to): the values at the largest and the smallest, and the samples.
   *  @param {number} from  µs
   *  @param {number} to
   *  @param {string} key
   *  @returns {{min: number, max: number, samples: number}|null}  null: not loaded, or nothing known */
  worst(from, to, key) {
    let min = Infinity, max = -Infinity, samples = 0;
    for (let n = this.numberAt(from); n * this.grid.width < to; ++n) {
      const column = this.column(n), value = column?.values[key];
      samples += column?.samples ?? 0;
      if (value === undefined || value.min === null || value.max === null) continue;
      min = Math.min(min, value.min);
      max = Math.max(max, value.max);
    }
    return max < min ? null : { min, max, samples };
  }
}

/** @param {import('./messages.js').SeriesAnswer} answer
 *  @returns {Column[]} */
export function columnsOf(answer) {
  const keys = Object.entries(answer.keys);
  return answer.samples.map((samples, i) => ({
    samples,
    values: Object.fromEntries(keys.map(([key, { min, max, last }]) => [key, { min: min[i], max: max[i], last: last[i] }])),
  }));
}

/** @param {Grid} grid
 *  @param {Span} span */
export const routeOf = (grid, { first, end }) => `api/v1/series?${new URLSearchParams({
  person: String(grid.person), keys: grid.keys.join(','), from: String(first * grid.width), to: String(end * grid.width),
  columns: String(end - first),
})}`;

/** @param {Grid} grid
 *  @param {Span} span
 *  @returns {Promise<Column[]|null>}  null if the server is unreachable
 *  @throws {Error} as `ask` does */
export async function load(grid, span) {
  const answer = await ask(routeOf(grid, span), readSeries);
  return answer && columnsOf(answer);
}

const REST_MILLIS = 400;  // from one round of requests to the next, and at least
const REST_MILLIS_EACH = 100;  // for each request of a round
const RETRY_MILLIS = 3000;  // after a rejection

/** @typedef {{series: Series, from: number, to: number}} Wanted  µs */

/** Asks for what series lack, in rounds: a request for each of them, and the next round when all answers have come. */
export class Feed {
  isComplete = false;  // whether nothing was missing at the last update
  #isAsking = false;
  #next = -Infinity;  // when the next round may begin, ms
  /** @type {WeakMap<Series, number>} */ #retryAt = new WeakMap();  // after a rejection, ms

  /** @param {(grid: Grid, span: Span) => Promise<Column[]|null>} [ask] */
  constructor(ask = load) {
    this.ask = ask;
  }

  /** Call it several times a second while the page is visible.
   *  @param {Wanted[]} wanted
   *  @param {number} newest  moment of the newest sample, µs
   *  @param {number} now  browser's clock, ms
   *  @returns {Promise<string>}  why a request was rejected; "" */
  async update(wanted, newest, now) {
    if (this.#isAsking || now < this.#next) return '';
    const missing = wanted.flatMap(({ series, from, to }) => {
      series.forget(from);
      const span = series.missing(from, to, newest);
      return span === null ? [] : [{ series, span }];
    });
    this.isComplete = missing.length === 0;
    const round = missing.filter(({ series }) => (this.#retryAt.get(series) ?? -Infinity) <= now);
    if (round.length === 0) return '';
    this.#isAsking = true;
    this.#next = now + Math.max(REST_MILLIS, REST_MILLIS_EACH * round.length);
    const reasons = await Promise.all(round.map(({ series, span }) => this.#load(series, span, newest, now)));
    this.#isAsking = false;
    return reasons.find((reason) => reason !== '') ?? '';
  }

  /** @param {Series} series
   *  @param {Span} span
   *  @param {number} newest
   *  @param {number} now
   *  @returns {Promise<string>} */
  async #load(series, span, newest, now) {
    try {
      const columns = await this.ask(series.grid, span);
      if (columns) series.put(span, columns, newest);
      return '';
    } catch (error) {
      this.#retryAt.set(series, now + RETRY_MILLIS);
      return messageOf(error);
    }
  }
}
