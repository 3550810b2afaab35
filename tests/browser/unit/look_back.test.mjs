import assert from 'node:assert/strict';
import test from 'node:test';
import { LookBack } from '../../../web/look_back.js';

function setUp() {
  const sent = /** @type {any[]} */ ([]);
  return { sent, look: new LookBack((command) => sent.push(command)) };
}

test('one request is under way, and of those that wait only the newest is sent', () => {
  const { sent, look } = setUp();
  look.ask({ micros: 10 }, 0);
  look.ask({ micros: 20 }, 1);
  look.ask({ micros: 30 }, 2);
  assert.deepEqual(sent, [{ look: { id: 1, micros: 10 } }]);
  assert.equal(look.onAnswer(1, 3), true);
  assert.deepEqual(sent[1], { look: { id: 2, micros: 30 } });
  assert.equal(look.onAnswer(1, 4), false, 'an answer that came before');
  assert.equal(look.onAnswer(2, 5), true);
  assert.equal(sent.length, 2);
});

test('an answer that never comes is given up', () => {
  const { sent, look } = setUp();
  look.ask({ number: 5 }, 0);
  look.ask({ number: 6 }, 100);
  assert.equal(sent.length, 1);
  look.ask({ number: 7 }, 2500);
  assert.deepEqual(sent[1], { look: { id: 2, number: 7 } });
});

test('answers after the return to live are not wanted', () => {
  const { look } = setUp();
  look.ask({ micros: 10 }, 0);
  look.stop();
  assert.equal(look.onAnswer(1, 1), false);
});
