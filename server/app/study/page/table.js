// The table of trials, or of people and conditions: only the rows in sight are in the page.
import { compressionShare, find, HIGH, joints, MEDIUM, mostLoaded, safe, shortJoint, study, textOf, timeHigh, unknownShare,
  valueOf, view } from './data.js';

/** @typedef {import('./data.js').Trial} Trial */
/** @typedef {import('./data.js').Group} Group */

export const ROW = 27;  // px, height of a row
const MOST_PRINTED = 500;
const LETTERS = ['L5', 'T9', 'Nk', 'Sr', 'Sl', 'Er', 'El', 'Wr', 'Wl', 'Hr', 'Hl', 'Kr', 'Kl', 'Ar', 'Al'];
const STATES = /** @type {Record<string, string>} */ ({ kept: 'up to date' });

/** @param {string} text @param {string} [kind] */
const cell = (text, kind = '') => `<span${kind && ` class="${kind}"`}>${text}</span>`;
const named = (/** @type {string} */ text) => `<span title="${safe(text)}">${safe(text)}</span>`;
const sortMark = (/** @type {string} */ key) => (view.sort.key !== key ? '' : view.sort.way > 0 ? ' ▲' : ' ▼');
/** @param {string} key @param {string} text @param {string} [kind] */
const headButton = (key, text, kind = '') =>
  `<button class="${kind} ${view.sort.key === key ? 'on' : ''}" data-sort="${key}">${text}${sortMark(key)}</button>`;

const drawHead = () => {
  const letters = joints.map((name, i) => `<button data-sort="j${i}" title="sort by ${safe(name)}" aria-label="sort by ${
    safe(name)}" class="${view.sort.key === `j${i}` ? 'on' : ''}">${LETTERS[i]}</button>`).join('');
  const trials = [
    headButton('id', 'trial'), headButton('person', 'person'), headButton('condition', 'condition'), headButton('state', 'state'),
    headButton('secs', 'length, s', 'number'), cell(letters, 'letters'), headButton('worst', 'most loaded: % of time high'),
    headButton('spine', 'L5/S1 peak, N', 'number'), headButton('above', `above ${study.compression_N} N, %`, 'number'),
    headButton('unknown', 'unknown, %', 'number'), cell('files'),
  ];
  const people = [
    headButton('person', 'person'), headButton('condition', 'condition'), cell('trials', 'number'),
    ...joints.map((name, i) => headButton(`j${i}`, safe(shortJoint(name)), 'number')), headButton('spine', 'L5/S1 peak, N', 'number'),
  ];
  find('.tabs small').textContent = view.tab === 'trials' ? 'bars: a joint each; the letters above them sort'
    : `each cell: mean of the trials shown, ${view.measure.name}`;
  find('.head').innerHTML = `<div class="row">${(view.tab === 'trials' ? trials : people).join('')}</div>`;
};

/** @param {Trial} trial */
export const linksOf = (trial) => (trial.files ?? []).map(([what, path]) => `<a href="${safe(path)}">${safe(what)}</a>`).join(' ');
export const stateOf = (/** @type {Trial} */ trial) => cell(STATES[trial.state] ?? trial.state, `state ${trial.state}`);

/** The bars of a trial. @param {Trial} trial */
const barsOf = (trial) => (trial.joints ?? []).map((joint, i) => {
  const value = valueOf(joint), isShare = view.measure === timeHigh;
  if (Number.isNaN(value)) return `<i class="unknown" title="${safe(joints[i])}: unknown"></i>`;
  const band = isShare ? (value > 0 ? 'c3' : '') : value > HIGH ? 'c3' : value > MEDIUM ? 'c2' : '';
  const height = Math.max(1, 19 * (isShare ? value / 100 : Math.min(1, value / 1.3)));
  return `<i class="${band}" style="height:${height.toFixed(1)}px" title="${safe(joints[i])}: ${textOf(value)}"></i>`;
}).join('');

