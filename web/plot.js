// One plot of values over time, drawn by uPlot: lines with names and dashes, class bands, limits, gaps, and a playhead
// that the other plots and the 3-D view share. Click or drag moves the viewer's time; hovering shows the values.
import uPlot from 'uplot';
import { flagsApart } from './flags.js';
import { GAP_MICROS } from './series.js';
import { clockText } from './strip.js';

export const DASHES = [[], [7, 4], [2, 3], [10, 3, 2, 3]];  // of the lines, in the order of --line-1 to --line-4
const AXIS_PX = 44, CLOCK_PX = 22, LINE_PX = 1.75;
const SHARED_CURSOR = 'time';

/** @typedef {{key: string, name: string}} Line
 *  @typedef {{id: string, title: string, unit: string, factor: number, digits: number, least: number[], height: number,
 *    hint?: string}} Kind
 *    factor: of the server's unit; least: range that the axis always has, in `unit`
 *  @typedef {{value: number, tone: string}} Limit  in the plot's unit; tone: of the class colour
 *  @typedef {{from: number, to: number, moment: number, wallMillis: (micros: number) => number}} Window  µs
 *  @typedef {{onSeek: (micros: number) => void, onHover: (micros: number|null) => void}} Events */

/** @typedef {{micros: number, endMicros: number|null, label: string, text: string, isTrial: boolean}} Flag
 *    of a mark; endMicros: of a span that is over */

/** A round number that is at least `value`, so that the axis does not change with each sample.
 *  @param {number} value  > 0 */
export function roundedUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * (STEPS.find((step) => step * power >= value * (1 - 1e-9)) ?? 10);
}
const STEPS = [1, 1.5, 2, 3, 4, 5, 6, 8, 10];

/** Two points for each column, its smallest and its largest value: the one that continues the line comes first.
 *  @param {import('./series.js').Series} series
 *  @param {string[]} keys
 *  @param {{from: number, to: number}} window
 *  @param {number} factor
 *  @returns {[number[], ...(number|null|undefined)[][]]}  times, and values by key: null is a gap, undefined no point */
export function pointsOf(series, keys, { from, to }, factor) {
  const { width } = series.grid, first = series.numberAt(from) - 1, end = series.numberAt(to) + 2;
  /** @type {number[]} */ const times = [];
  /** @type {(number|null|undefined)[][]} */ const values = keys.map(() => []);
  const before = keys.map(() => NaN);
  for (let n = first; n < end; ++n) {
    const column = series.column(n);
    times.push((n + 0.25) * width, (n + 0.75) * width);
    keys.forEach((key, i) => {
      const value = column?.values[key];
      if (value === undefined || value.min === null || value.max === null) {
        const isShort = column?.samples === 0 && width < GAP_MICROS && !series.isGap(n, to);
        values[i].push(isShort ? undefined : null, isShort ? undefined : null);
        return;
      }
      const pair = [factor * value.min, factor * value.max];
      if (Math.abs(before[i] - pair[1]) < Math.abs(before[i] - pair[0])) pair.reverse();
      before[i] = pair[1];
      values[i].push(...pair);
    });
  }
  return [times, ...values];
}

export class Plot {
  /** @type {uPlot|null} */ #chart = null;
  /** @type {Line[]} */ #lines = [];
  /** @type {Limit[]} */ #limits = [];
  /** @type {Window} */ #window = { from: 0, to: 1, moment: 0, wallMillis: (micros) => micros / 1000 };
  /** @type {Flag[]} */ #flags = [];
  #hasClock = false;

  /** @param {HTMLElement} box  becomes as wide as its parent lets it
   *  @param {Kind} kind
   *  @param {Events} events */
  constructor(box, kind, events) {
    this.box = box;
    this.kind = kind;
    this.events = events;
  }

  get canvas() {
    return this.#chart?.ctx.canvas ?? null;
  }

  get lines() {
    return this.#lines;
  }

  /** @param {Line[]} lines
   *  @param {boolean} hasClock  the lowest plot has the time of day */
  setLines(lines, hasClock) {
    this.#lines = lines;
    this.#hasClock = hasClock;
    this.#chart?.destroy();
    this.#chart = null;
  }

