import assert from 'node:assert/strict';
import test from 'node:test';
import { shownIn, withShown } from '../../../web/address.js';

const at = (query) => new URL(`http://127.0.0.1:8080/${query}`);

test('an address without a moment is live', () => {
  for (const query of ['', '?t=', '?t=now', '?t=-5', '?t=Infinity', '?camera=front']) {
    assert.equal(shownIn(at(query)).micros, null, query);
  }
});

test('a moment in the address is that of the sample shown, never one before it', () => {
  for (const micros of [0, 1, 83_512_345_678, 999, 1_000_000]) {
    const read = shownIn(withShown(at('?camera=front'), { micros })).micros;
    assert.ok(read >= micros - 1e-3 && read < micros + 1.01, `${micros} became ${read}`);
  }
  assert.equal(withShown(at('?t=5&camera=front'), { micros: null }).search, '?camera=front');
});

test('a moment of a recording is that of the sample shown, never one before it', () => {
  for (const place of [0, 2.5, 2.508333, 83.000001, 600]) {
    const read = shownIn(withShown(at('?camera=front'), { place })).place;
    assert.ok(read >= place - 1e-9 && read < place + 0.00101, `${place} became ${read}`);
  }
  assert.equal(withShown(at(''), { place: 2.5 }).search, '?at=2.5');
  assert.equal(withShown(at('?t=5&camera=front'), { micros: null, place: 1 }).search, '?camera=front&at=1');
  for (const query of ['', '?at=', '?at=now', '?at=-5', '?at=Infinity']) assert.equal(shownIn(at(query)).place, null, query);
});

const ALL = { micros: 83_512_345_679, place: 2.5, person: 2, joints: ['l5_s1', 'right_knee'], camera: 'front', tab: 'plots', window: 300, loads: 'both', speed: 0.25,
  view: 'phone', theme: 'dark', hidden: [] };

test('all that a link says is read as it was written', () => {
  for (const camera of ['front', '1.2,-3.4,1.5,0,0,1']) {
    const url = withShown(at(''), { ...ALL, camera });
    assert.deepEqual(shownIn(url), { ...ALL, camera });
    assert.ok(!url.search.includes('%'), url.search);
  }
});

test('what is not named stays, and null takes a value out', () => {
  const url = withShown(at('?quality=fine'), ALL);
  const next = withShown(url, { tab: 'body', camera: null });
  assert.deepEqual(shownIn(next), { ...ALL, tab: 'body', camera: null });
  assert.equal(withShown(url, Object.fromEntries(Object.keys(ALL).map((name) => [name, null]))).search, '?quality=fine');
});

test('values that are none are ignored', () => {
  const none = { micros: null, place: null, person: null, joints: null, camera: null, tab: null, window: null, loads: null, speed: null, view: null, theme: null, hidden: [] };
  assert.deepEqual(shownIn(at('?t=x&at=x&person=1.5&joint=<b>,A&camera=<img>&tab=%00&window=-3&loads=none&speed=3&view=cinema&theme=pink')), none);
  assert.deepEqual(shownIn(at('?t=&at=&person=&joint=&camera=&tab=&window=&loads=&speed=&view=&theme=')), none);
  assert.equal(shownIn(at(`?camera=${'a'.repeat(500)}`)).camera, null);
  assert.equal(shownIn(at(`?joint=${Array(500).fill('neck').join()}`)).joints.length, 15);
});

test('parts of the scene are hidden by the names that render has; others are ignored, and links keep them', () => {
  const url = at('?hide=shadows,loads,<b>,body,legs');
  assert.deepEqual(shownIn(url).hidden, ['body', 'loads', 'shadows']);
  assert.deepEqual(shownIn(withShown(url, ALL)).hidden, ['body', 'loads', 'shadows']);
  assert.deepEqual(shownIn(at('?hide=')).hidden, []);
});
