// The trials of a study: person, condition and number, Start and Stop, and the list, with clip and report by a click.
import { readMade } from './control_messages.js';
import { nextNumber, trialTitle } from './control_texts.js';
import { place } from './format.js';

const MOST_LISTED = 100;  // the newest ones

/** @typedef {import('./control_messages.js').ControlState} ControlState
 *  @typedef {import('./control_messages.js').Files} Files
 *  @typedef {import('./control_messages.js').Trial} Trial
 *  @typedef {{form: HTMLFormElement, person: HTMLInputElement, condition: HTMLInputElement, number: HTMLInputElement,
 *    run: HTMLButtonElement, note: HTMLElement, list: HTMLElement}} Parts
 *  @typedef {ReturnType<typeof import('./control_orders.js').makeOrders>} SendOrder */

export class ControlTrials {
  /** @type {Trial|null} */
  #running = null;
  /** @type {Trial[]} */
  #trials = [];
  #runMicros = 0;  // of the server's start: the moments of its trials may still be kept
  #isNumberTyped = false;
  #drawn = '';

  /** @param {Parts} parts
   *  @param {SendOrder} order
   *  @param {(name: string, text: string) => Node} link  to a file
   *  @param {(text: string) => void} notice */
  constructor(parts, order, link, notice) {
    this.notice = notice;
    this.parts = parts;
    this.order = order;
    this.link = link;
    parts.form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#run();
    });
    for (const field of [parts.person, parts.condition]) {
      field.addEventListener('input', () => {
        this.#isNumberTyped = false;
        this.#suggestNumber();
      });
    }
    parts.number.addEventListener('input', () => { this.#isNumberTyped = true; });
  }

  async #run() {
    const { person, condition, number, run } = this.parts;
    run.disabled = true;
    try {
      if (this.#running) await this.order('api/v1/trial', { stop: true }, 'stop the trial');
      else {
        await this.order('api/v1/trial', {
          start: true, person: person.value, condition: condition.value, number: number.valueAsNumber,
        }, 'start the trial');
      }
      this.#isNumberTyped = false;
    } finally {
      run.disabled = false;
    }
  }

  #suggestNumber() {
    const { person, condition, number } = this.parts;
    if (this.#running || this.#isNumberTyped || document.activeElement === number) return;
    number.value = String(nextNumber(this.#trials, person.value.trim(), condition.value.trim()));
  }

  /** @param {ControlState} state
   *  @param {Files|null} files */
  show(state, files) {
    const { parts } = this;
    this.#running = state.trial;
    if (files) {
      this.#trials = files.trials;
      this.#runMicros = files.run_micros;
    }
    parts.run.textContent = state.trial ? 'Stop' : 'Start';
    parts.run.dataset.act = state.trial ? 'stop' : 'start';
    for (const field of [parts.person, parts.condition, parts.number]) field.disabled = state.trial !== null;
    if (state.trial) {
      parts.person.value = state.trial.person;
      parts.condition.value = state.trial.condition;
      parts.number.value = String(state.trial.number);
    }
    this.#suggestNumber();
    const note = noteOf(state);
    if (parts.note.textContent !== note) parts.note.textContent = note;
    const names = (files?.files ?? []).map(({ name }) => name);
    const making = state.jobs.filter(({ state: is }) => is === 'waiting' || is === 'making');
    const drawn = JSON.stringify([state.trial?.trial, this.#trials, names, making]);
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    const ended = this.#trials.filter(({ trial }) => trial !== state.trial?.trial);
    parts.list.replaceChildren(...ended.slice(-MOST_LISTED).reverse().map((trial) => this.#entry(trial, names, state)));
  }

  /** @param {Trial} trial
   *  @param {boolean} clip  whether there may be one */
  async #make({ trial, has_recording: report }, clip) {
    const answer = await this.order('api/v1/trial', { trial, ...clip && { clip }, ...report && { report } }, 'make clip and report');
    if (answer === null) return false;
    const { refused } = readMade(answer, 'api/v1/trial');
    if (refused.length > 0) this.notice(`Not all was made: ${refused.join('; ')}`);
    return true;
  }

  /** @param {Trial} trial
   *  @param {string[]} names  of files
   *  @param {ControlState} state */
  #entry(trial, names, state) {
    const item = document.createElement('li'), title = document.createElement('span'), files = document.createElement('span');
    const make = document.createElement('button');
    item.dataset.trial = trial.trial;
    title.textContent = trialTitle(trial);
    const problem = document.createElement('small');
    problem.textContent = [trial.to_micros === null ? 'the server ended before it was stopped' : place(trial.secs), trial.recording_problem]
      .filter(Boolean).join(' · ');
    files.className = 'trial-files';
    for (const [ending, text] of [['mp4', 'clip'], ['html', 'report'], ['pcapng', 'recording']]) {
      const name = `${trial.trial}.${ending}`;
      if (names.includes(name)) files.append(this.link(name, text), ' ');
    }
    const isMaking = state.jobs.some(({ file, state: is }) => (is === 'waiting' || is === 'making')
      && (file === `${trial.trial}.mp4` || file === `${trial.trial}.html`));
    make.type = 'button';
    make.textContent = isMaking ? 'Making …' : 'Clip and report';
    const isOfThisRun = trial.run_micros === this.#runMicros, isEnded = trial.to_micros !== null;
    // Of the states that are kept, or of the recording.
    const clip = state.clips.why_not === '' && ((isEnded && isOfThisRun) || trial.has_recording);
    // One of this run that has no end yet has just been stopped: its end comes with the next list.
    make.disabled = isMaking || (isOfThisRun && !isEnded) || (!clip && !trial.has_recording);
    make.addEventListener('click', () => {
      make.disabled = true;
      this.#make(trial, clip).then((isOrdered) => { make.disabled = isOrdered; });
    });
    item.append(title, make, problem, files);
    return item;
  }
}

/** @param {ControlState} state */
function noteOf({ trial, trials, recording }) {
  if (trials.why_not !== '') return trials.why_not;
  if (trial === null) {
    return recording.why_not === '' ? 'Start also records the stream.' : `Trials are not recorded: ${recording.why_not}`;
  }
  return `Runs: ${trialTitle(trial)}${recording.state === 'on' ? `, recorded for ${place(recording.secs, 0)}` : ''}`;
}
