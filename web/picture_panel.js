// The picture rendered by the server, next to the view of the page. It equals the pictures in PNG, video and CI. Live, it is
// the one that all viewers share; who looks back gets pictures of their own moment.
import { shortCameraLabel } from './format.js';
import { addressOf, FormerPictures } from './former_pictures.js';
import { messageOf, request } from './server_api.js';

const SAVED_SIZE = { width: 1920, height: 1080 };
const FORMER_SIZE = { width: 1280, height: 720 };
const PATIENCE = 15_000;  // ms, for a picture
const PLAYED_SIZE = { width: 640, height: 360 };  // many a second

/** @typedef {{state: number, isPlaying: boolean}} Former  a moment of the past: the number of its state; whether it plays
 *  @typedef {{picture: Blob, state: number|null, isFormer: boolean}} Shown */

/** @typedef {{image: HTMLImageElement, note: HTMLElement, on: HTMLInputElement,
 *    camera: HTMLSelectElement, save: HTMLButtonElement}} Parts */

export class PicturePanel {
  hasPictures = true;
  /** @type {Former|null} */ #former = null;  // what the page shows; null: the newest state
  #url = '';
  /** @type {Shown|null} */ #loading = null;
  /** @type {Shown|null} */ #next = null;
  /** @type {number|null} */ #state = null;  // of the picture that can be seen
  #why = '';          // there is no picture of the former moment

  #isDark = false;    // the page
  #isSeen = false;    // the panel, or the stage that has its place
  #lost = '';         // what became of the server; '': nothing
  #came = '';         // when the picture on the screen came

