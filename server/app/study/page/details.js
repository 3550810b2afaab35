// What failed, and one trial in full.
import { compressionShare, find, joints, peakRatio, safe, study, textOf, valueOf, view } from './data.js';
import { linksOf, stateOf } from './table.js';

/** @typedef {import('./data.js').Failure} Failure */
/** @typedef {import('./data.js').Joint} Joint */

const MOST_KINDS = 100;

/** Failures by kind, the most frequent first. */
const kindsOfFailures = (() => {
  /** @type {Map<string, Failure[]>} */
  const kinds = new Map();
  for (const failure of study.failures) {
    const known = kinds.get(failure.kind);
    if (known) known.push(failure);
    else kinds.set(failure.kind, [failure]);
  }
  return [...kinds].sort(([, a], [, b]) => b.length - a.length);
})();

export const drawFailures = () => {
  const count = study.failures.length;
  if (count === 0) return;
  const items = kindsOfFailures.slice(0, MOST_KINDS).map(([kind, [first, ...others]], i) => `<li><b>${safe(kind)}</b>
<button data-kind="${i}" aria-label="show ${others.length + 1}">${others.length + 1} ▸</button>
<span>${safe(first.id)} (${safe(first.command)}, ${safe(first.state)}): ${safe(first.reason)}</span></li>`);
  find('.failures').hidden = false;
  find('.failures').innerHTML = `<h2>${count === 1 ? '1 job is' : `${count} jobs are`} not complete</h2>
<p>Do only these again: <code>${safe(study.retry)}</code></p><ul>${items.join('')}</ul>${
  kindsOfFailures.length > MOST_KINDS ? `<p>and ${kindsOfFailures.length - MOST_KINDS} more kinds</p>` : ''}`;
};

/** The longest end that all have. @param {string[]} texts */
const commonText = (texts) => {
  let length = 0;
  while (length < texts[0].length && texts.every((text) => text.at(-1 - length) === texts[0].at(-1 - length))) ++length;
  const end = texts[0].slice(texts[0].length - length).trim();
  return end === '' ? texts[0].split(/[\s:]/)[0] : end;
};
/** A text that filters the trials of a kind of failure: the id of one, or what all reasons say. @param {number} kind */
export const filterOfKind = (kind) => {
  const [, failures] = kindsOfFailures[kind];
  return failures.length === 1 ? failures[0].id : commonText(failures.map(({ reason }) => reason));
};

/** Shares of the samples by class, and the peak. @param {Joint} joint @param {number} i */
const bandsOf = (joint, i) => {
  const [low, medium, high, unknown] = joint.map((value) => (value ?? 0) / 100);
  const title = `low ${low.toFixed(1)} %, medium ${medium.toFixed(1)} %, high ${high.toFixed(1)} %, unknown ${unknown.toFixed(1)} %`;
  return `<div class="bands"><span style="font-weight:${high > 0 ? 700 : 400}">${safe(joints[i].replace(' (T1/C7)', ''))}</span>
<span class="bar" title="${title}"><i class="low" style="width:${low}%"></i><i class="medium" style="width:${medium}%"></i><i
 class="high" style="width:${high}%"></i><i class="unknown-band" style="width:${unknown}%"></i></span>
<span class="number">${textOf(valueOf(joint, peakRatio), peakRatio)}</span></div>`;
};

export const drawTrial = () => {
  const trial = view.chosen;
  if (!trial) return;
  const above = compressionShare(trial), [peak] = trial.spine ?? [];
  const facts = [
    ['person', [trial.person, trial.sex, trial.mass === undefined ? '' : `${trial.mass} kg`].filter(Boolean).join(', ')],
    ['condition', trial.condition],
    ...Object.entries(trial.labels ?? {}).filter(([, value]) => value !== trial.person && value !== trial.condition),
    ['recording', trial.source ?? ''],
    ['hand load', trial.hands ?? ''],
    ['length', trial.secs === undefined ? '' : `${(trial.secs / 100).toFixed(2)} s, ${trial.samples} samples`],
    ['L5/S1', peak == null ? ''
      : `${peak} N at most${Number.isNaN(above) ? '' : `; above ${study.compression_N} N ${above.toFixed(1)} %`}`],
  ].filter(([, value]) => value !== '');
  find('.trial').innerHTML = `<h2>${safe(trial.id)} ${stateOf(trial)}</h2>
<dl>${facts.map(([name, value]) => `<dt>${safe(name)}</dt><dd>${safe(value)}</dd>`).join('')}</dl>
<div class="links">${linksOf(trial)}</div>${trial.joints
    ? `${trial.joints.map(bandsOf).join('')}<small>share of samples low, medium, high, unknown; peak ratio</small>`
    : `<p class="problem">${safe(trial.reason)}</p>`}`;
};
