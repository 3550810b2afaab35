// The marks of the server: what they are, and how they are set, ended and removed.
import { areAlike, placedIn } from './recorded_marks.js';
import { ask, messageOf, NoConnection, request } from './server_api.js';
import { boolean, listOf, number, object, optional, readMark, readMarks, string } from './messages.js';
import { runs } from './state_codec.js';

/** @typedef {import('./messages.js').Mark} Mark
 *  @typedef {{state: number, button?: number, text?: string, is_span?: boolean}} NewMark  state: number of the one on the
 *    screen; button: from 1 */

const RETRY_MILLIS = 3000;
const MOST_WAITING = 500;  // that are set while the server is away
const HEADERS = { 'Content-Type': 'application/json' };

const WAITING = 'kinescope-marks-that-wait';
const readOrders = listOf(object({
  order: object({
    id: optional(number), state: number, button: optional(number), text: optional(string), is_span: optional(boolean),
  }),
  what: string, runMicros: number,
}));

/** What an earlier page has left there; the store may hold anything.
 *  @param {Pick<Storage, 'getItem'>|null} store */
function readWaiting(store) {
  try {
    return readOrders(JSON.parse(store?.getItem(WAITING) ?? '[]'), WAITING).slice(0, MOST_WAITING);
  } catch {
    return [];
  }
}

/** Of a mark in lists and on the strip: the key of its button, ¶ free text, ✎ a change, ▶ a trial.
 *  @param {Mark} mark */
export const symbolOf = ({ button, kind }) => (button > 0 ? String(button) : { mark: '¶', change: '✎', trial: '▶' }[kind]);

export class Marks {
  /** @type {Map<number, Mark>} */ #marks = new Map();  // by id; without those that were removed
  /** @type {Mark[]|null} */ #sorted = null;  // null: they have changed
  #revision = -1;  // of what is here; -1: nothing was loaded yet
  #runMicros = 0;  // of the server whose marks are here
  /** @type {import('./recorded_marks.js').Anchor|null} */ #anchor = null;
  /** @type {Set<number>} */ #placed = new Set();  // ids of those of earlier runs that are in the recording that is played
  #isLoading = false;
  #retryAt = -Infinity;  // ms; after an error
  /** @type {string[]} */ names = [];  // of the buttons
  /** @type {{order: object, what: string, runMicros: number}[]} */ #waiting = [];  // for the server to come back
  #isSending = false;  // of these
  /** @type {number[]} */ #mine = [];  // ids of those that this page has set, which it may undo

  /** @param {() => void} changed
   *  @param {Pick<Storage, 'getItem'|'setItem'>|null} [store]  keeps those that wait, should the page be closed or loaded again */
  constructor(changed, store = null) {
    this.changed = changed;
    this.store = store;
    this.#waiting = readWaiting(store);
  }