  /** @param {Parts} parts
   *  @param {(command: object) => void} send
   *  @param {(reason: string) => void} report */
  constructor(parts, send, report) {
    this.parts = parts;
    this.send = send;
    parts.on.addEventListener('change', () => this.ask());
    parts.camera.addEventListener('change', () => send({ camera: parts.camera.value }));
    parts.save.addEventListener('click', () => this.#save()
      .catch((/** @type {unknown} */ error) => report(`Could not save the picture: ${messageOf(error)}`)));
    parts.image.addEventListener('load', () => this.#onShown());
    parts.image.addEventListener('error', () => this.#onShown());
    this.formers = new FormerPictures(async (address) => (await request(address, { signal: AbortSignal.timeout(PATIENCE) })).blob(),
      (drawn, state) => this.#show({ picture: drawn, state, isFormer: true }), (error) => this.#onFailed(messageOf(error)));
  }

  /** Requests pictures from the server, or stops them; call it also after a new connection. */
  ask() {
    const isOn = this.#isShown && this.hasPictures;
    this.send({ pictures: isOn && this.#former === null, dark: this.#isDark });
    if (!isOn) this.#hide();
    this.#permitSaving();
    this.#explain();
  }

  /** A live picture is none of a former moment, and the other way round. Call it several times a second.
   *  @param {Former|null} former  what the page shows; null: the newest state
   *  @param {number} now  browser's clock, ms */
  setMoment(former, now) {
    const isOther = (former === null) !== (this.#former === null);
    this.#former = former;
    if (isOther) {
      this.#hide();
      this.ask();
    }
    const isWanted = former !== null && this.#isShown && this.hasPictures && this.#lost === '';
    this.formers.want(isWanted ? this.#wanted(former, former.isPlaying ? PLAYED_SIZE : FORMER_SIZE) : null, now);
  }

  /** The number of the state in the picture that can be seen; null: there is none.
   *  @returns {number|null} */
  get state() {
    return this.parts.image.hidden ? null : this.#state;
  }

  /** @param {Former} former
   *  @param {{width: number, height: number}} size */
  #wanted(former, size) {
    return { state: former.state, camera: this.parts.camera.value, isDark: this.#isDark, ...size };
  }

  /** Whether nothing but the picture of this state is to come.
   *  @param {number|undefined} state */
  isAt(state) {
    return !this.#isShown || !this.hasPictures || this.state === state;
  }

  /** The last picture stays, and says so. @param {string} why  there is no picture of the former moment */
  #onFailed(why) {
    this.#why = why;
    this.#explain();
  }

  /** Of another server: its picture has no moment here. */
  forget() {
    this.#hide();
    this.#state = null;
    this.#explain();
  }

  #hide() {
    this.parts.image.hidden = true;
    this.#next = null;
    this.#why = '';
  }

  /** Pictures cost the server time to draw: they are asked for only while they are seen.
   *  @param {boolean} isSeen */
  setSeen(isSeen) {
    if (isSeen === this.#isSeen) return;
    this.#isSeen = isSeen;
    this.ask();
  }

  /** The server's picture is as dark as the page; the live one only while all who watch it have a dark page.
   *  @param {boolean} isDark */
  setDark(isDark) {
    if (isDark === this.#isDark) return;
    this.#isDark = isDark;
    this.send({ dark: isDark });
  }

  /** The last picture stays when the server is gone, and says so.
   *  @param {string} lost  what became of the server; '': nothing */
  setLost(lost) {
    if (lost === this.#lost) return;
    this.#lost = lost;
    this.#permitSaving();
    this.#explain();
  }

  #permitSaving() {
    this.parts.save.disabled = !this.hasPictures || this.#lost !== '';
  }

  get #isShown() {
    return this.parts.on.checked && this.#isSeen;
  }

  /** @param {{name: string}[]} cameras */
  setCameras(cameras) {
    this.parts.camera.replaceChildren(
      ...cameras.map(({ name }) => new Option(shortCameraLabel(name), name)));
    this.parts.camera.disabled = cameras.length === 0;
  }

  /** @param {{has_pictures: boolean, camera: string}} details */
  setDetails(details) {
    if (details.has_pictures !== this.hasPictures) {
      this.hasPictures = details.has_pictures;
      this.ask();
    }
    this.parts.on.disabled = !this.hasPictures;
    this.#permitSaving();
    // All viewers share the live picture: another viewer may have selected its camera.
    if (document.activeElement !== this.parts.camera) this.parts.camera.value = details.camera;
    this.#explain();
  }

  /** Shows a live picture.
   *  @param {{jpeg: Uint8Array<ArrayBuffer>, stateNumber: number}} live */
  show({ jpeg, stateNumber }) {
    if (this.#former === null) this.#show({ picture: new Blob([jpeg], { type: 'image/jpeg' }), state: stateNumber, isFormer: false });
  }

  /** @param {Shown} shown */
  #isWanted({ isFormer }) {
    return this.#isShown && isFormer === (this.#former !== null);
  }

  /** While one is being decoded, only the latest of the following pictures is kept.
   *  @param {Shown} shown */
  #show(shown) {
    if (!this.#isWanted(shown)) return;
    if (this.#loading !== null) {
      this.#next = shown;
      return;
    }
    this.#loading = shown;
    this.#why = '';
    URL.revokeObjectURL(this.#url);
    this.#url = URL.createObjectURL(shown.picture);
    this.parts.image.src = this.#url;
  }

  #onShown() {
    const shown = this.#loading;
    this.#loading = null;
    this.#state = shown?.state ?? null;
    this.parts.image.hidden = shown === null || !this.#isWanted(shown);
    this.#came = new Date().toTimeString().slice(0, 8);
    this.#explain();
    const next = this.#next;
    this.#next = null;
    if (next) this.#show(next);
  }

  #explain() {
    const { on, image, note } = this.parts;
    const isOther = this.#why !== '' && this.#former !== null && this.#state !== this.#former.state;
    const isOld = !image.hidden && (this.#lost !== '' || isOther);
    image.classList.toggle('old', isOld);
    note.classList.toggle('over-picture', isOld);
    if (isOld && this.#lost === '') note.textContent = `This picture is of another moment: ${this.#why}`;
    else if (isOld) note.textContent = `${this.#lost}. This picture is the last one, of ${this.#came}`;
    else if (!this.hasPictures) note.textContent = 'This server does not render pictures.';
    else if (!on.checked) note.textContent = 'The picture is off.';
    else if (this.#why !== '') note.textContent = `No picture of this moment: ${this.#why}`;
    else note.textContent = 'Waiting for a picture';
    note.hidden = !image.hidden && !isOld;
  }

  async #save() {
    const { save, camera } = this.parts;
    save.disabled = true;
    try {
      const state = this.#former?.state ?? null;
      const answer = await request(addressOf({ state, camera: camera.value, isDark: this.#isDark, ...SAVED_SIZE }));
      const link = document.createElement('a');
      link.href = URL.createObjectURL(await answer.blob());
      const moment = state === null ? '' : `_state_${state}`;
      link.download = `kinescope_${camera.value}${moment}_${new Date().toISOString().replace(/[:.]/g, '-')}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    } finally {
      this.#permitSaving();
    }
  }
}
