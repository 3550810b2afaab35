// The panel "Stream": one line always, and a table when it is opened.
import { clockStepsText, LossAlarm, streamLine, streamRows } from './stream_health.js';

/** @typedef {import('./messages.js').StreamHealth} StreamHealth
 *  @typedef {{details: HTMLDetailsElement, line: HTMLElement, rows: HTMLTableSectionElement}} Parts */

const TABLE_MILLIS = 500;  // as often as the server tells it

export class StreamPanel {
  #alarm = new LossAlarm();
  /** @type {StreamHealth|null} */ #stream = null;
  #shownAt = -Infinity;
  #frame = '';

  /** @param {Parts} parts */
  constructor(parts) {
    this.parts = parts;
    parts.details.addEventListener('toggle', () => { this.#shownAt = -Infinity; });
  }

  /** Whether the server has told how the stream is. */
  get isKnown() {
    return this.#stream !== null;
  }

  /** For the banner: the time of day was another one a moment ago; ''. */
  get clockStepsText() {
    return clockStepsText(this.#stream?.clock_steps);
  }

  /** @param {StreamHealth} stream */
  set(stream) {
    this.#stream = stream;
  }

  /** @param {string} frame  of ROS, in which the scene stands; '': without ROS */
  setFrame(frame) {
    this.#frame = frame;
  }

  /** For the lamp: the share lost or incomplete in the last 10 s, and whether that is a state of its own.
   *  @param {number} now  ms
   *  @returns {{loss: number|null, isLosing: boolean}} */
  lossAt(now) {
    const loss = this.#stream?.loss_10s ?? null;
    return { loss, isLosing: this.#alarm.update(loss, now) };
  }

  /** @param {number} now  ms
   *  @param {number|null} ageMillis  of the newest sample
   *  @param {number|null} serverNow  ms */
  show(now, ageMillis, serverNow) {
    if (this.#stream === null || now - this.#shownAt < TABLE_MILLIS) return;
    this.#shownAt = now;
    const line = streamLine(this.#stream);
    if (this.parts.line.textContent !== line) this.parts.line.textContent = line;
    if (this.parts.details.open) this.#fill(streamRows(this.#stream, ageMillis, serverNow, this.#frame));
  }

  /** Rows stay where they are, so that a text can be selected.
   *  @param {import('./stream_health.js').Row[]} rows */
  #fill(rows) {
    const body = this.parts.rows;
    while (body.rows.length > rows.length) body.deleteRow(-1);
    while (body.rows.length < rows.length) addRow(body);
    rows.forEach(({ name, recent, all, last, isRecent }, i) => {
      const row = body.rows[i];
      row.classList.toggle('recent', isRecent);
      [name, recent, all, last].forEach((text, column) => {
        const cell = row.cells[column];
        if (cell.textContent !== text) cell.textContent = text;  // text and not markup
      });
      row.cells[0].title = name;
    });
  }
}

/** @param {HTMLTableSectionElement} body */
function addRow(body) {
  const row = body.insertRow();
  const name = document.createElement('th');
  name.scope = 'row';
  row.append(name);
  for (let column = 1; column < 4; ++column) row.insertCell();
}
