import assert from 'node:assert/strict';
import test from 'node:test';
import { ViewerTime } from '../../../web/viewer_time.js';

const kept = { oldest: 1000, newest: 601_000 };

test('a viewer is live until they pause, and then stays at the moment on the screen', () => {
  const time = new ViewerTime();
  assert.equal(time.isLive, true);
  assert.equal(time.momentAt(5, kept), 601_000);
  time.pause(100, kept, 600_980);
  assert.equal(time.isLive, false);
  assert.equal(time.momentAt(9_000, { oldest: 1000, newest: 610_000 }), 600_980);
});

test('playing goes on from the pause, at any speed, and never jumps', () => {
  const time = new ViewerTime();
  time.pause(0, kept, 300_000);
  time.play(1000, kept);
  assert.equal(time.momentAt(1000, kept), 300_000);
  assert.equal(time.momentAt(3000, kept), 302_000);
  time.setSpeed(0.25, 3000, kept);
  assert.equal(time.momentAt(3000, kept), 302_000);
  assert.equal(time.momentAt(7000, kept), 303_000);
  time.pause(7000, kept);
  assert.equal(time.momentAt(99_000, kept), 303_000);
  assert.equal(time.speed, 0.25);
});

test('a viewer who plays faster than time catches up and is live', () => {
  const time = new ViewerTime();
  time.pause(0, kept, 600_000);
  time.setSpeed(8, 0, kept);
  time.play(0, kept);
  assert.equal(time.momentAt(100, kept), 600_800);
  assert.equal(time.momentAt(125, kept), 601_000);
  assert.equal(time.isLive, true);
  assert.equal(time.speed, 1);
});

test('a slower speed lets a live view fall behind', () => {
  const time = new ViewerTime();
  time.setSpeed(0.5, 0, kept);
  assert.equal(time.isLive, false);
  assert.equal(time.isPlaying, true);
  assert.equal(time.momentAt(1000, { oldest: 1000, newest: 602_000 }), 601_500);
});

test('a slider at its right end does not make a view live, and a moment that is gone becomes the oldest', () => {
  const time = new ViewerTime();
  time.seek(700_000, 0, kept);
  assert.equal(time.isLive, false);
  assert.equal(time.momentAt(0, kept), 601_000);
  time.seek(-5, 0, kept);
  assert.equal(time.momentAt(0, kept), 1000);
  assert.equal(time.isGone(0, { oldest: 1900, newest: 601_900 }), false, 'the oldest, as long ago as it was asked for');
  assert.equal(time.isGone(0, { oldest: 4000, newest: 604_000 }), true);
  assert.equal(time.momentAt(0, { oldest: 4000, newest: 604_000 }), 4000);
  time.goLive();
  assert.equal(time.isLive, true);
  assert.equal(time.isGone(0, kept), false);
});

test('what has ended is not live: it is paused at its end, and plays from the beginning', () => {
  const time = new ViewerTime(), ended = { ...kept, hasEnded: true };
  assert.equal(time.momentAt(0, ended), 601_000);
  assert.deepEqual([time.isLive, time.isPlaying], [false, false]);
  time.play(1000, ended);
  assert.equal(time.momentAt(1500, ended), 1500);
  time.goLive();
  assert.equal(time.momentAt(2000, ended), 601_000);
  assert.equal(time.isLive, false);
  time.seek(600_900, 3000, ended);
  time.setSpeed(8, 3000, ended);
  time.play(3000, ended);
  assert.equal(time.momentAt(3100, ended), 601_000);
  assert.deepEqual([time.isLive, time.isPlaying], [false, false]);
});

test('at the end of a recording, give or take the rounding of its time, playing begins at the oldest moment', () => {
  const ended = { ...kept, hasEnded: true };
  for (const [before, oldest] of [[0, true], [1e-8, true], [0.05, true], [10, false]]) {
    const time = new ViewerTime();
    time.pause(0, ended, kept.newest - before);
    time.play(0, ended);
    assert.equal(time.momentAt(0, ended), oldest ? kept.oldest : kept.newest - before, `${before} ms before it`);
  }
});