  /** Bands above the limits, in class colours.
   *  @param {Limit[]} limits */
  setLimits(limits) {
    this.#limits = limits;
  }

  /** Lines at the moments of marks.
   *  @param {Flag[]} flags */
  setFlags(flags) {
    this.#flags = flags;
  }

  /** @param {import('./series.js').Series} series
   *  @param {Window} window */
  draw(series, window) {
    const width = this.box.clientWidth;
    if (width === 0 || this.#lines.length === 0) return;
    this.#window = window;
    const height = this.kind.height + (this.#hasClock ? CLOCK_PX : 0);
    const data = /** @type {uPlot.AlignedData} */ (
      pointsOf(series, this.#lines.map(({ key }) => key), window, this.kind.factor));
    if (this.#chart === null) {
      this.#chart = new uPlot(this.#options(width, height), data, this.box);
      this.#listen(this.#chart);
    } else if (this.#chart.width !== width) {
      this.#chart.setSize({ width, height });
    }
    const chart = this.#chart;
    chart.batch(() => {
      chart.setData(data, false);
      chart.setScale('x', { min: window.from, max: window.to });
      chart.setScale('y', this.#range(data));
    });
  }

  /** Only the playhead, or the colours, have changed.
   *  @param {number} moment */
  movePlayhead(moment) {
    this.#window = { ...this.#window, moment };
    this.#chart?.redraw(false, false);
  }

  recolor() {
    this.#chart?.redraw(false, true);
  }

  /** @param {uPlot.AlignedData} data */
  #range([, ...values]) {
    let [min, max] = this.kind.least;
    for (const line of values) {
      for (const value of line) {
        if (value === null || value === undefined) continue;
        min = Math.min(min, value);
        max = Math.max(max, value);
      }
    }
    return { min: min < 0 ? -roundedUp(-min) : 0, max: roundedUp(max) };
  }

  /** @param {string} name */
  #color(name) {
    return getComputedStyle(this.box).getPropertyValue(`--${name}`);
  }

  /** @param {number} width
   *  @param {number} height
   *  @returns {uPlot.Options} */
  #options(width, height) {
    const font = `11px ${getComputedStyle(this.box).fontFamily}`;
    const quiet = () => this.#color('quiet');
    const grid = { stroke: () => this.#color('line'), width: 1 };
    return {
      width, height, legend: { show: false }, padding: [6, 8, this.#hasClock ? 0 : 4, 0],
      scales: { x: { time: false, auto: false }, y: { auto: false } },
      cursor: { y: false, drag: { x: false, y: false }, sync: { key: SHARED_CURSOR }, points: { size: 7 } },
      axes: [
        {
          show: this.#hasClock, size: CLOCK_PX, font, stroke: quiet, grid, ticks: { show: false }, gap: 4,
          splits: () => clockSplits(this.#window), values: (_, splits) => splits.map((at) => clockLabel(at, this.#window)),
        },
        { size: AXIS_PX, font, stroke: quiet, grid, ticks: { show: false }, gap: 5, space: 24 },
      ],
      series: [{}, ...this.#lines.map((line, i) => ({
        label: line.name, stroke: () => this.#color(`line-${i + 1}`), width: LINE_PX, dash: DASHES[i], points: { show: false },
      }))],
      hooks: {
        drawClear: [(chart) => this.#drawBands(chart)],
        draw: [(chart) => this.#drawPlayhead(chart)],
        setCursor: [(chart) => {
          const { left } = chart.cursor;
          this.events.onHover(left === undefined || left < 0 ? null : chart.posToVal(left, 'x'));
        }],
      },
    };
  }

  /** @param {uPlot} chart */
  #listen({ over }) {
    let isDown = false;
    const seek = (/** @type {PointerEvent} */ event) => {
      const { left, width } = over.getBoundingClientRect(), { from, to } = this.#window;
      const part = Math.max(0, Math.min(1, (event.clientX - left) / width));
      this.events.onSeek(from + part * (to - from));
    };
    over.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      isDown = true;
      over.setPointerCapture(event.pointerId);
      seek(event);
    });
    over.addEventListener('pointermove', (event) => { if (isDown) seek(event); });
    for (const end of ['pointerup', 'pointercancel']) over.addEventListener(end, () => { isDown = false; });
  }

  /** @param {uPlot} chart */
  #drawBands({ ctx, bbox, valToPos, scales }) {
    const most = scales.y.max ?? 0;
    ctx.save();
    this.#limits.forEach(({ value, tone }, i) => {
      if (value >= most) return;
      const low = valToPos(value, 'y', true), high = valToPos(Math.min(most, this.#limits[i + 1]?.value ?? most), 'y', true);
      ctx.fillStyle = this.#color(tone);
      ctx.globalAlpha = 0.1;
      ctx.fillRect(bbox.left, high, bbox.width, low - high);
    });
    ctx.restore();
  }

