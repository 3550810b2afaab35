// A client of a Kinescope server, for this page and for programs of others: one WebSocket for states, pictures, former
// states and commands. It reconnects by itself, and only the newest state is decoded. It needs clock.js, messages.js,
// server_api.js and state_codec.js beside it and nothing else; docs/http.md has an example.
import { ServerClock } from './clock.js';
import { readSession, readTextMessage } from './messages.js';
import { messageOf, ownRejectionOf, request } from './server_api.js';
import { decodePast, decodePicture, decodeState, KIND, messageKind, SOCKET_PROTOCOL } from './state_codec.js';

const FIRST_RETRY_MILLIS = 400;
const LAST_RETRY_MILLIS = 4000;
const PING_MILLIS = 2000;
const FIRST_PINGS = 5;  // in quick succession, so that the first latency shown is correct
const FIRST_PING_MILLIS = 150;
const STATES_PER_REPORT = 4;  // the server sends up to 12 states beyond the last one reported as received
const OPEN = 1;  // WebSocket.OPEN

/** All are optional. They are called with values that have been checked.
 *  @typedef {Partial<{
 *    onState: (state: import('./state_codec.js').State) => void,
 *    onPicture: (picture: ReturnType<typeof decodePicture>) => void,
 *    onPast: (past: ReturnType<typeof decodePast>) => void,
 *    onDetails: (details: import('./messages.js').Details) => void,
 *    onStream: (stream: import('./messages.js').StreamHealth) => void,
 *    onControls: (controls: unknown) => void,
 *    onAlarms: (alarms: import('./messages.js').ShownAlarms) => void,
 *    onError: (reason: string) => void,
 *    onOpen: () => void,
 *    onClose: (reason: string) => void}>} Handlers
 *    onState: the newest state; those that came while the program was busy are left out. Without it, call takeState().
 *    onError: the server refuses a command, or a message is not as described; the connection goes on.
 *    onOpen: call `send` for what the program wants, such as {pictures: true}; also after each reconnection.
 *    onClose: the connection is lost or was refused, for `reason` ("" if the server is not reachable); it is tried again.
 *  @typedef {new (url: URL, protocol: string) => WebSocket} SocketMaker */

export class KinescopeClient {
  clock = new ServerClock();
  connected = false;
  everConnected = false;
  lastMessageAt = 0;  // performance.now()
  rejection = '';       // why the server rejected the connection; "" if it accepted it or is not reachable
  #base;
  #token;
  #Socket;
  /** @type {Handlers} */ #handlers;
  /** @type {WebSocket|null} */ #socket = null;
  /** @type {ArrayBuffer|null} */ #newest = null;  // not decoded yet
  #isDelivering = false;
  #retryMillis = FIRST_RETRY_MILLIS;
  /** @type {ReturnType<typeof setTimeout>|undefined} */ #retryTimer;
  /** @type {ReturnType<typeof setTimeout>|undefined} */ #pingTimer;
  #pings = 0;
  #states = 0;    // received since the connection was opened
  #pictures = 0;
  #closed = false;

  /** Connects at once.
   *  @param {Handlers} handlers
   *  @param {{url?: string|URL, token?: string, WebSocket?: SocketMaker}} [options]  url: of the server, as it prints it when it
   *    starts; default: where this page comes from. token: default: that of the url, else the cookie. WebSocket: for
   *    programs without a global one, such as Node before 22 */
  constructor(handlers, { url = location.href, token, WebSocket: Socket = globalThis.WebSocket } = {}) {
    if (!Socket) throw new Error('no global WebSocket (Node has one from 22): pass one as the option WebSocket');
    this.#base = new URL(url);
    this.#token = token ?? this.#base.searchParams.get('token');
    this.#handlers = handlers;
    this.#Socket = Socket;
    this.#open();
  }

  /** The newest state since the last call, decoded now; null if none has come. For programs that draw at a rate of their
   *  own, instead of onState.
   *  @returns {import('./state_codec.js').State|null}
   *  @throws {Error} if it is not as described */
  takeState() {
    const buffer = this.#newest;
    this.#newest = null;
    return buffer && decodeState(buffer);
  }

