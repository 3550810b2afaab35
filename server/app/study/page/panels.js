// A small plot for each joint: the conditions side by side, by person if there are few.
import { conditionName, conditions, find, HIGH, joints, meanOf, MEDIUM, measures, quantile, safe, shortJoint, textOf, timeHigh, valueOf,
  view } from './data.js';
import { compare } from './selection.js';

/** @typedef {import('./data.js').Trial} Trial */
/** What all panels have in common: trials by condition, people (none: too many for a line each), end of the axis.
 * @typedef {{ by: Trial[][], people: string[], most: number }} Plan */

const WIDTH = 132, MOST_LINES = 8;

const markOf = (/** @type {Plan} */ plan, /** @type {number} */ which) => (which || plan.by.length === 1 ? 'filled' : 'hollow');
/** The known values of a joint. @param {Trial[]} trials @param {number} joint */
const valuesOf = (trials, joint) => trials.map((trial) => valueOf(trial.joints?.[joint] ?? [])).filter(Number.isFinite);

/** Lines of the axis. @param {number} most @param {number} height @param {(value: number) => number} x */
const axisOf = (most, height, x) => {
  const isShare = view.measure === timeHigh;
  return (isShare ? [0, 50, 100] : [0, MEDIUM, HIGH, 1, ...(most >= 2 ? [2] : [])]).map((value) => {
    const isLimit = !isShare && (value === MEDIUM || value === HIGH);
    return `<line x1="${x(value)}" x2="${x(value)}" y1="18" y2="${height - 14}" class="${isLimit ? 'limit' : 'grid'}"/>${isLimit ? ''
      : `<text x="${x(value)}" y="${height - 3}" text-anchor="${value === 100 ? 'end' : 'middle'}">${value}</text>`}`;
  }).join('');
};

/** A person's trials and means. @param {Plan} plan @param {number} joint @param {string} person @param {(value: number) => number} x
 * @param {number} y @param {number} left */
const personLine = (plan, joint, person, x, y, left) => {
  const values = plan.by.map((trials) => valuesOf(trials.filter((trial) => trial.person === person), joint));
  const means = values.map(meanOf);
  const dots = values.map((each, which) => each.map((value) =>
    `<circle cx="${x(value)}" cy="${y + (which ? 3 : -3)}" r="1.6" class="${markOf(plan, which)} dim"/>`).join('')).join('');
  const between = means.length === 2 && means.every(Number.isFinite)
    ? `<line x1="${x(means[0])}" x2="${x(means[1])}" y1="${y}" y2="${y}" class="between"/>` : '';
  return `<text x="${left - 6}" y="${y + 3.5}" text-anchor="end">${safe(person.slice(0, 5))}</text>${dots}${between}${
    means.map((mean, which) => (Number.isFinite(mean) ? `<circle cx="${x(mean)}" cy="${y}" r="4" class="${markOf(plan, which)}"/>` : ''))
      .join('')}`;
};

/** A condition's trials: P10 to P90 and median. @param {Plan} plan @param {number} joint @param {number} which
 * @param {(value: number) => number} x @param {number} y */
const conditionLine = (plan, joint, which, x, y) => {
  const values = valuesOf(plan.by[which], joint).sort((a, b) => a - b);
  if (values.length === 0) return '';
  const [low, middle, high] = [0.1, 0.5, 0.9].map((share) => quantile(values, share)), isRight = x(high) > WIDTH - 34;
  return `<rect x="${x(low)}" y="${y - 4.5}" width="${Math.max(1, x(high) - x(low))}" height="9" rx="2" class="${markOf(plan, which)}"/>
<line x1="${x(middle)}" x2="${x(middle)}" y1="${y - 6}" y2="${y + 6}" class="median"/>
<text x="${isRight ? x(low) - 4 : x(high) + 4}" y="${y + 3.5}" text-anchor="${isRight ? 'end' : 'start'}" class="value">${
  textOf(middle)}</text>`;
};

/** Mean of the second condition less that of the first; '': there are not two. @param {Plan} plan @param {number} joint */
const changeOf = ({ by }, joint) => {
  if (by.length !== 2) return '';
  const difference = meanOf(valuesOf(by[1], joint)) - meanOf(valuesOf(by[0], joint)), text = textOf(Math.abs(difference));
  if (!Number.isFinite(difference)) return '';
  return Number(text) === 0 ? '0' : `${difference > 0 ? '+' : '−'}${text}`;
};

