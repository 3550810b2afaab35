// The list of trials, with parts of a page that do no more than keep what they are given.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { ControlTrials } from '../../../web/control_trials.js';

const element = () => ({
  dataset: {}, value: '', textContent: '', children: [], addEventListener() {}, append(...more) { this.children.push(...more); },
  replaceChildren(...all) { this.children = all; },
});
before(() => { globalThis.document = { createElement: element, activeElement: null }; });
after(() => { delete globalThis.document; });

const stateOf = (trial) => ({ trial, trials: { why_not: '' }, recording: { why_not: 'off', state: 'off' }, jobs: [], clips: { why_not: '' } });
const trial = { trial: 'S07_lift_001', person: 'S07', condition: 'lift', number: 1, run_micros: 5, to_micros: 9, secs: 4,
  recording_problem: '', has_recording: true };

test('a trial whose end is in the list of files before the state says that it has ended is listed then', () => {
  const parts = Object.fromEntries(['form', 'person', 'condition', 'number', 'run', 'note', 'list'].map((name) => [name, element()]));
  const trials = new ControlTrials(parts, async () => null, element, () => {});
  trials.show(stateOf(trial), { run_micros: 5, trials: [trial], files: [] });
  assert.equal(parts.list.children.length, 0);
  trials.show(stateOf(null), null);
  assert.deepEqual(parts.list.children.map(({ dataset }) => dataset.trial), [trial.trial]);
});
