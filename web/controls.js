// The panel of controls: trials, recording, clips, files, person, hand loads, class limits.
import { ControlTrials } from './control_trials.js';
import { mountClips, mountRecording, showFiles } from './control_files.js';
import { readControls, readFiles } from './control_messages.js';
import { makeOrders } from './control_orders.js';
import { mountLimits, mountPerson } from './control_people.js';
import { ask, messageOf } from './server_api.js';

/** @typedef {import('./elements.js').Elements} Elements
 *  @typedef {import('./control_messages.js').Files} Files */

export class Controls {
  /** @type {Files|null} */
  #files = null;
  #isLoading = false;
  #isViewer = false;
  /** @type {import('./control_messages.js').ControlState|null} */
  #state = null;

  /** @param {Elements} elements
   *  @param {import('./shown.js').Shown} shown
   *  @param {(text: string) => void} notice */
  constructor(elements, shown, notice) {
    this.elements = elements;
    this.notice = notice;
    const order = makeOrders(notice);
    const link = (/** @type {string} */ name, /** @type {string} */ text) => this.#link(name, text);
    this.link = link;
    this.trials = new ControlTrials({
      form: elements['trial-form'], person: elements['trial-person'], condition: elements['trial-condition'],
      number: elements['trial-number'], run: elements['trial-run'], note: elements['trial-note'], list: elements['trial-list'],
    }, order, link, notice);
    this.parts = [
      mountRecording({
        form: elements['recording-form'], label: elements['recording-label'], run: elements['recording-run'],
        note: elements['recording-note'],
      }, order),
      mountClips({
        form: elements['clip-form'], secs: elements['clip-secs'], last: elements['clip-last'], next: elements['clip-next'],
        begin: elements['clip-begin'], end: elements['clip-end'], note: elements['clip-note'], jobs: elements['job-list'],
      }, order, shown),
      mountPerson({
        select: elements['control-person'], form: elements['person-form'], name: elements['person-name'],
        mass: elements['person-mass'], sex: elements['person-sex'], height: elements['person-height'],
        note: elements['person-note'], handsForm: elements['hands-form'], right: elements['hands-right'],
        left: elements['hands-left'], both: elements['hands-both'], handsNote: elements['hands-note'],
      }, order),
      mountLimits({
        form: elements['limits-form'], medium: elements['limits-medium'], high: elements['limits-high'],
        note: elements['limits-note'],
      }, order),
    ];
  }

  /** @param {boolean} isViewer  who may not download */
  setViewer(isViewer) {
    this.#isViewer = isViewer;
  }

  /** After a connection: perhaps another server. */
  forget() {
    this.#files = null;
  }

  /** @param {unknown} message  "controls" of the WebSocket */
  onMessage(message) {
    this.#state = readControls(message, 'controls');
    this.#show();
    this.#load();
  }

  /** Whether what the server has told is shown, the list of files included. */
  get isComplete() {
    return this.#state !== null && !this.#isLoading && this.#files?.revision === this.#state.files_revision;
  }

  /** After another person was chosen. */
  refresh() {
    this.#show();
  }

  #show() {
    const state = this.#state;
    if (state === null) return;
    this.elements['tab-controls'].dataset.recording = String(state.recording.state === 'on');
    for (const show of this.parts) show(state);
    this.trials.show(state, this.#files);
  }

  async #load() {
    if (this.#isLoading || this.#files?.revision === this.#state?.files_revision) return;
    this.#isLoading = true;
    try {
      const files = await ask('api/v1/files', readFiles);
      if (files === null) return;
      this.#files = files;
      showFiles(this.elements['file-list'], this.link, files);
      this.#show();
    } catch (error) {
      this.notice(`Could not load the list of files: ${messageOf(error)}`);
    } finally {
      this.#isLoading = false;
    }
  }

  /** @param {string} name
   *  @param {string} text */
  #link(name, text) {
    if (this.#isViewer) return document.createTextNode(text);
    const link = document.createElement('a');
    link.href = `api/v1/file/${encodeURIComponent(name)}`;
    link.download = name;
    link.textContent = text;
    link.title = `Download ${name}`;
    return link;
  }
}
