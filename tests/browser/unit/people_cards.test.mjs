import assert from 'node:assert/strict';
import test from 'node:test';
import { ChosenPerson } from '../../../web/chosen_person.js';
import { placed } from '../../../web/head_names.js';
import { colorNumber, PERSON_COLORS, summaryOf } from '../../../web/person_cards.js';

const row = (key, label, loadClass, ratio) => ({ key, label, loadClass, ratio, moment: 1, capacity: 2, channel: '', reason: '' });
const person = { character: 3, compression: 2150, margin: 0.083 };

test('a card has the highest load and keeps it while another one is about as high', () => {
  const rows = [row('3/1', 'Ann: Right shoulder', 'medium', 0.5), row('3/2', 'Ann: L5/S1', 'medium', 0.51), row('3/3', 'Ann: Neck', 'low', 0.1)];
  assert.equal(summaryOf(person, rows, 'Ann', '').key, '3/1');
  assert.equal(summaryOf(person, rows, 'Ann', '3/2').key, '3/2');
  const { joint, loadClass, compression, margin } = summaryOf(person, rows, 'Ann', '3/1');
  assert.deepEqual([joint, loadClass, compression, margin], ['R shoulder', 'medium', 2150, 0.083]);
});

test('a person without known loads has no numbers, old ones neither', () => {
  const { joint, loadClass, ratio, compression, margin } = summaryOf(person, [row('3/1', 'Neck', 'unknown', NaN)], 'Ann', '3/1');
  assert.deepEqual([joint, loadClass, ratio, compression, margin], ['', 'unknown', NaN, NaN, NaN]);
  assert.equal(summaryOf(person, [], 'Ann', '').loadClass, 'unknown');
});

test('every character has a colour, and neighbours have others', () => {
  for (let character = -7; character < 20; ++character) {
    assert.ok(colorNumber(character) >= 1 && colorNumber(character) <= PERSON_COLORS);
    assert.notEqual(colorNumber(character), colorNumber(character + 1));
  }
});

test('the chosen person stays chosen while away; until then it is the first', () => {
  const chosen = new ChosenPerson(), people = [{ character: 1 }, { character: 4 }, { character: 9 }];
  let changes = 0;
  chosen.follow(() => { changes += 1; });
  assert.equal(chosen.of(people).character, 1);
  assert.equal(chosen.of([]), undefined);
  chosen.step(people, 1);
  assert.equal(chosen.of(people).character, 4);
  assert.equal(chosen.of([people[2]]).character, 9);
  assert.equal(chosen.of(people).character, 4);
  chosen.step(people, -1);
  chosen.step(people, -1);
  assert.equal(chosen.of(people).character, 9);
  chosen.choose(9);
  assert.equal(changes, 3);
});

const label = (character, x, y) => ({ character, x, y, width: 60, height: 20 });
const overlap = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

test('a name is over its head, and within the view', () => {
  assert.deepEqual(placed([label(1, 100, 80)], { width: 300, height: 200 }).map(({ x, y }) => [x, y]), [[70, 60]]);
  for (const [x, y] of [[0, 80], [300, 80], [100, 5], [100, 900], [-500, -500]]) {
    const [box] = placed([label(1, x, y)], { width: 300, height: 200 });
    assert.ok(box.x >= 0 && box.x + 60 <= 300 && box.y >= 0 && box.y + 20 <= 200, `${x}, ${y}: ${box.x}, ${box.y}`);
  }
});

test('no name lies over another one, wherever the heads are', () => {
  let seed = 7;
  const random = () => { seed = (seed * 16807) % 2147483647; return seed / 2147483647; };
  for (let round = 0; round < 500; ++round) {
    const labels = Array.from({ length: 5 }, (_, i) => label(i, 400 * random(), 120 * random()));
    const boxes = placed(labels, { width: 400, height: 300 });
    boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => assert.ok(!overlap(a, b), JSON.stringify(labels))));
  }
});