  /** @param {uPlot} chart */
  #drawPlayhead({ ctx, bbox, valToPos, width }) {
    const pxRatio = ctx.canvas.width / width;
    const { from, to, moment } = this.#window;
    ctx.save();
    for (const { value, tone } of this.#limits) {
      const y = valToPos(value, 'y', true);
      if (y < bbox.top) continue;
      ctx.fillStyle = this.#color(tone);
      ctx.fillRect(bbox.left, y - pxRatio / 2, bbox.width, pxRatio);
    }
    this.#drawFlags(ctx, pxRatio, bbox, (micros) => valToPos(micros, 'x', true));
    if (moment >= from && moment <= to) {
      const x = Math.min(bbox.left + bbox.width - pxRatio, valToPos(moment, 'x', true));
      ctx.fillStyle = this.#color('mode');
      ctx.fillRect(x - pxRatio, bbox.top, 2 * pxRatio, bbox.height);
    }
    ctx.restore();
  }

  /** A line at each mark, with its sign at the top; a bar over the time of a span.
   *  @param {CanvasRenderingContext2D} ctx
   *  @param {number} pxRatio
   *  @param {uPlot.BBox} bbox
   *  @param {(micros: number) => number} xOf */
  #drawFlags(ctx, pxRatio, bbox, xOf) {
    const { from, to } = this.#window;
    ctx.fillStyle = this.#color('quiet');
    ctx.font = `700 ${10 * pxRatio}px ${getComputedStyle(this.box).fontFamily}`;
    ctx.textBaseline = 'top';
    for (const { micros, endMicros, label, hasRoom } of flagsApart(this.#flags, { from, to }, xOf, SIGN_PX * pxRatio)) {
      const left = Math.max(bbox.left, xOf(micros));
      if (endMicros !== null) ctx.fillRect(left, bbox.top, Math.min(bbox.left + bbox.width, xOf(endMicros)) - left, 2 * pxRatio);
      if (micros < from) continue;
      ctx.globalAlpha = 0.6;
      ctx.fillRect(left - pxRatio / 2, bbox.top, pxRatio, bbox.height);
      ctx.globalAlpha = 1;
      if (hasRoom) ctx.fillText([...label].slice(0, 2).join(''), left + 3 * pxRatio, bbox.top + 3 * pxRatio);
    }
  }
}

const EDGE = 0.07;
const SIGN_PX = 17;  // of a mark, two letters
const CLOCK_STEPS_SECS = [1, 2, 5, 10, 20, 60, 120, 300, 600];

/** @param {Window} window
 *  @returns {number} ms from label to label */
const clockStep = ({ from, to }) => 1000 * (CLOCK_STEPS_SECS.find((secs) => (to - from) / 1e6 / secs <= 5) ?? 1200);

/** Moments at full seconds or minutes of the day.
 *  @param {Window} window
 *  @returns {number[]} µs */
function clockSplits(window) {
  const step = clockStep(window), offset = window.wallMillis(0);
  const end = window.wallMillis(window.to) - EDGE * (window.to - window.from) / 1000;  // a label there would be cut
  const splits = [];
  for (let wall = Math.ceil(window.wallMillis(window.from) / step) * step; wall < end; wall += step) {
    splits.push(1000 * (wall - offset));
  }
  return splits;
}

/** @param {number} micros
 *  @param {Window} window */
const clockLabel = (micros, window) => clockText(Math.round(window.wallMillis(micros)), Math.min(59_999, clockStep(window)));
