import assert from 'node:assert/strict';
import test from 'node:test';
import { flagsApart } from '../../../web/flags.js';

const WINDOW = { from: 0, to: 1000 };
const xOf = (micros) => micros / 10;  // 100 px
const apart = (flags) => flagsApart(flags, WINDOW, xOf, 20);
const drawn = (flags) => apart(flags).map(({ hasRoom, ...flag }) => flag);
const flag = (micros, endMicros = null) => ({ micros, endMicros });

test('of ten thousand marks, no more are drawn than an axis of 100 px has room for', () => {
  const many = Array.from({ length: 10_000 }, (_, i) => flag(i / 10));
  const few = apart(many);
  assert.ok(few.length > 25 && few.length <= 34, `${few.length}`);
  assert.deepEqual(drawn(many)[0], many[0]);
  assert.ok(few.filter(({ hasRoom }) => hasRoom).length <= 5, 'signs of 20 px');
  const spans = Array.from({ length: 10_000 }, (_, i) => flag(i / 20, 500 + i / 20));
  assert.ok(apart(spans).length <= 67);
});

test('marks that have room are all drawn, and those of other times are not', () => {
  const flags = [flag(-5), flag(-20, -1), flag(0), flag(40), flag(90), flag(1000), flag(1001)];
  assert.deepEqual(drawn(flags), [flag(0), flag(40), flag(90), flag(1000)]);
});

test('a span that begins before the axis, or where another mark is, is drawn', () => {
  const flags = [flag(-100, 300), flag(400), flag(401, 800), flag(402, 700)];
  assert.deepEqual(drawn(flags), [flag(-100, 300), flag(400), flag(401, 800)]);
});

test('a sign is left out where it would lie on another', () => {
  const flags = [flag(-100, 300), flag(10), flag(100), flag(210), flag(400)];
  assert.deepEqual(apart(flags).map(({ hasRoom }) => hasRoom), [false, true, false, true, false]);
});
