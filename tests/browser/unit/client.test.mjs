// The client with a WebSocket that the test holds both ends of.
import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';
import { KinescopeClient } from '../../../web/client.js';
import { holdTimers } from './held_timers.mjs';
import { stateMessage } from './told_by_server.mjs';

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
function open(options) {
  const seen = [];
  const tell = (name) => (value) => seen.push([name, value]);
  const connection = new KinescopeClient({ onState: tell('state'), onPicture: tell('picture'), onDetails: tell('details'),
    onError: tell('error'), onClose: tell('close') }, options);
  FakeSocket.newest.onopen();
  return { connection, seen, socket: FakeSocket.newest };
}

test('an invalid message is reported, and the next one is accepted', (t) => {
  holdTimers(t, ['setTimeout']);  // its pings
  const { seen, socket, connection } = open();
  const details = { source: 'udp://:9763', camera: 'front', has_pictures: true, people: [], objects: [], left_out: [],
    images: [], recording: null, marks_revision: null, surroundings: null, class_limits: [0.3, 0.6], class_falls_below: [0.25, 0.55] };
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
  assert.equal(socket.protocol, 'kinescope.v10');
  const rejectionBy = async (answer) => {
    globalThis.fetch = async () => answer;
    await FakeSocket.newest.onclose();
    return connection.rejection;
  };
  const session = (name) => Response.json({ role: 'viewer', socket: name });
  assert.equal(await rejectionBy(session('kinescope.v11')),
    'the server sends kinescope.v11 and this page reads kinescope.v10; reload the page');
  assert.equal(await rejectionBy(session('kinescope.v10')), '', 'not the version: it tries again');
  assert.equal(await rejectionBy(Response.json({ error: 'token missing' }, { status: 401 })), 'token missing');
  connection.close();
});

test('of the states that wait, only the newest is decoded and delivered', (t) => {
  holdTimers(t, ['setTimeout']);
  const { socket, seen, connection } = open();
  const stateOf = (number) => {
    const bytes = new Uint8Array(stateMessage.slice(0));
    new DataView(bytes.buffer).setFloat64(8, number, true);
    return bytes.buffer;
  };
  for (const number of [7, 8, 9]) socket.receive(stateOf(number));
  assert.deepEqual(seen, [], 'the program may be busy with something else');
  t.mock.timers.tick(1);
  assert.deepEqual(seen.map(([name, { stateNumber }]) => [name, stateNumber]), [['state', 9]]);
  socket.receive(stateOf(10));
  assert.equal(connection.takeState().stateNumber, 10);
  assert.equal(connection.takeState(), null, 'taken already');
  t.mock.timers.tick(1);
  assert.equal(seen.length, 1, 'not delivered twice');
  socket.receive(stateOf(11).slice(0, 90));
  t.mock.timers.tick(1);
  assert.match(seen[1].join(), /error,message from the server is truncated/);
  connection.close();
});

test('what has been received is acknowledged, so that the server sends the newest', (t) => {
  holdTimers(t, ['setTimeout']);
  const { socket, connection } = open();
  for (let i = 0; i < 9; i += 1) socket.receive(stateMessage);
  const seen = socket.sent.filter((message) => 'seen_states' in message).map(({ seen_states: count }) => count);
  assert.deepEqual(seen, [0, 4, 8]);
  connection.close();
});

test('a lost connection is told with its reason and tried again, until it is closed', async (t) => {
  holdTimers(t, ['setTimeout']);
  const { socket, seen, connection } = open();
  globalThis.fetch = async () => { throw new TypeError('fetch failed'); };
  await socket.onclose();
  assert.deepEqual(seen, [['close', '']]);
  assert.equal(FakeSocket.newest, socket);
  t.mock.timers.tick(500);
  assert.notEqual(FakeSocket.newest, socket, 'a new one');
  const second = FakeSocket.newest;
  await second.onclose();
  connection.close();
  t.mock.timers.tick(10000);
  assert.equal(FakeSocket.newest, second, 'closed: no further one');
});

test('a program elsewhere gives the address of the server and its token', async (t) => {
  holdTimers(t, ['setTimeout']);
  const asked = [];
  globalThis.fetch = async (url, options) => {
    asked.push([`${url}`, options]);
    return Response.json({ person: 0 });
  };
  for (const options of [{ url: 'https://lab.example/kinescope/?token=s3cret-of-the-lab' },
    { url: 'https://lab.example/kinescope/', token: 's3cret-of-the-lab' }]) {
    const { connection, socket } = open(options);
    assert.equal(`${socket.url}`, 'wss://lab.example/kinescope/api/v1/ws?token=s3cret-of-the-lab');
    await connection.ask('api/v1/state');
    await connection.ask('api/v1/hand_load', { right_kg: 5 });
    connection.close();
  }
  const [[state, get], [load, post]] = asked;
  assert.equal(state, 'https://lab.example/kinescope/api/v1/state', 'the token is not in the address');
  assert.equal(get.headers.Authorization, 'Bearer s3cret-of-the-lab');
  assert.equal(load, 'https://lab.example/kinescope/api/v1/hand_load');
  assert.deepEqual([post.method, post.body, post.headers['Content-Type']], ['POST', '{"right_kg":5}', 'application/json']);
});

test('a program without a WebSocket is told how to give one', () => {
  globalThis.WebSocket = undefined;
  assert.throws(() => new KinescopeClient({}, { url: 'http://localhost:8080/' }), /no global WebSocket .*option WebSocket/);
});
