import assert from 'node:assert/strict';
import test from 'node:test';
import { LookBack } from '../../../web/look_back.js';

const RUN = { micros: 50, until_micros: 90, every_micros: 0 };

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
  assert.deepEqual(look.onAnswer(1, 3)?.wanted, { micros: 10 });
  assert.deepEqual(sent[1], { look: { id: 2, micros: 30 } });
  assert.equal(look.onAnswer(1, 4), null, 'an answer that came before');
  assert.deepEqual(look.onAnswer(2, 5)?.wanted, { micros: 30 });
  assert.equal(look.onAnswer(2, 6), null, 'twice');
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
  assert.equal(look.onAnswer(1, 1), null);
});

test('a run waits for what is under way, and a single moment does not wait for a run', () => {
  const { sent, look } = setUp();
  look.ask({ micros: 10 }, 0);
  look.askRun(RUN, 1);
  assert.equal(sent.length, 1);
  look.onAnswer(1, 2);
  look.askRun(RUN, 3);
  look.askRun(RUN, 4);
  assert.deepEqual(sent.slice(1), [{ look: { id: 2, ...RUN } }]);
  look.ask({ micros: 20 }, 5);
  assert.deepEqual(sent[2], { look: { id: 3, micros: 20 } });
  assert.equal(look.onAnswer(2, 6), null, 'the run is not wanted any longer');
  assert.deepEqual(look.onAnswer(3, 9), { wanted: { micros: 20 }, tookMillis: 4, leastMillis: 2 });
});

test('a new connection brings no answer of the one before', () => {
  const { sent, look } = setUp();
  look.ask({ micros: 10 }, 0);
  look.ask({ micros: 20 }, 1);
  look.onConnected();
  look.ask({ micros: 30 }, 2);
  assert.deepEqual(sent[1], { look: { id: 2, micros: 30 } });
  assert.equal(look.onAnswer(1, 3), null);
});