/** @param {Plan} plan @param {number} joint */
const panelOf = (plan, joint) => {
  const { by, people, most } = plan, hasPeople = people.length > 0;
  const left = hasPeople ? 34 : 10, lines = hasPeople ? people.length : by.length, height = 34 + Math.max(72, lines * 13);
  const x = (/** @type {number} */ value) => left + (WIDTH - left - 8) * Math.min(value, most) / most;
  const y = (/** @type {number} */ line) => 20 + (height - 36) * (line + 0.5) / lines;
  const drawing = hasPeople ? people.map((person, line) => personLine(plan, joint, person, x, y(line), left))
    : by.map((_, which) => conditionLine(plan, joint, which, x, y(which)));
  const name = safe(joints[joint]), change = changeOf(plan, joint);
  return `<button data-joint="${joint}" class="${view.sort.key === `j${joint}` ? 'on' : ''}" title="sort by ${name}">
<svg viewBox="0 0 ${WIDTH} ${height}" role="img" aria-label="${name}${change && `: ${change}`}">
<text x="${hasPeople ? 4 : left - 6}" y="12" class="name">${safe(shortJoint(joints[joint]))}</text>
<text x="${WIDTH - 4}" y="12" text-anchor="end" class="value">${change}</text>${axisOf(most, height, x)}${drawing.join('')}</svg></button>`;
};

/** End of the axis. @param {Trial[]} loaded */
const mostOf = (loaded) => {
  let most = 0;
  for (const trial of loaded) for (const joint of trial.joints ?? []) most = Math.max(most, valueOf(joint) || 0);
  return Math.min(2.5, Math.max(1, Math.ceil(most * 4) / 4));
};

/** What marks and lines mean. @param {Plan} plan @param {string[]} names */
const keyOf = (plan, names) => {
  const isFew = names.length <= 2;
  const dot = (/** @type {number} */ which) =>
    `<svg width="14" height="14" aria-hidden="true"><circle cx="7" cy="7" r="4.3" class="${markOf(plan, which)}"/></svg>`;
  const shown = names.map((name, which) => `${isFew ? dot(which) : which + 1} ${safe(conditionName(name))}`);
  return `${shown.join(isFew ? ' ' : ' · ')} <span>· ${
    plan.people.length > 0 ? 'large: mean, small: each trial' : 'bar: P10 to P90 of the trials, line: median'}</span>`;
};
/** @param {Plan} plan @param {string[]} names */
const noteOf = (plan, names) => {
  const limits = `dashed: limits ${MEDIUM} and ${HIGH}${plan.most >= 2.5 ? '; 2.5 and more at the right edge' : ''}`;
  return [
    names.length === 2 ? `top right: mean of ${safe(conditionName(names[1]))} less that of ${safe(conditionName(names[0]))}` : '',
    names.length > 2 ? 'from top: the conditions in their order' : '',
    'click a joint to sort',
    view.measure === timeHigh ? 'axis: % of the trial' : limits,
  ].filter((line) => line !== '').join('<br>');
};

/** The buttons that choose the measure. */
export const measureButtons = () => `<span class="segments" data-choice="measure" role="group" aria-label="Measure">${
  measures.map((each, i) => `<button data-value="${i}" aria-pressed="${i === 0}">${each.name}</button>`).join('')}</span>`;

export const drawPanels = () => {
  const loaded = view.shown.filter((trial) => trial.joints);
  const names = conditions.filter((name) => loaded.some((trial) => trial.condition === name)).slice(0, MOST_LINES);
  const all = [...new Set(loaded.map((trial) => trial.person))].sort(compare);
  /** @type {Plan} */
  const plan = {
    by: names.map((name) => loaded.filter((trial) => trial.condition === name)),
    people: all.length <= MOST_LINES && names.length <= 2 && !all.includes('') ? all : [],
    most: view.measure.most || mostOf(loaded),
  };
  find('.key').innerHTML = keyOf(plan, names);
  find('.panels').innerHTML = loaded.length === 0 ? '<p>No loads in the trials shown.</p>'
    : `${joints.map((_, joint) => panelOf(plan, joint)).join('')}<p>${noteOf(plan, names)}</p>`;
};
