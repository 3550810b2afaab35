import assert from 'node:assert/strict';
import test from 'node:test';
import { countText, LossAlarm, lossText, streamLine, streamRows } from '../../../web/stream_health.js';

const quiet = {
  samples: 45678, lost: 0, loss_10s: 0, loss: 0, jitter_ms: 0.8, gaps: { count: 0, count_10s: 0, last_micros: null },
  incomplete: { count: 0, count_10s: 0, last_micros: null },
  rejected: [], clocks: [],
};
const NOW = 100_000;  // ms of the server's clock

test('the lamp warns when the loss is above 2 % for a second, and until it is below for five', () => {
  const alarm = new LossAlarm();
  /** When it is on, of calls every 100 ms. */
  const onAt = (from, to, loss) => {
    const on = [];
    for (let now = from; now < to; now += 100) if (alarm.update(loss, now)) on.push(now);
    return on;
  };
  assert.deepEqual(onAt(0, 2000, 0.02), [], '2 % is not above 2 %');
  assert.deepEqual(onAt(2000, 2900, 0.05), [], 'not for a second');
  assert.deepEqual(onAt(3000, 3100, 0.01), [], 'the second begins anew');
  assert.equal(onAt(4000, 6000, 0.05)[0], 5000);
  assert.equal(onAt(6000, 10_900, 0).at(-1), 10_800);
  assert.equal(onAt(11_000, 11_100, 0.03).length, 1, 'it came back in time');
  assert.equal(onAt(12_000, 20_000, 0).at(-1), 16_900);
  assert.equal(onAt(20_000, 30_000, null).length, 0, 'no samples are no loss');
});

test('the table shows the last ten seconds, all, and when last', () => {
  const stream = {
    ...quiet, lost: 1234, loss_10s: 0.0543, loss: 0.0263, gaps: { count: 812, count_10s: 9, last_micros: 99.4e6 },
    rejected: [{ reason: 'empty datagram', count: 2, count_10s: 0, last_micros: 10e6 },
      { reason: 'no <b>MXTP</b>', count: 1200, count_10s: 3, last_micros: 88e6 }],
  };
  assert.deepEqual(streamRows(stream, 4.2, NOW).map(({ name, recent, all, last, isRecent }) => [name, recent, all, last, isRecent]), [
    ['Loss', '5.4 %', '2.6 %', '0 s ago', true],
    ['Gaps', '9', '812', '0 s ago', true],
    ['Incomplete', '0', '0', 'never', false],
    ['Jitter', '0.8 ms', '–', '–', false],
    ['Age', '4.2 ms', '–', '–', false],
    ['Refused: no <b>MXTP</b>', '3', '1\u2009200', '12 s ago', true],
    ['Refused: empty datagram', '0', '2', '90 s ago', false],
  ]);
});

test('the frame of ROS in which the scene stands is the last row', () => {
  const last = (/** @type {string} */ frame) => streamRows(quiet, null, null, frame).at(-1);
  assert.equal(last('map')?.name, 'Frame of the scene: map');
  assert.equal(last('')?.name, 'Refused datagrams');
});

test('a problem that is over is history', () => {
  const stream = { ...quiet, lost: 12, loss: 0.0002627, gaps: { count: 3, count_10s: 0, last_micros: 10e6 } };
  const rows = streamRows(stream, 3210, NOW);
  assert.ok(rows.every(({ isRecent }) => !isRecent));
  assert.equal(rows[0].all, '0.026 %');
  assert.equal(rows[4].recent, '3.2 s');
  assert.equal(rows[1].last, '90 s ago');
  assert.deepEqual(rows[5], { name: 'Refused datagrams', recent: '0', all: '0', last: 'never', isRecent: false });
});

test('clocks and delays of the nodes of a ROS graph are shown, as far as they can be told apart', () => {
  const equal = { node: '/a', offset_ms: -0.4, uncertainty_ms: 3.1, delay_ms: 2.96, most_delay_ms: 12.4, lag_ms: 3.4, most_lag_ms: 12.8, excess_ms: 0, warning: '' };
  const behind = { ...equal, node: '/b', offset_ms: -2980.4, delay_ms: 51, most_delay_ms: 1234, warning: 'set it' };
  const unasked = { ...equal, node: '/xsens', offset_ms: null, uncertainty_ms: null, delay_ms: null, most_delay_ms: null, lag_ms: -700, most_lag_ms: -655, warning: 'set it' };
  const shown = (clocks) => streamRows({ ...quiet, clocks }, 3, NOW).slice(5, -1).map(({ name, recent, isRecent }) => [name, recent, isRecent]);
  assert.deepEqual(shown([equal, behind, unasked]), [
    ['Clock of /a', 'equal ± 3.1 ms', false], ['Delay from /a', '3.0 ms to 12 ms', false],
    ['Clock of /b', '2.98 s ± 3.1 ms behind', true], ['Delay from /b', '51 ms to 1.23 s', false],
    ['Stamp to arrival, /xsens', '−700 ms to −655 ms', true],
  ]);
  assert.equal(shown([{ ...equal, delay_ms: 3, most_delay_ms: 3 }])[1][1], '3.0 ms');
  const line = (...clocks) => streamLine({ ...quiet, clocks });
  assert.equal(line(equal), '0.0 % lost · jitter 0.8 ms');
  assert.equal(line(equal, behind), '0.0 % lost · jitter 0.8 ms · clock of /b 2.98 s behind');
  assert.equal(line({ ...behind, excess_ms: 2400 }), '0.0 % lost · jitter 0.8 ms · clock of /b 2.98 s behind, its stamps slowed down');
  assert.equal(line(unasked), '0.0 % lost · jitter 0.8 ms · stamps of /xsens 700 ms ahead');
  assert.equal(line(behind, unasked), '0.0 % lost · jitter 0.8 ms · 2 clocks differ');
});

test('unknown values are dashes', () => {
  const rows = streamRows({ ...quiet, loss_10s: null, loss: null, jitter_ms: null }, null, null);
  assert.deepEqual(rows.slice(0, 5).map(({ recent }) => recent), ['–', '0', '0', '–', '–']);
  assert.equal(streamRows({ ...quiet, gaps: { count: 1, count_10s: 1, last_micros: 5 } }, null, null)[1].last, '–');
});

test('one line says the same in short', () => {
  assert.equal(streamLine(quiet), '0.0 % lost · jitter 0.8 ms');
  assert.equal(streamLine({ ...quiet, loss_10s: null, jitter_ms: null }), 'no samples in 10 s');
  const refused = [{ reason: 'a', count: 9, count_10s: 2, last_micros: 1 }, { reason: 'b', count: 3, count_10s: 0, last_micros: 1 }];
  assert.equal(streamLine({ ...quiet, rejected: refused }), '0.0 % lost · jitter 0.8 ms · 2 refused');
  assert.equal(lossText(0.0204), '2.0 %');
  assert.equal(countText(1234567), '1\u2009234\u2009567');
  assert.equal(countText(999), '999');
});