  #keepWaiting() {
    try {
      this.store?.setItem(WAITING, JSON.stringify(this.#waiting));
    } catch {  // full, or not allowed: then they wait in this page alone
    }
  }

  /** In the order of their moments; those of earlier runs of the server first, unless its recording has their moments.
   *  Another list after each change.
   *  @returns {readonly Mark[]} */
  list() {
    this.#sorted ??= this.#place().sort((a, b) => this.#order(a) - this.#order(b) || a.at.micros - b.at.micros || a.id - b.id);
    return this.#sorted;
  }

  #place() {
    this.#placed.clear();
    return [...this.#marks.values()].map((mark) => {
      const placed = mark.run_micros === this.#runMicros || this.#anchor === null ? null : placedIn(mark, this.#anchor);
      if (placed) this.#placed.add(mark.id);
      return placed ?? mark;
    });
  }

  /** @param {Mark} mark */
  #order(mark) {
    return this.hasMoment(mark) ? this.#runMicros : mark.run_micros;
  }

  /** The recording that the server plays, and its newest state; null: the stream is live.
   *  @param {import('./messages.js').Recording|null} recording
   *  @param {import('./state_codec.js').State|null} newest */
  setPlayed(recording, newest) {
    if (recording === null) this.#setAnchor(null);
    else if (newest && runs(newest)) this.#setAnchor({ recording, ...newest });
    // The state that says that it is over is made later than its last sample was played.
    else if (newest && recording.ended_micros !== null) this.#setAnchor({ recording, ...newest, madeMicros: recording.ended_micros });
  }

  /** @param {import('./recorded_marks.js').Anchor|null} anchor */
  #setAnchor(anchor) {
    if (areAlike(this.#anchor, anchor)) return;
    this.#anchor = anchor;
    this.#sorted = null;
    this.changed();
  }

  /** Whether the server may have the moment of the mark: it was set since the server was started, or in the recording that
   *  is played.
   *  @param {Mark} mark */
  hasMoment(mark) {
    return mark.run_micros === this.#runMicros || this.#placed.has(mark.id);
  }

  /** Whether its moment was found in the recording: it is that of its sample but for how late the server makes states.
   *  @param {Mark} mark */
  isOfEarlierRun(mark) {
    return this.#placed.has(mark.id);
  }

  /** The last one that this page has set and that is still there. */
  get lastOwn() {
    const id = this.#mine.filter((each) => this.#marks.has(each)).at(-1);
    return id === undefined ? null : this.#marks.get(id) ?? null;
  }

  /** The span of this button that has no end yet.
   *  @param {number} button */
  openSpan(button) {
    return this.list().filter((mark) => mark.is_open && mark.button === button && mark.run_micros === this.#runMicros).at(-1) ?? null;
  }

  /** Another server may have come to the same revision by other changes. */
  forgetRevision() {
    this.#revision = -1;
  }

  /** @param {number|null} revision  of the server; null: it has no marks */
  isAt(revision) {
    return revision === null || (revision === this.#revision && !this.#isLoading);
  }

  /** Loads what has changed; call it several times a second with the server's revision.
   *  @param {number} revision
   *  @param {number} now  browser's clock, ms
   *  @returns {Promise<void>} */
  async update(revision, now) {
    if (this.#isLoading || revision === this.#revision || now < this.#retryAt) return;
    this.#isLoading = true;
    this.#retryAt = now + RETRY_MILLIS;
    try {
      for (let isComplete = false; !isComplete;) {
        const answer = await ask(`api/v1/marks?after=${Math.max(0, this.#revision)}`, readMarks);
        if (answer === null) return;
        if (answer.run_micros !== this.#runMicros && this.#runMicros !== 0) {
          this.#forget(answer.run_micros);  // another server: its revisions count from the beginning
          continue;
        }
        this.#runMicros = answer.run_micros;
        this.names = answer.names;
        for (const mark of answer.marks) {
          this.#put(mark);
          this.#revision = Math.max(this.#revision, mark.revision);
        }
        isComplete = answer.marks.length === 0 || this.#revision >= answer.revision;
        if (isComplete) this.#revision = answer.revision;
        this.#retryAt = -Infinity;
      }
    } finally {
      this.#isLoading = false;
      this.changed();
    }
  }

  /** @param {NewMark} mark
   *  @returns {Promise<Mark|null>}  null: it waits, because the server is away
   *  @throws {Error} with the reason if the server did not keep it */
  add(mark) {
    return this.#sendOrKeep(mark, mark.text ?? this.names[(mark.button ?? 0) - 1]);
  }

  /** @param {Mark} mark  a span
   *  @param {number} state
   *  @returns {Promise<Mark|null>}  as add() */
  end(mark, state) {
    return this.#sendOrKeep({ id: mark.id, state }, `the end of ${mark.text}`);
  }

  /** How many wait for the server. */
  get waiting() {
    return this.#waiting.length;
  }

  /** Sends those that wait, in their order; call it several times a second.
   *  @param {number} now  browser's clock, ms
   *  @returns {Promise<{kept: Mark[], lost: string[]}>}  lost: what was not kept, with the reason */
  async sendWaiting(now) {
    /** @type {{kept: Mark[], lost: string[]}} */ const result = { kept: [], lost: [] };
    if (this.#isSending || this.#waiting.length === 0 || now < this.#retryAt) return result;
    this.#isSending = true;
    this.#retryAt = now + RETRY_MILLIS;
    try {
      const server = await ask(`api/v1/marks?after=${Math.max(0, this.#revision)}`, readMarks);
      while (server !== null && this.#waiting.length > 0) {
        const { order, what, runMicros } = this.#waiting[0];
        try {
          if (server.run_micros !== runMicros) throw new Error('the server was started again and has no longer its moment');
          result.kept.push(await this.#send(order));
        } catch (error) {
          if (error instanceof NoConnection) break;
          result.lost.push(`“${what}”: ${messageOf(error)}`);
        }
        this.#waiting.shift();
        this.#keepWaiting();
      }
      if (server !== null) this.#retryAt = -Infinity;
    } finally {
      this.#isSending = false;
    }
    return result;
  }

  /** @param {Mark} mark
   *  @returns {Promise<Mark>} */
  remove(mark) {
    return this.#send({ id: mark.id, remove: true });
  }

  /** @param {object} order
   *  @param {string} what
   *  @returns {Promise<Mark|null>} */
  async #sendOrKeep(order, what) {
    try {
      if (this.#waiting.length === 0) return await this.#send(order);
    } catch (error) {
      if (!(error instanceof NoConnection)) throw error;
    }
    if (this.#waiting.length >= MOST_WAITING) throw new NoConnection();
    this.#waiting.push({ order, what, runMicros: this.#runMicros });
    this.#keepWaiting();
    return null;
  }

  /** @param {object} order
   *  @returns {Promise<Mark>} */
  async #send(order) {
    const answer = await request('api/v1/mark', { method: 'POST', headers: HEADERS, body: JSON.stringify(order) });
    const mark = readMark(await answer.json(), 'api/v1/mark');
    if (!this.#marks.has(mark.id)) this.#mine.push(mark.id);
    this.#put(mark);
    this.changed();
    return mark;
  }

  /** @param {Mark} mark */
  #put(mark) {
    this.#sorted = null;
    if (mark.is_removed) this.#marks.delete(mark.id);
    else this.#marks.set(mark.id, mark);
  }

  /** @param {number} runMicros */
  #forget(runMicros) {
    this.#sorted = null;
    this.#marks.clear();
    this.#mine = [];
    this.#revision = -1;
    this.#runMicros = runMicros;
  }
}