  /** Sends a command of the WebSocket. Without a connection it is dropped: send it again in onOpen if necessary.
   *  @param {object} command */
  send(command) {
    if (this.#socket?.readyState === OPEN) this.#socket.send(JSON.stringify(command));
  }

  /** Asks a route: GET, or POST with `order` as its body.
   *  @param {string} route  such as "api/v1/state"
   *  @param {object} [order]
   *  @returns {Promise<Response>}
   *  @throws {Error} with the reason if the server is unreachable or rejects the request */
  async ask(route, order) {
    /** @type {Record<string, string>} */ const headers = this.#token ? { Authorization: `Bearer ${this.#token}` } : {};
    if (order === undefined) return request(this.#address(route), { headers });
    headers['Content-Type'] = 'application/json';
    return request(this.#address(route), { method: 'POST', headers, body: JSON.stringify(order) });
  }

  close() {
    this.#closed = true;
    clearTimeout(this.#retryTimer);
    clearTimeout(this.#pingTimer);
    this.#socket?.close();
  }

  /** Milliseconds since the last message of the server.
   *  @param {number} now */
  silentMillis(now) {
    return now - this.lastMessageAt;
  }

  /** @param {string} route
   *  @returns {URL} */
  #address(route) {
    const url = new URL(route, this.#base);
    url.hash = '';
    return url;
  }

  #open() {
    const url = this.#address('api/v1/ws');
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    if (this.#token) url.searchParams.set('token', this.#token);  // scripts cannot give a WebSocket headers
    const socket = new this.#Socket(url, SOCKET_PROTOCOL);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.#onOpen();
    socket.onmessage = (event) => this.#onMessage(event.data);
    socket.onclose = () => this.#onClose();
    this.#socket = socket;
  }

  #onOpen() {
    this.connected = true;
    this.everConnected = true;
    this.rejection = '';
    this.lastMessageAt = performance.now();
    this.#retryMillis = FIRST_RETRY_MILLIS;
    this.clock.reset();
    this.#pings = 0;
    this.#states = 0;
    this.#pictures = 0;
    this.send({ seen_states: 0, seen_pictures: 0 });
    this.#ping();
    this.#handlers.onOpen?.();
  }

  async #onClose() {
    clearTimeout(this.#pingTimer);
    this.connected = false;
    if (this.#closed) return;
    this.rejection = await this.#whyRejected();
    this.#handlers.onClose?.(this.rejection);
    if (this.#closed) return;
    this.#retryTimer = setTimeout(() => this.#open(), this.#retryMillis);
    this.#retryMillis = Math.min(2 * this.#retryMillis, LAST_RETRY_MILLIS);
  }

  #ping() {
    this.send({ ping: performance.now() });
    this.#pings += 1;
    const pause = this.#pings < FIRST_PINGS ? FIRST_PING_MILLIS : PING_MILLIS;
    this.#pingTimer = setTimeout(() => this.#ping(), pause);
  }

  /** @param {unknown} data */
  #onMessage(data) {
    this.lastMessageAt = performance.now();
    try {
      if (typeof data === 'string') return this.#onText(readTextMessage(data));
      if (data instanceof ArrayBuffer) this.#onBinary(data);
    } catch (error) {
      this.#handlers.onError?.(messageOf(error));
    }
  }

  /** Reports the number of received messages. On a busy machine messages would otherwise queue in the browser, where
   *  the server cannot replace them by newer ones.
   *  @param {ArrayBuffer} data */
  #onBinary(data) {
    const kind = messageKind(data);
    if (kind === KIND.state) {
      this.#states += 1;
      if (this.#states % STATES_PER_REPORT === 0) this.send({ seen_states: this.#states });
      this.#newest = data;
      if (this.#handlers.onState && !this.#isDelivering) this.#deliverSoon();
    } else if (kind === KIND.picture) {
      this.#pictures += 1;
      this.send({ seen_pictures: this.#pictures });
      this.#handlers.onPicture?.(decodePicture(data));
    } else if (kind === KIND.past) {
      this.#handlers.onPast?.(decodePast(data));
    }
  }

  // After the messages that wait already: of these only the newest is decoded.
  #deliverSoon() {
    this.#isDelivering = true;
    setTimeout(() => {
      this.#isDelivering = false;
      try {
        const state = this.takeState();
        if (state) this.#handlers.onState?.(state);
      } catch (error) {
        this.#handlers.onError?.(messageOf(error));
      }
    }, 0);
  }

  /** @param {import('./messages.js').TextMessage|null} message */
  #onText(message) {
    if (message === null) return;
    if ('pong' in message) {
      this.clock.addPing(message.pong, this.lastMessageAt, message.server_micros / 1000);
    } else if ('details' in message) {
      this.#handlers.onDetails?.(message.details);
    } else if ('stream' in message) {
      this.#handlers.onStream?.(message.stream);
    } else if ('controls' in message) {
      this.#handlers.onControls?.(message.controls);
    } else if ('alarms' in message) {
      this.#handlers.onAlarms?.(message.alarms);
    } else {
      this.#handlers.onError?.(message.error);
    }
  }

  // A rejected WebSocket has no reason; the answers to plain requests have one.
  async #whyRejected() {
    try {
      const headers = this.#token ? { Authorization: `Bearer ${this.#token}` } : undefined;
      const answer = await fetch(this.#address('api/v1/session'), { headers });
      if (!answer.ok) return await ownRejectionOf(answer) ?? '';
      const { socket } = readSession(await answer.json(), 'api/v1/session');
      return socket === SOCKET_PROTOCOL ? ''
        : `the server sends ${socket} and this page reads ${SOCKET_PROTOCOL}; reload the page`;
    } catch {
      return '';  // no server reachable
    }
  }
}
