import assert from 'node:assert/strict';
import test from 'node:test';
import { RecentValues, ServerClock } from '../../../web/clock.js';

test('the offset is taken from the fastest ping', () => {
  const clock = new ServerClock();
  assert.equal(clock.at(100), null);
  clock.addPing(0, 80, 5070);      // slow on its way there: wrong by 30
  clock.addPing(100, 102, 5101);   // quick: 5000
  clock.addPing(200, 260, 5210);
  assert.equal(clock.offset, 5000);
  assert.equal(clock.at(300), 5300);
});

test('old pings are discarded, so that the clock follows a drift', () => {
  const clock = new ServerClock();
  clock.addPing(0, 1, 5000.5);
  for (let i = 0; i < 16; ++i) clock.addPing(100 * i, 100 * i + 4, 100 * i + 2 + 5003);
  assert.equal(clock.offset, 5003);
  clock.reset();
  assert.equal(clock.offset, null);
});

test('a ping is ignored if the clock jumps back meanwhile', () => {
  const clock = new ServerClock();
  clock.addPing(100, 90, 5000);
  assert.equal(clock.offset, null);
});

test('median and 95th percentile cover the last five seconds', () => {
  const values = new RecentValues();
  assert.equal(values.summary(0), null);
  for (let i = 0; i < 1000; ++i) values.add(1e6, i);
  for (let i = 1; i <= 100; ++i) values.add(i, 9000 + i);
  assert.deepEqual(values.summary(9100), { median: 51, p95: 96 });
  assert.equal(values.summary(14101), null);
});
