// Recording, clips, the jobs that make them, and the files.
import { jobText, recordingText, size } from './control_texts.js';
import { place } from './format.js';

const MOST_LISTED = 60;  // the newest ones

/** @typedef {import('./control_messages.js').ControlState} ControlState
 *  @typedef {import('./control_messages.js').Job} Job
 *  @typedef {{form: HTMLFormElement, label: HTMLInputElement, run: HTMLButtonElement, note: HTMLElement}} RecordingParts
 *  @typedef {{form: HTMLFormElement, secs: HTMLInputElement, last: HTMLButtonElement, next: HTMLButtonElement,
 *    begin: HTMLButtonElement, end: HTMLButtonElement, note: HTMLElement, jobs: HTMLElement}} ClipParts
 *  @typedef {ReturnType<typeof import('./control_orders.js').makeOrders>} SendOrder */

/** @param {RecordingParts} parts
 *  @param {SendOrder} order
 *  @returns {(state: ControlState) => void} */
export function mountRecording({ form, label, run, note }, order) {
  let isOn = false;
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    run.disabled = true;
    const text = label.value.trim();
    await order('api/v1/recording', isOn || text === '' ? { run: !isOn } : { run: true, label: text },
      isOn ? 'stop the recording' : 'start the recording');
    run.disabled = false;
  });
  return ({ recording, trial }) => {
    isOn = recording.state === 'on';
    run.textContent = isOn ? 'Stop' : 'Record';
    run.dataset.act = isOn ? 'stop' : 'start';
    form.hidden = trial !== null;  // a trial is recorded as long as it runs
    const text = recordingText(recording);
    if (note.textContent !== text) note.textContent = text;
    note.classList.toggle('warn', recording.problem !== '' || recording.dropped > 0);
  };
}

/** @param {ClipParts} parts
 *  @param {SendOrder} order
 *  @param {import('./shown.js').Shown} shown
 *  @returns {(state: ControlState) => void} */
export function mountClips(parts, order, shown) {
  /** @type {number|null} */
  let beginMicros = null;
  const make = (/** @type {object} */ what) => order('api/v1/clip', what, 'make the clip');
  const micros = () => (shown.millis === null ? null : Math.floor(1000 * shown.millis));
  const say = (/** @type {string} */ text) => { parts.note.textContent = text; };
  parts.form.addEventListener('submit', (event) => {
    event.preventDefault();
    make({ last_secs: parts.secs.valueAsNumber });
  });
  parts.next.addEventListener('click', () => {
    if (parts.form.reportValidity()) make({ next_secs: parts.secs.valueAsNumber });
  });
  parts.begin.addEventListener('click', () => {
    beginMicros = micros();
    parts.end.disabled = beginMicros === null;
    if (shown.state) say(`Begins at sample ${shown.state.counter}; go to its end, and press “To here”`);
  });
  parts.end.addEventListener('click', async () => {
    const end = micros();
    if (beginMicros === null || end === null) return;
    const [from, to] = [Math.min(beginMicros, end), Math.max(beginMicros, end)];
    if (await make({ from_micros: from, to_micros: to }) === null) return;
    say(`Clip of ${place((to - from) / 1e6)}`);
    beginMicros = null;
    parts.end.disabled = true;
  });
  let drawn = '';
  return ({ clips, jobs }) => {
    if (clips.why_not !== '') say(clips.why_not);
    const now = JSON.stringify(jobs);
    if (now === drawn) return;
    drawn = now;
    parts.jobs.replaceChildren(...[...jobs].reverse().map((job) => jobEntry(job, order)));
  };
}

/** @param {Job} job
 *  @param {SendOrder} order */
function jobEntry(job, order) {
  const item = document.createElement('li'), name = document.createElement('span'), text = document.createElement('small');
  item.dataset.state = job.state;
  name.textContent = job.file;
  text.textContent = jobText(job);
  item.append(name, text);
  if (job.state !== 'waiting' && job.state !== 'making') return item;
  const cancel = document.createElement('button');
  cancel.type = 'button';
  cancel.textContent = 'Cancel';
  cancel.ariaLabel = `Cancel ${job.file}`;
  cancel.addEventListener('click', () => order('api/v1/clip', { cancel: job.id }, 'cancel'));
  const bar = document.createElement('progress');
  bar.ariaLabel = `Progress of ${job.file}`;
  if (job.kind === 'clip') bar.value = job.progress;
  item.append(bar, cancel);
  return item;
}

/** @param {HTMLElement} list
 *  @param {(name: string, text: string) => Node} link
 *  @param {import('./control_messages.js').Files} files */
export function showFiles(list, link, { files }) {
  list.replaceChildren(...files.slice(0, MOST_LISTED).map((file) => {
    const item = document.createElement('li'), bytes = document.createElement('small');
    bytes.textContent = size(file.bytes);
    item.append(link(file.name, file.name), bytes);
    return item;
  }));
}
