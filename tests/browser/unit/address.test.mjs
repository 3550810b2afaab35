import assert from 'node:assert/strict';
import test from 'node:test';
import { shownIn, withShown } from '../../../web/address.js';

const at = (query) => new URL(`http://127.0.0.1:8080/${query}`);

test('an address without a moment is live', () => {
  for (const query of ['', '?t=', '?t=now', '?t=-5', '?t=Infinity', '?camera=front']) {
    assert.equal(shownIn(at(query)).micros, null, query);
  }
});

test('a moment in the address is that of the sample shown, never one before it', () => {
  for (const micros of [0, 1, 83_512_345_678, 999, 1_000_000]) {
    const read = shownIn(withShown(at('?camera=front'), { micros })).micros;
    assert.ok(read >= micros - 1e-3 && read < micros + 1.01, `${micros} became ${read}`);
  }
  assert.equal(withShown(at('?t=5&camera=front'), { micros: null }).search, '?camera=front');
});
