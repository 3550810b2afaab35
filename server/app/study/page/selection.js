// Which trials are shown, in which order, and their groups by person and condition.
import { compressionShare, conditionName, conditions, find, joints, meanOf, measures, mostLoaded, safe, study, unknownShare, valueOf,
  view } from './data.js';

/** @typedef {import('./data.js').Trial} Trial */
/** @typedef {import('./data.js').Group} Group */

const collator = new Intl.Collator('en', { numeric: true });
/** Numbers in texts by their value. @param {string | number} a @param {string | number} b */
export const compare = (a, b) => (typeof a === 'number' && typeof b === 'number' ? a - b : collator.compare(String(a), String(b)));

/** The joint of a sort key such as "j3"; -1: none. @param {string} key */
export const jointOf = (key) => (/^j\d+$/.test(key) ? Number(key.slice(1)) : -1);

/** @param {Trial} trial @param {string} key @returns {string | number} */
const sortValue = (trial, key) => {
  const low = (/** @type {number | null | undefined} */ value) => (value == null || Number.isNaN(value) ? -1 : value);
  if (jointOf(key) >= 0) return trial.joints ? low(valueOf(trial.joints[jointOf(key)])) : -1;
  switch (key) {
    case 'person': return trial.person;
    case 'condition': return trial.condition;
    case 'state': return trial.state;
    case 'secs': return low(trial.secs);
    case 'worst': return trial.joints ? low(trial.joints[mostLoaded(trial.joints)][2]) : -1;
    case 'spine': return low(trial.spine?.[0]);
    case 'above': return low(compressionShare(trial));
    case 'unknown': return low(unknownShare(trial));
    default: return trial.id;
  }
};

/** @param {string} what @param {string} label @param {string[]} names @param {string[]} values of the choices; the first is chosen */
const choiceOf = (what, label, names, values) => `<span class="group" data-choice="${what}" role="group" aria-label="${label}">${
  names.map((name, i) => `<button data-value="${values[i]}" aria-pressed="${i === 0}">${safe(name)}</button>`).join('')}</span>`;
const optionsOf = (/** @type {string[]} */ names) => names.map((name, i) => `<option value="${i}">${safe(name)}</option>`).join('');

/** The line of filters. */
export const filterLine = () => {
  const without = study.trials.filter((trial) => !trial.joints).length;
  return `<div class="filters">
<label>Filter <input type="search" placeholder="trial, person, reason or joint" autocomplete="off"> <kbd>/</kbd></label>
${choiceOf('state', 'State', ['All', 'With loads', `Without (${without})`], ['all', 'with', 'without'])}
${conditions.length > 1
    ? choiceOf('condition', 'Condition', ['All', ...conditions.map(conditionName)], ['', ...conditions.map((_, i) => String(i))]) : ''}
<label>only where <select class="of-joint" aria-label="Joint"><option value="">any joint</option>${optionsOf(joints)}</select>
<select class="of-measure" aria-label="Measure">${optionsOf(measures.map(({ name }) => name))}</select>
≥ <input class="least" type="number" min="0" step="any" placeholder="any" aria-label="At least"></label>
<button class="clear">Clear</button><span class="hits" role="status"></span></div>`;
};
/** The fields of the line of filters, once it is there. */
export const fields = () => ({
  search: /** @type {HTMLInputElement} */ (find('.filters input[type=search]')),
  least: /** @type {HTMLInputElement} */ (find('.least')),
  joint: /** @type {HTMLSelectElement} */ (find('.of-joint')),
  measure: /** @type {HTMLSelectElement} */ (find('.of-measure')),
});

/** @param {Trial} trial @param {string} text */
const mentions = (trial, text) => [
  trial.id, trial.person, trial.condition, trial.reason ?? '', ...Object.values(trial.labels ?? {}),
  trial.joints ? joints[mostLoaded(trial.joints)] : '',
].some((each) => each.toLowerCase().includes(text));

/** Whether a trial reaches the value that the filter asks for. @param {Trial} trial */
const reaches = (trial) => {
  const { least, joint, measure } = fields(), limit = parseFloat(least.value);
  if (Number.isNaN(limit)) return true;
  if (!trial.joints) return false;
  const wanted = joint.value === '' ? trial.joints : [trial.joints[Number(joint.value)]];
  return wanted.some((each) => valueOf(each, measures[Number(measure.value)]) >= limit);
};

const collectGroups = () => {
  /** @type {Map<string, Trial[]>} */
  const byGroup = new Map();
  for (const trial of view.shown) {
    if (!trial.joints) continue;
    const key = `${trial.person}\n${trial.condition}`, group = byGroup.get(key);
    if (group) group.push(trial);
    else byGroup.set(key, [trial]);
  }
  view.groups = [...byGroup.values()].map((trials) => ({
    person: trials[0].person, condition: trials[0].condition, trials: trials.length,
    means: joints.map((_, i) => meanOf(trials.map((trial) => valueOf(trial.joints?.[i] ?? [])).filter(Number.isFinite))),
    compression: Math.max(...trials.map((trial) => trial.spine?.[0] ?? NaN).filter(Number.isFinite)),
  }));
  const { key, way } = view.sort, joint = jointOf(key);
  /** @param {Group} group */
  const value = (group) => {
    if (joint >= 0) return Number.isFinite(group.means[joint]) ? group.means[joint] : -1;
    if (key === 'spine') return group.compression;
    return key === 'condition' ? `${group.condition}\n${group.person}` : `${group.person}\n${group.condition}`;
  };
  view.groups.sort((a, b) => way * compare(value(a), value(b)));
};

/** Selects trials and groups by what a person chose. */
export const selectTrials = () => {
  const text = fields().search.value.trim().toLowerCase(), { state, condition, sort } = view;
  view.shown = study.trials.filter((trial) => (state === 'all' || (state === 'with') === Boolean(trial.joints))
    && (condition === null || trial.condition === condition) && (text === '' || mentions(trial, text)) && reaches(trial));
  view.shown.sort((a, b) => sort.way * (compare(sortValue(a, sort.key), sortValue(b, sort.key)) || compare(a.id, b.id)));
  collectGroups();
};
