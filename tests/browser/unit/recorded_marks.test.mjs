import assert from 'node:assert/strict';
import test from 'node:test';
import { Marks } from '../../../web/marks.js';
import { placedIn } from '../../../web/recorded_marks.js';

const SECOND = 1e6;
// A recording of 10 s whose time codes begin at 1:00:00; its sample of 4.0 s was played as state at 50.1 s.
const recording = { start_micros: 900 * SECOND, length_secs: 10, round_secs: null, ended_micros: null };
const anchor = { recording, stampMicros: 904 * SECOND, madeMicros: 50.1 * SECOND, timeCodeMillis: 3604_000, rateHz: 100 };
const markAt = (secs, endSecs = null) => {
  const at = (place) => ({ state: 7, micros: 1, stamp_micros: 2, time_code_millis: 3600_000 + 1000 * place, counter: 60 * place });
  return { id: 1, revision: 1, run_micros: 5, kind: 'mark', button: 1, text: 'grasp', role: 'operator', at: at(secs),
    end: endSecs === null ? null : at(endSecs), is_open: false, is_removed: false, behind_secs: 0 };
};

test('a mark of an earlier start is at the sample with its time code', () => {
  const { at, end } = placedIn(markAt(2.5, 3), anchor);
  assert.equal(at.micros, 48.6 * SECOND + 5000, 'half of a sample later, so that its state is there');
  assert.equal(at.stamp_micros, 902.5 * SECOND);
  assert.equal(at.counter, 150);
  assert.equal(end.stamp_micros, 903 * SECOND);
  assert.equal(placedIn(markAt(9), anchor).at.micros, 55.1 * SECOND + 5000, 'it is still to come');
});

test('a mark outside of the recording, or of one without time codes, has no place', () => {
  for (const [secs, end] of [[-1, null], [10.5, null], [9, 11]]) assert.equal(placedIn(markAt(secs, end), anchor), null);
  assert.equal(placedIn(markAt(2), { ...anchor, timeCodeMillis: 0 }), null);
});

test('of a recording that begins anew, a mark that is still to come is the one of the round before', () => {
  const looping = { ...anchor, recording: { ...recording, round_secs: 10.01 } };
  assert.equal(placedIn(markAt(2.5), looping).at.stamp_micros, 902.5 * SECOND);
  assert.equal(placedIn(markAt(9), looping).at.stamp_micros, 898.99 * SECOND);
});

test('marks of earlier starts are in the list among those of this one while their recording is played', async () => {
  const now = { ...markAt(3), id: 2, revision: 2, run_micros: 6 };
  now.at = { ...now.at, micros: 49.1 * SECOND, stamp_micros: 903 * SECOND };
  const answer = { names: [], run_micros: 6, revision: 2, marks: [markAt(3.5), now] };
  globalThis.fetch = async () => new Response(JSON.stringify(answer), { headers: { 'Content-Type': 'application/json' } });
  let changes = 0;
  const marks = new Marks(() => { changes += 1; });
  await marks.update(2, 0);
  assert.deepEqual(marks.list().map((mark) => [mark.id, marks.hasMoment(mark)]), [[1, false], [2, true]]);
  marks.setPlayed(recording, { ...anchor, liveness: 'live' });
  assert.deepEqual(marks.list().map((mark) => [mark.id, marks.hasMoment(mark)]), [[2, true], [1, true]]);
  const list = marks.list(), before = changes;
  marks.setPlayed(recording, { ...anchor, liveness: 'live', stampMicros: 905 * SECOND, madeMicros: 51.11 * SECOND, timeCodeMillis: 3605_000 });
  marks.setPlayed(recording, { ...anchor, liveness: 'stale', madeMicros: 99 * SECOND });
  assert.equal(marks.list(), list, 'another sample of the same recording');
  assert.equal(changes, before);
  const ended = { ...recording, ended_micros: 56.1 * SECOND };
  marks.setPlayed(ended, { ...anchor, liveness: 'stale', stampMicros: 910 * SECOND, madeMicros: 57 * SECOND, timeCodeMillis: 3610_000 });
  assert.ok(Math.abs(marks.list()[1].at.micros - (49.6 * SECOND)) < 0.12 * SECOND, 'not by the state that says that it is over');
  marks.setPlayed(null, null);
  assert.deepEqual(marks.list().map((mark) => [mark.id, marks.hasMoment(mark)]), [[1, false], [2, true]]);
});
