import assert from 'node:assert/strict';
import test from 'node:test';
import { flagsApart } from '../../../web/flags.js';

const WINDOW = { from: 0, to: 1000 };
const xOf = (micros) => micros / 10;  // 100 px
const flag = (micros, endMicros = null) => ({ micros, endMicros });

test('of ten thousand marks, no more are drawn than an axis of 100 px has room for', () => {
  const many = Array.from({ length: 10_000 }, (_, i) => flag(i / 10));
  const drawn = flagsApart(many, WINDOW, xOf);
  assert.ok(drawn.length > 25 && drawn.length <= 34, `${drawn.length}`);
  assert.deepEqual(drawn[0], many[0]);
  const spans = Array.from({ length: 10_000 }, (_, i) => flag(i / 20, 500 + i / 20));
  assert.ok(flagsApart(spans, WINDOW, xOf).length <= 67);
});

test('marks that have room are all drawn, and those of other times are not', () => {
  const flags = [flag(-5), flag(-20, -1), flag(0), flag(40), flag(90), flag(1000), flag(1001)];
  assert.deepEqual(flagsApart(flags, WINDOW, xOf), [flag(0), flag(40), flag(90), flag(1000)]);
});

test('a span that begins before the axis, or where another mark is, is drawn', () => {
  const flags = [flag(-100, 300), flag(400), flag(401, 800), flag(402, 700)];
  assert.deepEqual(flagsApart(flags, WINDOW, xOf), [flag(-100, 300), flag(400), flag(401, 800)]);
});
