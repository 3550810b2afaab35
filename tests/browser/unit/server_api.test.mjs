import assert from 'node:assert/strict';
import { afterEach, test } from 'node:test';
import { object, string } from '../../../web/messages.js';
import { ask, messageOf, ownRejectionOf, rejectionOf, request } from '../../../web/server_api.js';

const realFetch = globalThis.fetch;
afterEach(() => { globalThis.fetch = realFetch; });
const answerWith = (body, init) => { globalThis.fetch = async () => new Response(body, init); };
const readName = object({ name: string });
const html = { headers: { 'Content-Type': 'text/html' } };

test('an answer is checked for its members', async () => {
  answerWith('{"name": "front"}');
  assert.deepEqual(await ask('api/v1/camera', readName), { name: 'front' });
  answerWith('{"name": 5}');
  await assert.rejects(ask('api/v1/camera', readName), /sent 5 as api\/v1\/camera\.name; expected a text/);
});

test('a request without a server returns null and no error', async () => {
  globalThis.fetch = async () => { throw new TypeError('Failed to fetch'); };
  assert.equal(await ask('api/v1/camera', readName), null);
});

test('a rejection has the error text of the server', async () => {
  answerWith('{"error": "no camera \'x\'"}', { status: 404 });
  await assert.rejects(ask('api/v1/camera', readName), /^Error: no camera 'x'$/);
});

test('a request that fails has an error text for the user', async () => {
  globalThis.fetch = async () => { throw new TypeError('Failed to fetch'); };
  await assert.rejects(request('api/v1/hand_load', { method: 'POST' }), /^Error: no connection to the server$/);
  answerWith('{"error": "no person in the stream yet"}', { status: 409 });
  await assert.rejects(request('api/v1/hand_load', { method: 'POST' }), /^Error: no person in the stream yet$/);
  answerWith('{}');
  assert.equal((await request('api/v1/hand_load', { method: 'POST' })).status, 200);
});

test('an HTML answer of a proxy is reported with its type or status', async () => {
  answerWith('<html>', html);
  await assert.rejects(ask('api/v1/camera', readName), /api\/v1\/camera returned text\/html, expected JSON/);
  answerWith('<html>', { ...html, status: 502 });
  await assert.rejects(ask('api/v1/camera', readName), /^Error: HTTP status 502$/);
  assert.equal(await rejectionOf(new Response('<html>', { status: 502 })), 'HTTP status 502');
  assert.equal(await ownRejectionOf(new Response('<html>', { status: 502 })), null, 'it is not our server that refuses');
});

test('every thrown value has a message', () => {
  assert.equal(messageOf(new Error('why')), 'why');
  assert.equal(messageOf('why'), 'why');
});

test('every request has the header that only this page can set, and keeps its own', async () => {
  const sent = [];
  globalThis.fetch = async (route, options) => {
    sent.push(options.headers);
    return new Response('{}');
  };
  await ask('api/v1/state', (value) => value);
  await request('api/v1/snapshot.png');
  await request('api/v1/hand_load', { method: 'POST', headers: { 'Content-Type': 'application/json' } });
  const ours = { 'X-Kinescope-Page': '1' };
  assert.deepEqual(sent, [ours, ours, { 'Content-Type': 'application/json', ...ours }]);
});
