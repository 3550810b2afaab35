import assert from 'node:assert/strict';
import test from 'node:test';
import { PlotWindow, windowName, WINDOWS_SECS } from '../../../web/plot_window.js';

const newest = 500e6;

test('live, the right edge is now', () => {
  const window = new PlotWindow();
  assert.deepEqual(window.at({ moment: newest, newest, isLive: true }), { from: newest - 60e6, to: newest });
});

test('behind, the window stays while the playhead moves in it, and goes along at its edges', () => {
  const window = new PlotWindow();
  window.at({ moment: newest, newest, isLive: true });
  const at = (moment, now = newest) => window.at({ moment, newest: now, isLive: false });
  assert.equal(at(newest - 30e6, newest + 9e6).to, newest);
  assert.equal(at(newest - 59e6).to, newest);
  assert.deepEqual(at(newest - 90e6), { from: newest - 90e6, to: newest - 30e6 });
  assert.equal(at(newest - 31e6).to, newest - 30e6);
  assert.equal(at(newest - 20e6).to, newest - 20e6);
});

test('another length has the moment in its middle, and nothing after now', () => {
  const window = new PlotWindow();
  window.setSecs(10);
  assert.deepEqual(window.at({ moment: newest - 100e6, newest, isLive: false }), { from: newest - 105e6, to: newest - 95e6 });
  window.setSecs(300);
  assert.equal(window.at({ moment: newest - 100e6, newest, isLive: false }).to, newest);
});

test('the lengths are 10 s to 10 min', () => {
  assert.deepEqual(WINDOWS_SECS.map(windowName), ['10 s', '30 s', '1 min', '5 min', '10 min']);
});
