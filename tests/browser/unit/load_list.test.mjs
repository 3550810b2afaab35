import assert from 'node:assert/strict';
import test from 'node:test';
import { asUnknown, byUrgency, explain, exposureShares, exposureText, rowsOf } from '../../../web/load_list.js';

const row = (key, loadClass, ratio) =>
  ({ key, label: key, loadClass, ratio, moment: -12.34, capacity: 60, channel: 'flexion', reason: '' });
const keys = (rows) => rows.map(({ key }) => key);

test('rows are ordered by class and ratio, with unknown loads last', () => {
  const rows = [row('a', 'unknown', NaN), row('b', 'low', 0.2), row('c', 'high', 0.7),
    row('d', 'medium', 0.59), row('e', 'high', 0.9), row('f', 'low', 0.25)];
  assert.deepEqual(keys(byUrgency(rows)), ['e', 'c', 'd', 'f', 'b', 'a']);
});

test('the class precedes the ratio, because hysteresis may keep a smaller ratio in the higher class', () => {
  assert.deepEqual(keys(byUrgency([row('a', 'medium', 0.59), row('b', 'high', 0.56)])), ['b', 'a']);
});

test('rows with nearly equal ratios keep their order', () => {
  const shown = ['a', 'b'];
  assert.deepEqual(keys(byUrgency([row('a', 'low', 0.20), row('b', 'low', 0.21)], shown)), ['a', 'b']);
  assert.deepEqual(keys(byUrgency([row('a', 'low', 0.20), row('b', 'low', 0.23)], shown)), ['b', 'a']);
});

test('a change of class moves a row at once', () => {
  const shown = ['a', 'b'];
  assert.deepEqual(keys(byUrgency([row('a', 'low', 0.30), row('b', 'medium', 0.30)], shown)), ['b', 'a']);
});

test('higher classes are above lower ones after any previous order', () => {
  const classes = ['high', 'medium', 'low', 'unknown'];
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let round = 0; round < 200; ++round) {
    const rows = Array.from({ length: 15 }, (_, i) => {
      const loadClass = classes[Math.floor(4 * random())];
      return row(String(i), loadClass, loadClass === 'unknown' ? NaN : random());
    });
    const before = keys(rows).sort(() => random() - 0.5);
    const ranks = byUrgency(rows, before).map(({ loadClass }) => classes.indexOf(loadClass));
    assert.deepEqual(ranks, [...ranks].sort());
    assert.equal(ranks.length, rows.length);
  }
});

test('the input is not changed', () => {
  const rows = [row('a', 'low', 0.1), row('b', 'high', 0.9)];
  byUrgency(rows);
  assert.deepEqual(keys(rows), ['a', 'b']);
});

test('a row states moment, capacity and direction, or why the load is unknown', () => {
  assert.equal(explain(row('a', 'low', 0.2)), 'now 12 of 60 N·m, flexion');
  assert.equal(explain({ ...row('a', 'low', 0.2), channel: '' }), 'now 12 of 60 N·m');
  assert.equal(explain({ ...row('a', 'unknown', NaN), reason: 'both feet are off the floor' }),
    'both feet are off the floor');
});

test('a class that lasts below its limit says how long', () => {
  const rowAt = (loadClass, ratio) => rowsOf(
    { people: [{ character: 0, loads: [{ joint: 0, loadClass, ratio, moment: 30, capacity: 60 }] }] }, [{ label: 'Neck' }],
    { people: [], class_limits: [0.3, 0.6], class_falls_below: [0.25, 0.55] })[0];
  assert.equal(explain(rowAt('high', 0.56)), 'high until below 55 %, now 30 of 60 N·m');
  assert.equal(explain(rowAt('medium', 0.3)), 'medium until below 25 %, now 30 of 60 N·m');
  assert.equal(explain(rowAt('high', 0.61)), 'now 30 of 60 N·m');
  assert.equal(explain(rowAt('low', 0.29)), 'now 30 of 60 N·m');
  assert.equal(explain(asUnknown(rowAt('high', 0.56))), 'no live data');
});

test('rows contain the names of people if there are several', () => {
  const load = { joint: 1, loadClass: 'low', ratio: 0.1, moment: 1, capacity: 10 };
  const joints = [{ label: 'L5/S1' }, { label: 'Neck' }];
  const one = { people: [{ character: 0, loads: [load] }] };
  const two = { people: [{ character: 0, loads: [load] }, { character: 3, loads: [load] }] };
  const details = { people: [{ character: 0, name: 'P05', loads: [{ joint: 1, channel: 'bend', reason: '' }] }],
    class_limits: [0.3, 0.6], class_falls_below: [0.25, 0.55] };
  assert.deepEqual(rowsOf(one, joints, details).map(({ label, channel }) => [label, channel]), [['Neck', 'bend']]);
  assert.deepEqual(rowsOf(two, joints, details).map(({ label }) => label), ['P05: Neck', 'Person 4: Neck']);
  assert.equal(new Set(rowsOf(two, joints, details).map(({ key }) => key)).size, 2);
});

test('the time in each class omits unused classes, and the shares add up', () => {
  const secs = { low: 40, medium: 12.4, high: 0, unknown: 7.6 };
  assert.equal(exposureText(secs), 'low 40 s, medium 12 s, unknown 7.6 s since the first sample');
  assert.equal(exposureText(undefined), '');
  assert.deepEqual(exposureShares({ low: 30, medium: 10, high: 0, unknown: 0 }), [0.75, 0.25, 0, 0]);
  assert.deepEqual(exposureShares({ low: 0, medium: 0, high: 0, unknown: 0 }), [0, 0, 0, 0]);
});

test('an external load is marked as external', () => {
  assert.equal(explain({ ...row('a', 'low', 0.2), isExternal: true }), 'now 12 of 60 N·m, flexion, external');
  assert.equal(explain({ ...row('a', 'low', 0.2), isExternal: true, moment: NaN, channel: 'external' }), 'external');
});
