// Reads bytes that the C++ encoder has just written (page_fixture_server describe).
import assert from 'node:assert/strict';
import test from 'node:test';
import { decodePast, decodePicture, decodeState, KIND, messageKind, VERSION } from '../../../web/state_codec.js';
import { legendWords } from '../../../web/load_list.js';
import { stateMessage as state, toBuffer, told } from './told_by_server.mjs';

const HEADER = 96;  // bytes

/** Equal within what float32 (and a radius in whole millimetres) can hold; null stands for NaN. */
function assertClose(actual, expected, path = 'state') {
  if (typeof expected === 'number') {
    const tolerance = path.endsWith('.radius') ? 5.01e-4 : 1e-6 * Math.max(1, Math.abs(expected));
    assert.ok(Math.abs(actual - expected) <= tolerance, `${path}: ${actual}, expected ${expected}`);
  } else if (expected === null) {
    assert.ok(Number.isNaN(actual), `${path}: ${actual}, expected NaN`);
  } else if (typeof expected === 'object') {
    assert.deepEqual(Object.keys(actual).sort(), Object.keys(expected).sort(), path);
    for (const key of Object.keys(expected)) assertClose(actual[key], expected[key], `${path}.${key}`);
  } else {
    assert.equal(actual, expected, path);
  }
}

test('a state of two people, gloves, an object, a robot and a frame of the camera is decoded as the server encoded it', () => {
  assert.equal(messageKind(state), KIND.state);
  assertClose(decodeState(state), told.state);
});

test('former states come with the id of their request and with details, which are not repeated', () => {
  const past = toBuffer(told.past_hex);
  assert.equal(messageKind(past), KIND.past);
  const { id, untilMicros, formers } = decodePast(past);
  assert.equal(id, 7);
  assert.equal(untilMicros, 2_500_000);
  assert.equal(formers.length, 2);
  for (const former of formers) {
    assertClose(former.state, told.state);
    assert.deepEqual([former.stateNumber, former.madeMicros], [told.state.stateNumber, told.state.madeMicros]);
    assert.equal(former.details, '{"details": 5}');
  }
  for (const size of [7, 15, 20, past.byteLength - 1]) {
    assert.throws(() => decodePast(past.slice(0, size)), /truncated/, `taken at ${size} bytes`);
  }
  const none = past.slice(0, 16);
  new DataView(none).setUint16(2, 0, true);
  assert.throws(() => decodePast(none), /no former state/);
  const short = new Uint8Array(24 + 95);
  short.set(new Uint8Array(past.slice(0, 24)));
  short.set([1, 0], 2);          // states
  short.set([95, 0, 0, 0], 16);  // bytes of the first
  short.set([0, 0, 0, 0], 20);
  assert.throws(() => decodePast(short.buffer), /truncated/);
});

test('every truncated state is rejected', () => {
  for (let size = 0; size < state.byteLength; ++size) {
    assert.throws(() => decodeState(state.slice(0, size)), /truncated/, `taken at ${size} bytes`);
  }
});

test('a state with extra bytes is rejected', () => {
  const longer = new Uint8Array(state.byteLength + 1);
  longer.set(new Uint8Array(state));
  assert.throws(() => decodeState(longer.buffer), /too long/);
});

test('a person without links is rejected', () => {
  const other = new Uint8Array(HEADER + 64);
  other.set(new Uint8Array(state.slice(0, HEADER + 64)));
  other[3] = 1;       // people
  other[60] = 0;      // objects
  other[68] = 0;      // robots
  other.set([0, 0, 0], HEADER + 5);  // links, loads, solids
  other[HEADER + 60] = 0;            // corners
  assert.throws(() => decodeState(other.buffer), /without links/);
});

test('the error for another protocol version contains the instruction to reload', () => {
  const other = new Uint8Array(state.slice(0));
  other[1] = VERSION + 1;
  assert.throws(() => messageKind(other.buffer), new RegExp(`version ${VERSION + 1}.*reload`));
  assert.throws(() => messageKind(new ArrayBuffer(1)), /truncated/);
});

test('unknown classes of a newer server are read as unknown', () => {
  const other = new Uint8Array(state.slice(0));
  const firstLoad = HEADER + 64 + 28 * 23;
  other[firstLoad + 1] = 200;
  assert.equal(decodeState(other.buffer).people[0].loads[0].loadClass, 'unknown');
});

test('a picture contains the number of its state and its JPEG', () => {
  const picture = toBuffer(told.picture_hex);
  assert.equal(messageKind(picture), KIND.picture);
  const { stateNumber, arrivalMicros, jpeg } = decodePicture(picture);
  assert.deepEqual([stateNumber, arrivalMicros, ...jpeg], [41, 5000000, 0xff, 0xd8, 0xff]);
  assert.throws(() => decodePicture(picture.slice(0, 23)), /truncated/);
});

test('the legend shows the class limits of the server', () => {
  assert.deepEqual(legendWords(told.class_limits).map(([, text]) => text),
    ['low', 'medium > 30 %', 'high > 60 %', 'unknown']);
});
