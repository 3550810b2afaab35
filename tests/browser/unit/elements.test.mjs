import assert from 'node:assert/strict';
import test from 'node:test';
import { ELEMENTS, findElements } from '../../../web/elements.js';

/** A page with these elements only. */
const pageOf = (tags) => ({ getElementById: (id) => (id in tags ? { id, localName: tags[id] } : null) });

test('every element is found by its id', () => {
  const found = findElements(pageOf(ELEMENTS));
  assert.deepEqual(Object.keys(found), Object.keys(ELEMENTS));
  assert.equal(found['picture-image'].localName, 'img');
});

test('missing elements and those with other tags are named in one error', () => {
  const { rate, ...others } = ELEMENTS;
  assert.throws(() => findElements(pageOf({ ...others, 'picture-on': 'span' })),
    /^Error: index\.html has no <dd id="rate">, <input id="picture-on">; reload the page$/);
});
