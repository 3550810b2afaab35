import assert from 'node:assert/strict';
import test from 'node:test';
import { Marks } from '../../../web/marks.js';

const RUN = 7;
const storage = () => {
  const kept = new Map();
  return { getItem: (name) => kept.get(name) ?? null, setItem: (name, text) => kept.set(name, text) };
};
const moment = { state: 1, micros: 5, stamp_micros: 5, time_code_millis: 0, counter: 1 };
const markOf = (order, id) => ({ id, revision: id, run_micros: RUN, kind: 'mark', button: 0, text: order.text, role: 'operator',
  at: moment, end: null, is_open: false, is_removed: false, behind_secs: 0 });

/** Answers as the server does; keeps what it was sent. */
function serverOf() {
  const sent = [];
  globalThis.fetch = async (route, options) => {
    if (options?.method === 'POST') sent.push(JSON.parse(options.body));
    const answer = options?.method === 'POST' ? markOf(sent.at(-1), sent.length)
      : { names: [], run_micros: RUN, revision: 0, marks: [] };
    return new Response(JSON.stringify(answer), { status: 200, headers: { 'Content-Type': 'application/json' } });
  };
  return sent;
}

test('marks that wait for the server outlive the page that set them', async () => {
  const store = storage();
  serverOf();
  const first = new Marks(() => {}, store);
  await first.update(1, 0);
  globalThis.fetch = async () => { throw new TypeError('no connection'); };
  assert.equal(await first.add({ state: 1, text: 'stumbles' }), null);
  assert.equal(await first.add({ state: 2, text: 'rests' }), null);

  const second = new Marks(() => {}, store);
  assert.equal(second.waiting, 2);
  const sent = serverOf();
  const { kept, lost } = await second.sendWaiting(1e6);
  assert.deepEqual(lost, []);
  assert.deepEqual(kept.map(({ text }) => text), ['stumbles', 'rests']);
  assert.deepEqual(sent.map(({ text }) => text), ['stumbles', 'rests']);
  assert.equal(new Marks(() => {}, store).waiting, 0, 'they are sent once');
});

test('a store that is full, forbidden, or holds something else, is no store', async () => {
  for (const text of ['{', 'null', '{"a":1}', '[1,null,{"order":null,"what":"x","runMicros":1}]']) {
    assert.equal(new Marks(() => {}, { getItem: () => text, setItem: () => {} }).waiting, 0, text);
  }
  const forbidden = { getItem: () => { throw new Error('forbidden'); }, setItem: () => { throw new Error('full'); } };
  const marks = new Marks(() => {}, forbidden);
  globalThis.fetch = async () => { throw new TypeError('no connection'); };
  assert.equal(await marks.add({ state: 1, text: 'stumbles' }), null);
  assert.equal(marks.waiting, 1);
});

test('the list is sorted once after each change, not at each look', async () => {
  const marks = new Marks(() => {});
  serverOf();
  await marks.update(1, 0);
  const empty = marks.list();
  assert.equal(marks.list(), empty);
  await marks.add({ state: 1, text: 'rests' });
  assert.notEqual(marks.list(), empty);
  assert.equal(marks.list(), marks.list());
});
