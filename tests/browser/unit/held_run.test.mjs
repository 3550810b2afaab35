import assert from 'node:assert/strict';
import test from 'node:test';
import { HeldRun } from '../../../web/held_run.js';

const SECOND = 1e6;  // µs

/** Former states, one each 10 ms; their number is the hundredth of a second. */
const formers = (first, last) => Array.from({ length: last - first + 1 }, (_, i) => (
  /** @type {any} */ ({ stateNumber: first + i, madeMicros: 10_000 * (first + i) })));

/** Has 1 s to 1.5 s. */
function setUp() {
  const run = new HeldRun();
  run.add(formers(100, 150), SECOND, 1.5 * SECOND);
  return run;
}
const numberAt = (run, micros, speed = 1) => run.at(micros, speed)?.stateNumber ?? null;

test('without a run, the moment itself is asked for, at once', () => {
  assert.equal(new HeldRun().at(5, 1), null);
  assert.deepEqual(new HeldRun().next(5, 1), { micros: 5 });
});

test('a run has the state of each of its moments', () => {
  const run = setUp();
  assert.equal(numberAt(run, SECOND), 100);
  assert.equal(numberAt(run, 1.2349 * SECOND), 123);
  assert.equal(numberAt(run, 1.5 * SECOND), 150);
  assert.equal(numberAt(run, 1.6 * SECOND), 150, 'until the next run is there');
  assert.equal(numberAt(run, 0.99 * SECOND), null);
  assert.equal(numberAt(run, 9 * SECOND), null, 'elsewhere');
});

test('of a moment that is no longer kept, the oldest state comes', () => {
  const run = new HeldRun();
  run.add(formers(300, 310), SECOND, 3.1 * SECOND);
  assert.equal(numberAt(run, 1.1 * SECOND), 300);
});

test('the next run is asked for in the middle of this one, and is as long as it plays', () => {
  const run = setUp();
  assert.equal(run.next(1.24 * SECOND, 1), null);
  const next = { micros: 1.5 * SECOND, until_micros: 2 * SECOND, every_micros: 12_000 };
  assert.deepEqual(run.next(1.25 * SECOND, 1), next);
  assert.deepEqual(run.next(1.6 * SECOND, 1), { ...next, micros: 1.6 * SECOND, until_micros: 2.1 * SECOND }, 'late');
  assert.deepEqual(run.next(1.25 * SECOND, 8), { micros: 1.5 * SECOND, until_micros: 5.5 * SECOND, every_micros: 96_000 });
  assert.deepEqual(run.next(1.25 * SECOND, 0.1), { micros: 1.5 * SECOND, until_micros: 1.55 * SECOND, every_micros: 1200 });
});

test('a moment elsewhere is asked for alone', () => {
  const run = setUp();
  assert.deepEqual(run.next(0.5 * SECOND, 1), { micros: 0.5 * SECOND });
  assert.deepEqual(run.next(5 * SECOND, 1), { micros: 5 * SECOND });
  run.add(formers(500, 500), 5 * SECOND, 5 * SECOND);
  assert.equal(numberAt(run, 1.2 * SECOND), null, 'the run from before is dropped');
  assert.equal(numberAt(run, 5.01 * SECOND), 500);
  assert.deepEqual(run.next(5.01 * SECOND, 1), { micros: 5.01 * SECOND, until_micros: 5.51 * SECOND, every_micros: 12_000 });
});

test('a run goes on with the next one, without its first state again', () => {
  const run = setUp();
  run.at(1.3 * SECOND, 1);
  run.add(formers(150, 200), 1.5 * SECOND, 2 * SECOND);
  for (const hundredths of [130, 149, 150, 151, 200]) assert.equal(numberAt(run, hundredths * 10_000), hundredths);
  assert.equal(numberAt(run, 1.29 * SECOND), null, 'what has been shown is dropped');
  assert.deepEqual(run.next(1.4 * SECOND, 1), null);
  assert.equal(run.next(1.66 * SECOND, 1)?.micros, 2 * SECOND);
});

test('a stream that stood still has one state for many moments', () => {
  const run = setUp();
  run.add(formers(150, 150), 1.5 * SECOND, 2 * SECOND);
  assert.equal(numberAt(run, 1.9 * SECOND), 150);
  assert.equal(run.next(1.9 * SECOND, 1)?.micros, 2 * SECOND);
});

test('a slow connection is asked for fewer states, and a quick one for all again', () => {
  const run = setUp();
  const every = () => /** @type {any} */ (run.next(1.3 * SECOND, 1)).every_micros;
  run.setPace(300);
  assert.equal(every(), 24_000);
  for (let i = 0; i < 5; ++i) run.setPace(300);
  assert.equal(every(), 96_000);
  run.setPace(100);
  assert.equal(every(), 96_000);
  for (let i = 0; i < 5; ++i) run.setPace(20);
  assert.equal(every(), 12_000);
});
