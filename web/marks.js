// The marks of the server: what they are, and how they are set, ended and removed.
import { ask, request } from './server_api.js';
import { readMark, readMarks } from './messages.js';

/** @typedef {import('./messages.js').Mark} Mark
 *  @typedef {{state: number, button?: number, text?: string, is_span?: boolean}} NewMark  state: number of the one on the
 *    screen; button: from 1 */

const RETRY_MILLIS = 3000;
const HEADERS = { 'Content-Type': 'application/json' };

/** Of a mark in lists and on the strip: the key of its button, ¶ free text, ✎ a change, ▶ a trial.
 *  @param {Mark} mark */
export const symbolOf = ({ button, kind }) => (button > 0 ? String(button) : { mark: '¶', change: '✎', trial: '▶' }[kind]);

export class Marks {
  /** @type {Map<number, Mark>} */ #marks = new Map();  // by id; without those that were removed
  #revision = -1;  // of what is here; -1: nothing was loaded yet
  #runMicros = 0;  // of the server whose marks are here
  #isLoading = false;
  #retryAt = -Infinity;  // ms; after an error
  /** @type {string[]} */ names = [];  // of the buttons
  /** @type {number[]} */ #mine = [];  // ids of those that this page has set, which it may undo

  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
  }

  /** In the order of their moments; those of earlier runs of the server first.
   *  @returns {Mark[]} */
  list() {
    return [...this.#marks.values()].sort((a, b) => a.run_micros - b.run_micros || a.at.micros - b.at.micros || a.id - b.id);
  }

  /** Whether the server may still have the moment of the mark: it was set since the server was started.
   *  @param {Mark} mark */
  isOfThisRun(mark) {
    return mark.run_micros === this.#runMicros;
  }

  /** The last one that this page has set and that is still there. */
  get lastOwn() {
    const id = this.#mine.filter((each) => this.#marks.has(each)).at(-1);
    return id === undefined ? null : this.#marks.get(id) ?? null;
  }

  /** The span of this button that has no end yet.
   *  @param {number} button */
  openSpan(button) {
    return this.list().filter((mark) => mark.is_open && mark.button === button && this.isOfThisRun(mark)).at(-1) ?? null;
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
   *  @returns {Promise<Mark>}
   *  @throws {Error} with the reason if the server did not keep it */
  async add(mark) {
    const kept = await this.#send(mark);
    this.#mine.push(kept.id);
    return kept;
  }

  /** @param {Mark} mark  a span
   *  @param {number} state
   *  @returns {Promise<Mark>} */
  end(mark, state) {
    return this.#send({ id: mark.id, state });
  }

  /** @param {Mark} mark
   *  @returns {Promise<Mark>} */
  remove(mark) {
    return this.#send({ id: mark.id, remove: true });
  }

  /** @param {object} order
   *  @returns {Promise<Mark>} */
  async #send(order) {
    const answer = await request('api/v1/mark', { method: 'POST', headers: HEADERS, body: JSON.stringify(order) });
    const mark = readMark(await answer.json(), 'api/v1/mark');
    this.#put(mark);
    this.changed();
    return mark;
  }

  /** @param {Mark} mark */
  #put(mark) {
    if (mark.is_removed) this.#marks.delete(mark.id);
    else this.#marks.set(mark.id, mark);
  }

  /** @param {number} runMicros */
  #forget(runMicros) {
    this.#marks.clear();
    this.#mine = [];
    this.#revision = -1;
    this.#runMicros = runMicros;
  }
}
