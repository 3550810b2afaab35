// Where marks are set and listed: nine buttons and their keys, free text, undo, and the list, in which a click shows
// the moment of a mark.
import { lag, place, timeCode } from './format.js';
import { symbolOf } from './marks.js';
import { messageOf } from './server_api.js';
import { placeIn } from './status.js';

const MOST_LISTED = 200;  // the newest ones
const MOST_BUTTONS = 9;
const SOON_MILLIS = 100;  // a mark may be so much later than the newest sample is said to be
const LATE_MILLIS = 1000;  // until a server that does not answer is named
const SAID_MILLIS = 6000;  // that Undo is offered

/** @typedef {import('./messages.js').Mark} Mark
 *  @typedef {{pad: HTMLElement, buttons: HTMLElement, form: HTMLFormElement, text: HTMLInputElement, said: HTMLElement,
 *    undo: HTMLButtonElement, list: HTMLElement, earlier: HTMLElement}} Parts  said: what has just been marked */

export class MarkPad {
  #saidUntil = -Infinity;
  #drawn = '';
  /** @type {readonly Mark[]} */ #listed = [];  // marks of the list that is drawn
  /** @type {{state: number, sample: number}|null} */ #meant = null;  // by the text that is being written

  /** @param {Parts} parts
   *  @param {import('./marks.js').Marks} marks
   *  @param {import('./shown.js').Shown} shown
   *  @param {{notice: (text: string) => void, isViewer: () => boolean, stateInView: () => number|null}} page  stateInView:
   *    number of the state in the picture that takes the place of the view; null: the view shows the state of the page
   *  @param {import('./keys.js').Keys} keys */
  constructor(parts, marks, shown, { notice, isViewer, stateInView }, keys) {
    this.parts = parts;
    this.marks = marks;
    this.shown = shown;
    this.notice = notice;
    this.isViewer = isViewer;
    this.stateInView = stateInView;
    parts.form.addEventListener('submit', (event) => {
      event.preventDefault();
      const text = parts.text.value.trim();
      if (text === '') return;
      this.#mark({ text, ...this.#meant && { state: this.#meant.state } }).then((isKept) => {
        if (!isKept) return;
        parts.text.value = '';
        this.#meant = null;
      });
      parts.text.blur();  // so that the keys work again
    });
    // A text takes seconds to write: it marks what was seen when it was begun.
    parts.text.addEventListener('input', () => {
      if (parts.text.value === '') this.#meant = null;
      else this.#mean();
    });
    parts.text.addEventListener('keydown', ({ key }) => {
      if (key !== 'Escape') return;
      parts.text.value = '';
      parts.text.blur();
    });
    parts.text.addEventListener('blur', () => { if (parts.text.value.trim() === '') this.#meant = null; });
    parts.undo.addEventListener('click', () => this.#undo());
    const digits = Array.from({ length: MOST_BUTTONS }, (_, i) => i + 1);
    for (const [prefix, isSpan] of /** @type {const} */ ([['', false], ['Shift+', true]])) {
      for (const digit of digits) keys.add('', `${prefix}${digit}`, '', () => this.#pressKey(digit, isSpan));
    }
    keys.add('Marks', ['1', '9'], 'Set a mark, by its button', null);
    keys.add('Marks', ['Shift+1', 'Shift+9'], 'Begin a span; again: end it', null);
    keys.add('Marks', 'M', 'Text of a mark, which marks the sample of now', () => {
      parts.text.focus();
      this.#mean();
    });
    keys.add('Marks', '[', 'The previous mark', () => this.#goToNeighbour(-1), { repeats: true });
    keys.add('Marks', ']', 'The next mark', () => this.#goToNeighbour(1), { repeats: true });
    keys.add('Marks', 'Ctrl+Z', 'Remove the last mark of this page', () => this.#undo());
  }

  /** @param {number} digit
   *  @param {boolean} isSpan */
  #pressKey(digit, isSpan) {
    if (digit <= this.marks.names.length) this.#press(digit, isSpan);
  }

  /** A press with Shift begins a span; the next press of the same button with Shift ends it.
   *  @param {number} button
   *  @param {boolean} isSpan */
  #press(button, isSpan) {
    const open = isSpan ? this.marks.openSpan(button) : null;
    return open ? this.#tell((state) => this.marks.end(open, state)) : this.#mark({ button, is_span: isSpan });
  }

  /** @param {{button?: number, text?: string, is_span?: boolean, state?: number}} what  state: not that on the screen */
  #mark(what) {
    return this.#tell((state) => this.marks.add({ state, ...what }));
  }

  /** @param {(state: number) => Promise<Mark|null>} send  gets the number of the state on the screen
   *  @returns {Promise<boolean>}  whether the mark is kept, or waits for the server */
  async #tell(send) {
    const { state } = this.shown;
    if (state === null || state.liveness === 'no data') {
      this.notice('Nothing to mark: no sample has come yet');
      return false;
    }
    const late = setTimeout(() => this.#say('The server has not answered yet'), LATE_MILLIS);
    try {
      const mark = await send(this.stateInView() ?? state.stateNumber);
      if (mark === null) this.#say(waitText(this.marks.waiting));
      else this.#say(`${doneText(mark)}${seenText(mark)}`);
      return true;
    } catch (error) {
      this.notice(`The mark was not set: ${messageOf(error)}`);
      return false;
    } finally {
      clearTimeout(late);
    }
  }

  /** The text that is being written is about what is on the screen now, unless it has been begun before. */
  #mean() {
    const { state } = this.shown;
    if (this.#meant !== null || state === null || state.liveness === 'no data') return;
    this.#meant = { state: this.stateInView() ?? state.stateNumber, sample: state.counter };
  }

  /** Those that were set while the server was away.
   *  @param {number} now  browser's clock, ms */
  async sendWaiting(now) {
    const { kept, lost } = await this.marks.sendWaiting(now);
    if (lost.length > 0) this.notice(`Not set while the server was away: ${lost.join('; ')}`);
    if (kept.length === 1) this.#say(`Set now: ${doneText(kept[0])}`);
    if (kept.length > 1) this.#say(`Set now: ${kept.length} marks that waited for the server`);
  }

  async #undo() {
    const mark = this.marks.lastOwn;
    if (mark === null) return this.notice('Nothing to undo: this page has set no mark that is still there');
    await this.#remove(mark);
  }

  /** @param {Mark} mark */
  async #remove(mark) {
    try {
      await this.marks.remove(mark);
      this.#say(`Removed: “${mark.text}” at sample ${mark.at.counter}`);
    } catch (error) {
      this.notice(`The mark was not removed: ${messageOf(error)}`);
    }
  }

  /** @param {string} text */
  #say(text) {
    this.parts.said.textContent = text;
    this.#saidUntil = performance.now() + SAID_MILLIS;
  }

  /** @param {1|-1} by  next or previous mark */
  #goToNeighbour(by) {
    const at = this.shown.millis;
    if (at === null) return;
    const others = this.marks.list().filter((mark) => this.marks.hasMoment(mark)
      && Math.sign(mark.at.micros - Math.floor(1000 * at)) === by);
    const next = by > 0 ? others[0] : others.at(-1);
    if (next) this.#goTo(next);
    else this.notice(by > 0 ? 'There is no later mark' : 'There is no earlier mark');
  }

  /** @param {Mark} mark */
  #goTo(mark) {
    const kept = this.shown.kept();
    if (kept === null) return;
    if (!this.marks.hasMoment(mark)) return this.notice('This mark is of an earlier start of the server, whose samples are gone');
    if (mark.at.micros / 1000 > kept.newest + SOON_MILLIS) return this.notice('The recording has not come to this mark yet');
    if (mark.at.micros / 1000 < kept.oldest) return this.notice('The moment of this mark is no longer kept');
    this.shown.pauseAt((mark.at.micros + 1) / 1000, this.marks.isOfEarlierRun(mark) ? mark.at.stamp_micros : null);  // µs were rounded down
  }

  /** Shows what there is; call it several times a second.
   *  @param {number} now */
  update(now) {
    const { parts, marks, shown } = this;
    parts.undo.disabled = marks.lastOwn === null;
    if (marks.waiting > 0) this.#say(waitText(marks.waiting));
    if (this.#meant !== null) this.#say(`This text marks sample ${this.#meant.sample}`);
    if (now > this.#saidUntil && parts.said.textContent !== '') parts.said.textContent = '';
    const list = marks.list(), { recording } = shown.newestDetails;
    const drawn = JSON.stringify([marks.names, recording?.start_micros, this.isViewer()]);
    if (drawn === this.#drawn && list === this.#listed) return;
    this.#drawn = drawn;
    this.#listed = list;
    this.#showButtons();
    parts.earlier.hidden = list.length <= MOST_LISTED;
    parts.earlier.textContent = `${list.length - MOST_LISTED} earlier marks are in the file`;
    parts.list.replaceChildren(...list.slice(-MOST_LISTED).reverse().map((mark) => this.#entry(mark)));
  }

  #showButtons() {
    const { buttons } = this.parts, { names } = this.marks;
    if (buttons.childElementCount !== names.length) {
      buttons.replaceChildren(...names.map((name, i) => {
        const button = document.createElement('button'), key = document.createElement('kbd'), label = document.createElement('span');
        button.type = 'button';
        key.textContent = String(i + 1);
        label.textContent = name;
        button.append(key, label);
        button.title = `Mark “${name}” (${i + 1}); a span: Shift+${i + 1}, and again at its end`;
        button.addEventListener('click', (event) => this.#press(i + 1, event.shiftKey));
        return button;
      }));
    }
    [...buttons.children].forEach((button, i) => {
      button.classList.toggle('open', this.marks.openSpan(i + 1) !== null);
    });
  }

  /** @param {Mark} mark */
  #entry(mark) {
    const item = document.createElement('li'), go = document.createElement('button'), remove = document.createElement('button');
    const key = document.createElement('kbd'), name = document.createElement('span'), when = document.createElement('small');
    key.textContent = symbolOf(mark);
    item.dataset.kind = mark.kind;
    name.textContent = mark.text;
    when.textContent = this.#whenText(mark);
    go.type = remove.type = 'button';
    go.append(key, name, when);
    go.className = 'go';
    go.title = 'Show this moment';
    go.addEventListener('click', () => this.#goTo(mark));
    remove.textContent = '×';
    remove.ariaLabel = `Remove the mark “${mark.text}”`;
    remove.title = 'Remove';
    remove.addEventListener('click', () => this.#remove(mark));
    const gate = document.createElement('fieldset');
    gate.className = 'gate';
    gate.disabled = this.isViewer();
    gate.append(remove);
    gate.hidden = mark.kind !== 'mark';  // a change or a trial is not undone by forgetting it
    item.append(go, gate);
    return item;
  }

  /** @param {Mark} mark */
  #whenText(mark) {
    const { recording } = this.shown.newestDetails;
    const at = recording && this.marks.hasMoment(mark) ? place(placeIn(recording, mark.at.stamp_micros))
      : timeCode(mark.at.time_code_millis);
    const length = mark.end ? ` · ${((mark.end.micros - mark.at.micros) / 1e6).toFixed(1)} s` : mark.is_open ? ' · open' : '';
    return `${at} · sample ${mark.at.counter}${length} · ${mark.role}${seenText(mark)}`;
  }
}

/** @param {number} count */
const waitText = (count) => (count === 1 ? '1 mark waits for the server' : `${count} marks wait for the server`);

/** @param {Mark} mark  that the server has kept */
const doneText = (mark) => `${mark.is_open ? 'Span begins' : mark.end ? 'Span' : 'Marked'}: “${mark.text}” at sample ${mark.at.counter}`
  + `${mark.end ? ` to ${mark.end.counter}` : ''}`;

/** @param {Mark} mark
 *  @returns {string} how far its author looked back; "" for less than that a person notices */
const seenText = ({ behind_secs: behind }) => (behind < 0.5 ? '' : `, seen ${lag(1000 * behind)}`);
