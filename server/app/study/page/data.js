// What the page shows: the data that stand in it, what a person chose to see, and measures of a trial.

/**
 * Low, medium, high, unknown (0.01 % of the samples), p10, p50, p90, peak (0.001), time of the peak, longest time above the
 * upper limit (0.01 s), how often above it. null: unknown.
 * @typedef {(number | null)[]} Joint
 * @typedef {{ id: string, person: string, condition: string, state: string, labels?: Record<string, string>, source?: string,
 *   files?: [string, string][], reason?: string, sex?: string, hands?: string, mass?: number, secs?: number, samples?: number,
 *   spine?: [number | null, number | null], joints?: Joint[] }} Trial
 * @typedef {{ id: string, command: string, state: string, reason: string, kind: string }} Failure
 * @typedef {{ joints: string[], people: string[], conditions: string[], limits: [number, number] | null, compression_N: number,
 *   retry: string, trials: Trial[], failures: Failure[] }} Study
 * @typedef {{ at: number, scale: number, name: string, most: number, digits: number }} Measure
 * @typedef {{ person: string, condition: string, trials: number, means: number[], compression: number }} Group
 */

/** @template {Element} [T=HTMLElement] @param {string} selector @returns {T} */
export const find = (selector) => {
  const found = document.querySelector(selector);
  if (found === null) throw new Error(`${selector} is missing`);
  return /** @type {T} */ (found);
};
/** @param {unknown} text */
export const safe = (text) => String(text).replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c] ?? c);

export const study = /** @type {Study} */ (JSON.parse(find('#data').textContent ?? ''));
export const { joints, conditions } = study;
export const [MEDIUM, HIGH] = study.limits ?? [0.3, 0.6];

/** Measures of a joint: where it stands, by what it is divided, what it is called, the end of its axis (0: that of the data).
 * @type {Measure[]} */
export const measures = [
  { at: 2, scale: 100, name: 'time high, %', most: 100, digits: 1 },
  { at: 6, scale: 1000, name: 'P90 of ratio', most: 0, digits: 2 },
  { at: 7, scale: 1000, name: 'peak ratio', most: 0, digits: 2 },
];
export const [timeHigh, , peakRatio] = measures;

/** What a person chose, and the trials and groups that follow from it. */
export const view = {
  measure: timeHigh,
  tab: 'trials',
  state: 'all',
  condition: /** @type {string | null} */ (null),  // null: all
  sort: { key: 'id', way: 1 },
  chosen: study.trials.find((trial) => trial.joints) ?? study.trials[0],
  shown: /** @type {Trial[]} */ ([]),
  groups: /** @type {Group[]} */ ([]),
};

export const shortJoint = (/** @type {string} */ name) => name.replace('Right', 'R').replace('Left', 'L').replace(' (T1/C7)', '');
export const conditionName = (/** @type {string} */ name) => (name === '' ? (conditions.length > 1 ? 'none' : 'all') : name);

/** NaN: unknown. @param {Joint} joint @param {Measure} [of] */
export const valueOf = (joint, of = view.measure) => {
  const value = joint[of.at];
  return value === null || joint[5] === null ? NaN : value / of.scale;
};
/** @param {number} value @param {Measure} [of] */
export const textOf = (value, of = view.measure) =>
  (Number.isFinite(value) ? value.toFixed(value === 0 && of.digits === 1 ? 0 : of.digits) : '–');
/** @param {number[]} values */
export const meanOf = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
/** Of nearest rank, as the percentiles of a trial. @param {number[]} sorted @param {number} share */
export const quantile = (sorted, share) => sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];

/** The joint that is high for the longest time. @param {Joint[]} of */
export const mostLoaded = (of) => {
  let worst = 0;
  of.forEach((joint, i) => {
    const more = (joint[2] ?? -1) - (of[worst][2] ?? -1);
    if (more > 0 || more === 0 && (joint[7] ?? -1) > (of[worst][7] ?? -1)) worst = i;
  });
  return worst;
};
/** Share of the time above the limit of compression, %. @param {Trial} trial */
export const compressionShare = (trial) => (trial.spine?.[1] == null || !trial.secs ? NaN : 100 * trial.spine[1] / trial.secs);
/** @param {Trial} trial */
export const unknownShare = (trial) => (trial.joints ? Math.max(...trial.joints.map((joint) => joint[3] ?? 0)) / 100 : NaN);
