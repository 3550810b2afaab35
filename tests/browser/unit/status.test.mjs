import assert from 'node:assert/strict';
import test from 'node:test';
import { statusOf, leftOutText, BEHIND_MILLIS, OLD_MILLIS, SILENCE_MILLIS } from '../../../web/status.js';

const good = { connected: true, everConnected: true, silentMillis: 20, liveness: 'live', ageMillis: 8,
  waitedMillis: 0, source: 'udp://:9763', reason: '' };
const level = (change) => statusOf({ ...good, ...change }).level;

test('the status is live only if every condition is met', () => {
  assert.equal(level({}), 'live');
  assert.equal(statusOf(good).banner, '');
  assert.equal(level({ ageMillis: null }), 'live');
});

test('a stale stream is shown as stale with its age', () => {
  const status = statusOf({ ...good, liveness: 'stale', ageMillis: 3210 });
  assert.equal(status.word, 'Stale');
  assert.match(status.banner, /3\.2 s ago/);
});

test('an overloaded server is named with its delay, and never live', () => {
  const status = statusOf({ ...good, ageMillis: 3700, waitedMillis: 3700 });
  assert.deepEqual([status.level, status.word, status.banner],
    ['stale', 'Overloaded', 'The server is too busy: behind by 3.7 s']);
  assert.equal(level({ waitedMillis: BEHIND_MILLIS }), 'live');
  assert.equal(statusOf({ ...good, liveness: 'stale', waitedMillis: 3700 }).word, 'Stale', 'the stream has stopped');
});

test('a viewer who looks back is told so, and what is wrong with the live stream', () => {
  const behind = { ...good, behindMillis: 12_400 };
  assert.deepEqual(statusOf(behind), { level: 'behind', word: 'Behind −12.4 s', note: 'Esc returns to live', banner: '', isFresh: true });
  assert.match(statusOf({ ...behind, isGone: true }).banner, /no longer kept/);
  assert.match(statusOf({ ...behind, liveness: 'stale', isGone: true }).banner, /^Live stream: Stale\. The stream has/);
  assert.match(statusOf({ ...behind, connected: false }).banner, /^Live stream: Disconnected\./);
  assert.equal(statusOf({ ...good, behindMillis: null }).word, 'Live');
});

test('a recording is never live: the status says where in it the viewer is', () => {
  const recording = { start_micros: 5e6, length_secs: 190.04, round_secs: null, ended_micros: null };
  const plays = { ...good, recording, stampMicros: 47e6 };
  assert.deepEqual(statusOf(plays), { level: 'recording', word: 'Recording 0:42.0 of 3:10', note: 'plays', banner: '', isFresh: true });
  assert.equal(statusOf({ ...plays, recording: { ...recording, length_secs: null } }).word, 'Recording 0:42.0');
  assert.equal(statusOf({ ...plays, recording: { ...recording, round_secs: 40 } }).word, 'Recording 0:02.0 of 3:10');
  assert.equal(statusOf({ ...plays, behindMillis: 3000 }).word, 'Recording 0:42.0 of 3:10');
  assert.match(statusOf({ ...plays, behindMillis: 3000, isGone: true }).banner, /no longer kept/);
  const over = { ...plays, recording: { ...recording, ended_micros: 9e6 }, behindMillis: 0, liveness: 'stale' };
  assert.deepEqual(statusOf(over), { level: 'recording', word: 'Recording 0:42.0 of 3:10', note: 'ended', banner: '', isFresh: false });
  assert.match(statusOf({ ...over, connected: false }).banner, /^Disconnected\. No connection/);
  // A busy page hears of the end before it has turned to it.
  assert.deepEqual(statusOf({ ...over, behindMillis: null }), statusOf(over));
  assert.equal(statusOf({ ...over, behindMillis: null, connected: false }).level, 'disconnected');
  assert.equal(statusOf({ ...plays, liveness: 'stale' }).level, 'stale', 'it stands still, and has not ended');
});

test('losing data is a state of its own, whose figure the second line explains', () => {
  assert.equal(statusOf({ ...good, loss: 0.003 }).note, '0.3 % lost or incomplete');
  assert.equal(level({ loss: 0.054, isLosing: false }), 'live', 'not yet, or no longer');
  const losing = { ...good, loss: 0.0543, isLosing: true };
  const { level: state, word, note } = statusOf(losing);
  assert.deepEqual([state, word, note], ['losing', 'Losing data 5.4 %', 'lost or incomplete in 10 s']);
  assert.equal(statusOf(losing).isFresh, true);
  assert.equal(statusOf({ ...losing, liveness: 'stale' }).level, 'stale', 'what misleads more if it is missed');
  assert.equal(statusOf({ ...losing, connected: false }).level, 'disconnected');
  const behind = statusOf({ ...losing, behindMillis: 2000 });
  assert.deepEqual([behind.level, behind.note], ['behind', 'live stream: Losing data 5.4 %']);
});

test('people who are left out are named with the reason', () => {
  assert.equal(leftOutText([]), '');
  const far = { character: 3, name: '', reason: '900 km from the others' };
  assert.equal(leftOutText([far]), 'Character 3 is left out: 900 km from the others');
  assert.equal(leftOutText([{ ...far, name: 'Eve' }]), 'Eve is left out: 900 km from the others');
  assert.equal(leftOutText([far, { ...far, character: 4 }]), '2 people are left out: 900 km from the others');
});

test('the status becomes stale when the last sample is old', () => {
  assert.equal(level({ ageMillis: OLD_MILLIS + 1 }), 'stale');
});

test('the status is disconnected if the server is silent or unreachable', () => {
  assert.equal(level({ silentMillis: SILENCE_MILLIS + 1 }), 'disconnected');
  assert.equal(level({ connected: false }), 'disconnected');
});

test('the status names the expected source before the first sample', () => {
  const status = statusOf({ ...good, liveness: 'no data', ageMillis: null });
  assert.deepEqual([status.level, status.word, status.banner], ['no-data', 'No data', 'Waiting for udp://:9763']);
  assert.equal(statusOf({ ...good, liveness: 'no data', source: '' }).banner, 'Waiting for the source');
});

test('the status is live without a person, if the source has something else to show', () => {
  const status = statusOf({ ...good, liveness: 'no person' });
  assert.deepEqual([status.level, status.word, status.note, status.banner, status.isFresh], ['live', 'Live', 'no person', '', true]);
  assert.equal(statusOf({ ...good, liveness: 'no person', ageMillis: 5000 }).level, 'stale');
});

test('the status before the first connection is waiting, or rejected with the reason', () => {
  const start = { ...good, connected: false, everConnected: false, liveness: null };
  assert.equal(statusOf(start).level, 'wait');
  assert.deepEqual(statusOf({ ...start, reason: 'no token' }),
    { level: 'disconnected', word: 'Rejected', note: 'by the server', banner: 'no token', isFresh: false });
});
