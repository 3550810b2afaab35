// The connection with a WebSocket that the test holds both ends of.
import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { Connection } from '../../../web/connection.js';
import { holdTimers } from './held_timers.mjs';

class FakeSocket {
  static OPEN = 1;
  static newest = null;
  readyState = FakeSocket.OPEN;
  sent = [];
  constructor(url, protocol) { Object.assign(this, { url, protocol }); FakeSocket.newest = this; }
  send(text) { this.sent.push(JSON.parse(text)); }
  close() { this.onclose(); }
  receive(data) { this.onmessage({ data }); }
}

const real = { WebSocket: globalThis.WebSocket, location: globalThis.location, fetch: globalThis.fetch };
beforeEach(() => { Object.assign(globalThis, { WebSocket: FakeSocket, location: { href: 'http://localhost:8080/' } }); });
afterEach(() => { Object.assign(globalThis, real); });

/** An open connection; `seen` lists what its handlers were told. */
function open() {
  const seen = [];
  const tell = (name) => (value) => seen.push([name, value]);
  const connection = new Connection({ onState: tell('state'), onPicture: tell('picture'), onDetails: tell('details'),
    onError: tell('error'), onOpen: () => {} });
  FakeSocket.newest.onopen();
  return { connection, seen, socket: FakeSocket.newest };
}

test('an invalid message is reported, and the next one is accepted', (t) => {
  holdTimers(t, ['setTimeout']);  // its pings
  const { seen, socket, connection } = open();
  const details = { source: 'udp://:9763', camera: 'front', has_pictures: true, people: [], objects: [], left_out: [],
    recording: null, marks_revision: null, class_limits: [0.3, 0.6] };
  socket.receive(JSON.stringify({ details: { ...details, people: 'many' } }));
  socket.receive('<html>');
  socket.receive('null');
  socket.receive(new Uint8Array([1, 99]).buffer);
  socket.receive(JSON.stringify({ details }));
  assert.deepEqual(seen.map(([name]) => name), ['error', 'error', 'error', 'error', 'details']);
  assert.match(seen[0][1], /sent "many" as details\.people; expected a list; reload the page/);
  assert.equal(seen[1][1], 'the server sent a message that is not JSON; check for a proxy in front of the server');
  assert.match(seen[2][1], /sent null as a message; expected an object/);
  assert.match(seen[3][1], /version 99/);
  assert.deepEqual(seen[4][1], details);
  connection.close();
});

test('a pong sets the clock', (t) => {
  holdTimers(t, ['setTimeout']);
  const { socket, connection } = open();
  const { ping } = socket.sent.find((message) => 'ping' in message);
  socket.receive(JSON.stringify({ pong: ping, server_micros: 1000 * (ping + 5000) }));
  assert.ok(Math.abs(connection.clock.offset - 5000) < 1000, `${connection.clock.offset} ms`);
  connection.close();
});

test('the WebSocket offers the version that the page reads, and a server of another one is named', async (t) => {
  holdTimers(t, ['setTimeout']);
  const { socket, connection } = open();
  assert.equal(`${socket.url}`, 'ws://localhost:8080/api/v1/ws');
  assert.equal(socket.protocol, 'kinescope.v4');
  const rejectionBy = async (answer) => {
    globalThis.fetch = async () => answer;
    await FakeSocket.newest.onclose();
    return connection.rejection;
  };
  const session = (name) => Response.json({ role: 'viewer', socket: name });
  assert.equal(await rejectionBy(session('kinescope.v5')),
    'the server sends kinescope.v5 and this page reads kinescope.v4; reload the page');
  assert.equal(await rejectionBy(session('kinescope.v4')), '', 'not the version: it tries again');
  assert.equal(await rejectionBy(Response.json({ error: 'token missing' }, { status: 401 })), 'token missing');
  connection.close();
});
