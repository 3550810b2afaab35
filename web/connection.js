// The page's only connection: one WebSocket for state, pictures and commands. It reconnects automatically.
import { ServerClock } from './clock.js';
import { readTextMessage } from './messages.js';
import { messageOf, ownRejectionOf } from './server_api.js';
import { KIND, messageKind } from './state_codec.js';

const FIRST_RETRY_MILLIS = 400;
const LAST_RETRY_MILLIS = 4000;
const PING_MILLIS = 2000;
const FIRST_PINGS = 5;  // in quick succession, so that the first latency shown is correct
const FIRST_PING_MILLIS = 150;
const STATES_PER_REPORT = 4;  // the server sends up to 12 states beyond the last one reported as received

/** @typedef {{onState: (buffer: ArrayBuffer) => void, onPicture: (buffer: ArrayBuffer) => void,
 *    onPast: (buffer: ArrayBuffer) => void,
 *    onDetails: (details: import('./messages.js').Details) => void,
 *    onStream: (stream: import('./messages.js').StreamHealth) => void,
 *    onAlarms: (alarms: import('./messages.js').ShownAlarms) => void, onError: (reason: string) => void,
 *    onOpen: () => void}} Handlers */

export class Connection {
  clock = new ServerClock();
  connected = false;
  everConnected = false;
  lastMessageAt = 0;  // performance.now()
  rejection = '';       // why the server rejected the connection; "" if it accepted it or is not reachable
  #retryMillis = FIRST_RETRY_MILLIS;
  /** @type {WebSocket|null} */ #socket = null;
  /** @type {ReturnType<typeof setTimeout>|undefined} */ #pingTimer;
  #pings = 0;
  #states = 0;    // received since the connection was opened
  #pictures = 0;
  #closed = false;

  /** @param {Handlers} handlers */
  constructor(handlers) {
    this.handlers = handlers;
    this.#open();
  }

  /** Sends a command. Without a connection it is dropped; the caller repeats it in onOpen if necessary.
   *  @param {object} command */
  send(command) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(command));
  }

  close() {
    this.#closed = true;
    this.#socket?.close();
  }

  /** Milliseconds since the last message of the server.
   *  @param {number} now */
  silentMillis(now) {
    return now - this.lastMessageAt;
  }

  #open() {
    const url = new URL('ws', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    url.search = '';
    const socket = new WebSocket(url);
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
    this.handlers.onOpen();
  }

  async #onClose() {
    clearTimeout(this.#pingTimer);
    this.connected = false;
    if (this.#closed) return;
    this.rejection = await askWhyRejected();
    setTimeout(() => this.#open(), this.#retryMillis);
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
      this.handlers.onError(messageOf(error));
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
      this.handlers.onState(data);
    } else if (kind === KIND.picture) {
      this.#pictures += 1;
      this.send({ seen_pictures: this.#pictures });
      this.handlers.onPicture(data);
    } else if (kind === KIND.past) {
      this.handlers.onPast(data);
    }
  }

  /** @param {import('./messages.js').TextMessage|null} message */
  #onText(message) {
    if (message === null) return;
    if ('pong' in message) {
      this.clock.addPing(message.pong, this.lastMessageAt, message.server_micros / 1000);
    } else if ('details' in message) {
      this.handlers.onDetails(message.details);
    } else if ('stream' in message) {
      this.handlers.onStream(message.stream);
    } else if ('alarms' in message) {
      this.handlers.onAlarms(message.alarms);
    } else {
      this.handlers.onError(message.error);
    }
  }
}

// A rejected WebSocket has no reason; the answer to a plain request has one.
async function askWhyRejected() {
  try {
    const answer = await fetch('api/cameras');
    return answer.ok ? '' : await ownRejectionOf(answer) ?? '';
  } catch {
    return '';  // no server reachable
  }
}
