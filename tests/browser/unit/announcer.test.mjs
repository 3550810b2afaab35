import assert from 'node:assert/strict';
import test from 'node:test';
import { Announcer, ClassChanges } from '../../../web/announcer.js';

const joint = (label, loadClass, ratio = 0.5) => ({ key: `0/${label}`, label, loadClass, ratio });

test('what is there at first is no change, and neither is a new percentage', () => {
  const changes = new ClassChanges();
  assert.equal(changes.update([joint('L5/S1', 'high')], 0), '');
  for (let now = 0; now < 20000; now += 150) assert.equal(changes.update([joint('L5/S1', 'high', now / 20000)], now), '');
});

test('a class is said once it has stayed, with its percentage', () => {
  const changes = new ClassChanges();
  changes.update([joint('L5/S1', 'low')], 0);
  assert.equal(changes.update([joint('L5/S1', 'high', 0.72)], 1000), '');
  assert.equal(changes.update([joint('L5/S1', 'high', 0.72)], 1300), '');
  assert.equal(changes.update([joint('L5/S1', 'high', 0.73)], 1700), 'L5/S1 high, 73 %');
  assert.equal(changes.update([joint('L5/S1', 'high', 0.74)], 1900), '');
});

test('a class that comes and goes is not said', () => {
  const changes = new ClassChanges();
  for (let now = 0; now < 10000; now += 300) assert.equal(changes.update([joint('Neck', now % 600 ? 'low' : 'medium')], now), '');
});

test('a new class of every joint each second is said at most every five seconds, the worst first and three of them', () => {
  const changes = new ClassChanges(), said = [], labels = ['A', 'B', 'C', 'D', 'E'];
  for (let now = 0; now <= 60000; now += 150) {
    const second = Math.floor(now / 1000);
    const text = changes.update(labels.map((label, i) => joint(label, ['low', 'medium', 'high'][(second + i) % 3], i / 10)), now);
    if (text) said.push({ now, text });
  }
  assert.ok(said.length >= 10 && said.length <= 12, `${said.length} times in a minute`);
  said.slice(1).forEach(({ now }, i) => assert.ok(now - said[i].now >= 5000));
  for (const { text } of said) {
    const classes = [...text.matchAll(/(high|medium|low)/g)].map(([word]) => ['high', 'medium', 'low'].indexOf(word));
    assert.ok(classes.length <= 3, text);
    assert.deepEqual(classes, [...classes].sort(), text);
  }
  assert.ok(said.some(({ text }) => /; and \d more$/.test(text)));
});

test('while the viewer looks back nothing is said, and going back to live is no change of class', () => {
  const region = { textContent: '' }, announcer = new Announcer(region);
  announcer.showClasses([joint('Neck', 'low')], true, 0);
  announcer.showClasses([joint('Neck', 'high')], false, 1000);
  announcer.showClasses([joint('Neck', 'high')], false, 9000);
  announcer.showClasses([joint('Neck', 'high')], true, 10000);
  announcer.showClasses([joint('Neck', 'high')], true, 20000);
  assert.equal(region.textContent, '');
  announcer.showClasses([joint('Neck', 'low', 0.1)], true, 21000);
  announcer.showClasses([joint('Neck', 'low', 0.1)], true, 22000);
  assert.equal(region.textContent, 'Neck low, 10 %');
});

test('the lamp is said when its state changes, not with each of its numbers', () => {
  const said = [], announcer = new Announcer({ set textContent(text) { said.push(text); } });
  const status = (level, word) => ({ level, word, note: '', banner: '', isFresh: true });
  announcer.showStatus(status('live', 'Live'), '');
  announcer.showStatus(status('behind', 'Behind −0.1 s'), '');
  for (let i = 2; i < 50; ++i) announcer.showStatus(status('behind', `Behind −0.${i} s`), '');
  announcer.showStatus(status('stale', 'Stale'), 'The stream has stopped: last sample received 1.0 s ago');
  for (let i = 1; i < 9; ++i) announcer.showStatus(status('stale', 'Stale'), `The stream has stopped: last sample received 1.${i} s ago`);
  announcer.showStatus(status('stale', 'Stale'), 'Nothing to undo');
  assert.deepEqual(said, ['Behind −0.1 s', 'Stale. The stream has stopped: last sample received 1.0 s ago', 'Nothing to undo']);
});
