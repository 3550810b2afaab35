import assert from 'node:assert/strict';
import { test } from 'node:test';
import { detailText, headline, valueText } from '../../../web/alarm_text.js';

const at = (micros) => ({ state: 1, micros, stamp_micros: micros });
const alarm = (of) => ({
  id: 1, rule: 'high compression', priority: 'high', quantity: 'compression', unit: 'N', limit: 3400, person: 0, name: 'Anna', joint: null,
  value: 3720, worst: 4100, times: 1, began: at(2e6), over: null, is_on: true, is_shown: true, acknowledged: null, ...of,
});
const label = (name) => name.toUpperCase();

test('the headline is person, number and its name; afterwards the worst', () => {
  assert.equal(headline(alarm({}), label), 'Anna 3.72 kN compression');
  assert.equal(headline(alarm({ is_on: false, over: at(4e6) }), label), 'Anna 4.10 kN compression');
  assert.equal(headline(alarm({ quantity: 'ratio', unit: '1', joint: 'l5_s1', value: 0.764 }), label), 'Anna L5_S1 76 % load');
  assert.equal(headline(alarm({ quantity: 'class', unit: '1', joint: 'l5_s1', value: 'high' }), label), 'Anna L5_S1 high load class');
  assert.equal(headline(alarm({ quantity: 'lost', unit: 's', value: 3.14 }), label), 'Anna lost for 3.1 s');
  assert.equal(headline(alarm({ quantity: 'stale', unit: 's', name: '', value: 0.7 }), label), 'Stream: no sample for 0.7 s');
  assert.equal(headline(alarm({ quantity: 'loss', unit: '1', name: '', value: 0.054 }), label), 'Stream 5.4 % of the samples lost');
});

test('a margin is in centimetres, with a real minus', () => {
  assert.equal(valueText(-0.104, alarm({ quantity: 'margin', unit: 'm' })), '−10.4 cm');
});

test('the second line has rule, limit, duration, and how many others there are', () => {
  assert.equal(detailText(alarm({}), 0, 5.9e6), 'high compression: limit 3.40 kN · for 3.9 s');
  assert.equal(detailText(alarm({ over: at(3e6), is_on: false, times: 2 }), 1, 9e6),
    'high compression: limit 3.40 kN · over after 1.0 s · 2 times · 1 more');
  assert.equal(detailText(alarm({ acknowledged: { role: 'operator', micros: 1 } }), 0, 5.9e6),
    'high compression: limit 3.40 kN · for 3.9 s · acknowledged by operator');
});
