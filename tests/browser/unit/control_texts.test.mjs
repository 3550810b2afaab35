import assert from 'node:assert/strict';
import test from 'node:test';
import { readControls, readFiles } from '../../../web/control_messages.js';
import { duration, handsText, heightText, jobText, nextNumber, recordingText, size, trialTitle } from '../../../web/control_texts.js';

const recording = { why_not: '', state: 'off', file: '', secs: 0, bytes: 0, dropped: 0, problem: '', free_bytes: 70e9, secs_left: 18000 };

test('sizes and durations have a unit that can be read', () => {
  assert.deepEqual([400, 3.4e6, 12.6e6, 999.6e6, 70e9, 5e15].map(size), ['0.4 kB', '3.4 MB', '13 MB', '1.0 GB', '70 GB', '5000 TB']);
  assert.deepEqual([5, 119.9, 120, 7199, 7200, 19800, 400000].map(duration),
    ['5 s', '119 s', '2 min', '119 min', '2 h', '5 h 30 min', '4 days']);
});

test('the recording says what it does, for how long it can, and what went wrong', () => {
  assert.equal(recordingText(recording), '70 GB free, enough for 5 h of this stream');
  assert.equal(recordingText({ ...recording, state: 'on', file: 'a.pcap', secs: 12, bytes: 3.4e6 }),
    'Recording a.pcap: 0:12, 3.4 MB; 70 GB free, enough for 5 h of this stream');
  assert.match(recordingText({ ...recording, state: 'on', dropped: 7 }), /7 datagrams not recorded: the disk is too slow/);
  assert.match(recordingText({ ...recording, file: 'a.pcap', secs: 2.1, bytes: 4e5 }), /^Saved a\.pcap: 0:02\.1, 0\.4 MB|400 kB/);
  assert.match(recordingText({ ...recording, file: 'a.pcap', problem: 'the disk is full' }), /^a\.pcap: the disk is full\./);
  assert.equal(recordingText({ ...recording, why_not: 'demo:lift is no stream' }), 'Not possible: demo:lift is no stream');
  assert.equal(recordingText({ ...recording, free_bytes: null, secs_left: null }), '');
});

test('what is held is said with its time and who set it; the stature with where it comes from', () => {
  const hands = { is_known: true, right_kg: 5, left_kg: 0, both_kg: 2.25, since_micros: 0, by: 'ROS' };
  assert.match(handsText(hands), /^Held now: 5 kg right, 2\.25 kg in both hands, since \d\d:\d\d:\d\d \(ROS\)$/);
  assert.match(handsText({ ...hands, right_kg: 0, both_kg: 0 }), /^Held now: nothing, since/);
  assert.match(handsText({ ...hands, is_known: false }), /^Held now: not known/);
  assert.match(handsText({ ...hands, since_micros: null, by: 'bridge' }), /in both hands \(as the node of the suit was told\)$/);
  const person = (height_m) => /** @type {any} */ ({ height_m });
  assert.equal(heightText(person({ value: 1.75, from: 'stream', stated: 1.8 })), 'as stated; the lengths from the stream give 1.75 m');
  assert.equal(heightText(person({ value: 1.75, from: 'poses', stated: null })), 'measured in the poses');
  assert.equal(heightText(person({ value: 1.8, from: 'operator', stated: 1.8 })), 'set by an operator');
});

test('trials are counted by person and condition', () => {
  const trials = [['S07', 'lift', 1], ['S07', 'lift', 4], ['S08', 'lift', 2]].map(([person, condition, number]) =>
    /** @type {any} */ ({ person, condition, number }));
  assert.equal(nextNumber(trials, 'S07', 'lift'), 5);
  assert.equal(nextNumber(trials, 'S08', 'lift'), 3);
  assert.equal(nextNumber(trials, 'S08', 'carry'), 1);
  assert.equal(trialTitle(trials[0]), 'S07 · lift · trial 1');
});

test('a job says how far it is, or why it failed', () => {
  const job = { id: 1, kind: 'clip', file: 'a.mp4', progress: 0.456, problem: '', state: 'making' };
  assert.equal(jobText(/** @type {any} */ (job)), '46 %');
  assert.equal(jobText(/** @type {any} */ ({ ...job, state: 'failed', problem: 'the disk is full' })), 'the disk is full');
  assert.equal(jobText(/** @type {any} */ ({ ...job, state: 'waiting' })), 'waiting');
});

test('messages of another shape are rejected with their path', () => {
  assert.throws(() => readControls({ recording: { ...recording, state: 'paused' } }, 'controls'), /controls\.recording\.state/);
  assert.throws(() => readFiles({ revision: 1, run_micros: 1, files: [{ name: 'a' }], trials: [] }, 'api/v1/files'), /api\/v1\/files\.files\[0\]\.bytes/);
});
