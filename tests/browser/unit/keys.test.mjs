import assert from 'node:assert/strict';
import test from 'node:test';
import { isCharacterKey, keyLabel, keyName, Keys } from '../../../web/keys.js';

const none = { code: '', shiftKey: false, ctrlKey: false, altKey: false, metaKey: false };
const key = (name, more = {}) => ({ ...none, key: name, ...more });

test('a key has one name on every keyboard', () => {
  assert.equal(keyName(key('p')), 'P');
  assert.equal(keyName(key('P', { shiftKey: true })), 'Shift+P');
  assert.equal(keyName(key(' ')), 'Space');
  assert.equal(keyName(key('%', { code: 'Digit5', shiftKey: true })), 'Shift+5');
  assert.equal(keyName(key('5', { code: 'Numpad5' })), '5');
  assert.equal(keyName(key('?', { code: 'Slash', shiftKey: true })), '?');
  assert.equal(keyName(key('ArrowLeft', { shiftKey: true })), 'Shift+ArrowLeft');
  assert.equal(keyName(key('z', { ctrlKey: true })), 'Ctrl+Z');
  assert.equal(keyName(key('ArrowLeft', { altKey: true })), '', 'that goes back in the browser');
  assert.equal(keyName(key('c', { metaKey: true })), '');
});

test('letters, digits and signs are keys of one character, with and without Shift', () => {
  for (const name of ['P', 'Shift+P', '5', 'Shift+5', '?', '[', '+']) assert.ok(isCharacterKey(name), name);
  for (const name of ['Space', 'Escape', 'ArrowLeft', 'Shift+ArrowLeft', 'Ctrl+Z', 'Home']) assert.ok(!isCharacterKey(name), name);
});

test('the key map writes keys as they are on a keyboard', () => {
  assert.equal(keyLabel('Shift+ArrowLeft'), 'Shift + ←');
  assert.equal(keyLabel('+'), '+');
  assert.equal(keyLabel('Escape'), 'Esc');
});

globalThis.HTMLElement ??= class {};  // of browsers

class Page {
  isDialogOpen = false;
  addEventListener(_, act) { this.act = act; }
  querySelector() { return this.isDialogOpen ? {} : null; }
  press(event) {
    let isTaken = false;
    this.act({ ...event, target: null, preventDefault() { isTaken = true; } });
    return isTaken;
  }
}

function keysOf(page, isOn = () => true) {
  const done = [], keys = new Keys(page, isOn);
  keys.add('View', 'P', 'next', () => done.push('next'));
  keys.add('View', 'Shift+P', 'previous', () => done.push('previous'));
  keys.add('View', 'F', 'front', () => done.push('front'));
  keys.add('Time', 'Space', 'pause', () => done.push('pause'));
  keys.add('Time', 'ArrowLeft', 'back', () => done.push('back'), { repeats: true });
  keys.add('Map', 'F', 'shown only', null);
  return { keys, done };
}

test('a key acts once, unless it repeats; one with Shift that is not in the list acts as without', () => {
  const page = new Page(), { done } = keysOf(page);
  page.press(key('p'));
  page.press(key('P', { shiftKey: true }));
  page.press(key('F', { shiftKey: true }));
  page.press(key('p', { repeat: true }));
  page.press(key('ArrowLeft', { repeat: true }));
  assert.deepEqual(done, ['next', 'previous', 'front', 'back']);
  assert.equal(page.press(key('x')), false, 'what is not in the list is left to the browser');
});

test('the switch turns keys of one character off, and only those', () => {
  const page = new Page(), { keys, done } = keysOf(page);
  keys.hasCharacters = false;
  assert.equal(page.press(key('p')), false);
  page.press(key(' '));
  assert.deepEqual(done, ['pause']);
});

test('there are no keys while a dialog is open, and none on a wall', () => {
  const page = new Page(), { done } = keysOf(page), wall = new Page(), { done: doneOnWall } = keysOf(wall, () => false);
  page.isDialogOpen = true;
  page.press(key('p'));
  wall.press(key('p'));
  assert.deepEqual([done, doneOnWall], [[], []]);
});
