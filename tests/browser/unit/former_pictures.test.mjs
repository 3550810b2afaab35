import assert from 'node:assert/strict';
import test from 'node:test';
import { addressOf, FormerPictures } from '../../../web/former_pictures.js';

const LOOK = { camera: 'front', isDark: false, width: 640, height: 360 };

/** A server whose answers come when the test says so. */
function setUp() {
  const asked = [], shown = [], failed = [];
  const pictures = new FormerPictures((address) => new Promise((resolve, reject) => { asked.push({ address, resolve, reject }); }),
    (picture, state) => shown.push([picture, state]), (error) => failed.push(error.message));
  return { pictures, asked, shown, failed };
}
const want = (pictures, state, now = 0) => pictures.want(state === null ? null : { ...LOOK, state }, now);
const settle = () => new Promise((resolve) => { setImmediate(resolve); });

test('an address has the state and the look of the picture', () => {
  assert.equal(addressOf({ ...LOOK, state: 7 }), 'api/v1/snapshot.png?state=7&camera=front&theme=light&width=640&height=360');
  assert.equal(addressOf({ ...LOOK, state: null, camera: '', isDark: true }), 'api/v1/snapshot.png?theme=dark&width=640&height=360');
});

test('one picture is asked for at a time, and then the one that is wanted by then', async () => {
  const { pictures, asked, shown } = setUp();
  for (const state of [1, 2, 3]) want(pictures, state);
  assert.equal(asked.length, 1);
  asked[0].resolve('first');
  await settle();
  assert.deepEqual(shown, [['first', 1]]);
  want(pictures, 4);
  assert.match(asked[1].address, /state=4&/);
  asked[1].resolve('fourth');
  await settle();
  want(pictures, 4);
  assert.equal(asked.length, 2, 'it is shown already');
});

test('a picture that comes after its viewer has gone to live is not shown', async () => {
  const { pictures, asked, shown } = setUp();
  want(pictures, 1);
  want(pictures, null);
  asked[0].resolve('late');
  await settle();
  assert.deepEqual(shown, []);
  want(pictures, 1);
  assert.equal(asked.length, 2);
});

test('a refusal is said, and asked again after a second', async () => {
  const { pictures, asked, failed } = setUp();
  want(pictures, 1, 1000);
  asked[0].reject(new Error('state 1 is no longer kept'));
  await settle();
  assert.deepEqual(failed, ['state 1 is no longer kept']);
  want(pictures, 2, 1900);
  assert.equal(asked.length, 1);
  want(pictures, 2, 2000);
  assert.equal(asked.length, 2);
});