/** @param {Trial} trial */
const trialRow = (trial) => {
  const on = trial === view.chosen ? 'on' : '';
  const start = `<b title="${safe(trial.id)}">${safe(trial.id)}</b>${named(trial.person)}${named(trial.condition)}${stateOf(trial)}`;
  if (!trial.joints) {
    const why = `<span class="why" title="${safe(trial.reason)}">${safe(trial.reason)}</span>`;
    return `<div class="row without ${on}" data-id="${safe(trial.id)}">${start}${why}</div>`;
  }
  const worst = mostLoaded(trial.joints), share = (trial.joints[worst][2] ?? 0) / 100;
  const cells = [
    cell(((trial.secs ?? 0) / 100).toFixed(2), 'number'), cell(barsOf(trial), 'strip'),
    cell(share > 0 ? `${safe(joints[worst])} <b>${share.toFixed(1)} %</b>` : 'none'), cell(`${trial.spine?.[0] ?? '–'}`, 'number'),
    cell(textOf(compressionShare(trial), timeHigh), 'number'), cell(textOf(unknownShare(trial), timeHigh), 'number'), cell(linksOf(trial)),
  ];
  return `<div class="row ${on}" data-id="${safe(trial.id)}" data-person="${safe(trial.person)}">${start}${cells.join('')}</div>`;
};

/** Colour of a mean. @param {number} value */
const heatOf = (value) => {
  if (Number.isNaN(value)) return '';
  const red = (/** @type {number} */ strength) => `background:rgba(var(--heat),${Math.min(0.75, strength).toFixed(2)});`;
  if (view.measure === timeHigh) return red(value * 0.011);
  if (value > HIGH) return red(0.28 + (value - HIGH) * 0.45);
  return value > MEDIUM ? 'background:rgba(255,148,0,.32);' : '';
};
/** @param {Group} group */
const groupRow = (group) => {
  const strong = view.measure === timeHigh ? 45 : 1;
  const means = group.means.map((value) =>
    `<span class="cell" style="${heatOf(value)}${value > strong ? 'font-weight:700' : ''}">${textOf(value)}</span>`).join('');
  return `<div class="row" data-group="${safe(group.person)}" data-of="${safe(group.condition)}"><b title="${safe(group.person)}">${
    safe(group.person)}</b>${named(group.condition)}${cell(String(group.trials), 'number')}${means}${
    cell(Number.isFinite(group.compression) ? String(group.compression) : '–', 'number')}</div>`;
};

/** The rows in sight; for print all of them, up to 500. @param {boolean} [isPrint] */
export const drawRows = (isPrint = false) => {
  const scroll = find('.scroll'), rows = find('.rows'), count = view.tab === 'trials' ? view.shown.length : view.groups.length;
  const from = isPrint ? 0 : Math.max(0, Math.floor(scroll.scrollTop / ROW) - 6);
  const to = Math.min(count, isPrint ? MOST_PRINTED : from + Math.ceil(Math.min(scroll.clientHeight, innerHeight) / ROW) + 12);
  rows.style.transform = `translateY(${from * ROW}px)`;
  rows.innerHTML = (view.tab === 'trials' ? view.shown.slice(from, to).map(trialRow) : view.groups.slice(from, to).map(groupRow)).join('')
    || '<p class="nothing">No trial matches. <button class="clear">Clear the filter</button></p>';
};

export const drawTable = () => {
  drawHead();
  find('.body').style.height = `${(view.tab === 'trials' ? view.shown.length : view.groups.length) * ROW}px`;
  drawRows();
};

/** @param {string} csv link to the CSV file; '': none */
export const tableSection = (csv) => `<section class="table"><div class="tabs"><span role="tablist" aria-label="Table">
<button role="tab" data-tab="trials" aria-selected="true">Trials</button>
<button role="tab" data-tab="people" aria-selected="false">By person and condition</button></span><small></small><span class="download">${
  csv && `${csv} <small>a row for each trial and joint, for R</small>`}</span></div>
<div class="scroll trials" tabindex="0"><div class="head"></div><div class="body"><div class="rows"></div></div></div></section>`;
