// The picture rendered by the server, next to the view of the page. It equals the pictures in PNG, video and CI.
import { shortCameraLabel } from './format.js';
import { messageOf, request } from './server_api.js';

const SAVED_SIZE = { width: 1920, height: 1080 };

/** @typedef {{image: HTMLImageElement, note: HTMLElement, on: HTMLInputElement,
 *    camera: HTMLSelectElement, save: HTMLButtonElement}} Parts */

export class PicturePanel {
  hasPictures = true;
  #isNewest = true;  // whether the page shows the newest state, as the picture does
  #url = '';
  #isLoading = false;
  /** @type {Uint8Array<ArrayBuffer>|null} */ #next = null;  // JPEG

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
  }

  /** Requests pictures from the server, or stops them; call it also after a new connection. */
  ask() {
    const isOn = this.#isShown && this.hasPictures;
    this.send({ pictures: isOn, dark: this.#isDark });
    if (!isOn) this.parts.image.hidden = true;
    this.#permitSaving();
    this.#explain();
  }

  /** While the viewer looks back, there is no picture: it would be of another moment.
   *  @param {boolean} isNewest */
  setNewest(isNewest) {
    if (isNewest === this.#isNewest) return;
    this.#isNewest = isNewest;
    this.ask();
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
    this.parts.save.disabled = !this.hasPictures || !this.#isNewest || this.#lost !== '';
  }

  get #isShown() {
    return this.parts.on.checked && this.#isNewest && this.#isSeen;
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

  /** Shows a picture. While one is being decoded, only the latest of the following pictures is kept.
   *  @param {Uint8Array<ArrayBuffer>} jpeg */
  show(jpeg) {
    if (this.#isShown) this.#showJpeg(jpeg);
  }

  /** @param {Uint8Array<ArrayBuffer>} jpeg */
  #showJpeg(jpeg) {
    if (this.#isLoading) {
      this.#next = jpeg;
      return;
    }
    this.#isLoading = true;
    URL.revokeObjectURL(this.#url);
    this.#url = URL.createObjectURL(new Blob([jpeg], { type: 'image/jpeg' }));
    this.parts.image.src = this.#url;
  }

  #onShown() {
    this.#isLoading = false;
    this.parts.image.hidden = !this.#isShown;
    this.#came = new Date().toTimeString().slice(0, 8);
    this.#explain();
    const next = this.#next;
    this.#next = null;
    if (next && this.#isShown) this.#showJpeg(next);
  }

  #explain() {
    const { on, image, note } = this.parts;
    const isOld = this.#lost !== '' && !image.hidden;
    image.classList.toggle('old', isOld);
    note.classList.toggle('over-picture', isOld);
    if (isOld) note.textContent = `${this.#lost}. This picture is the last one, of ${this.#came}`;
    else if (!this.hasPictures) note.textContent = 'This server does not render pictures.';
    else if (!this.#isNewest) note.textContent = 'The server\u2019s picture shows the newest sample only.';
    else if (!on.checked) note.textContent = 'The picture is off.';
    else note.textContent = 'Waiting for a picture';
    note.hidden = !image.hidden && !isOld;
  }

  async #save() {
    const { save, camera } = this.parts;
    save.disabled = true;
    try {
      const query = new URLSearchParams({
        camera: camera.value, theme: this.#isDark ? 'dark' : 'light', width: String(SAVED_SIZE.width), height: String(SAVED_SIZE.height),
      });
      const answer = await request(`api/v1/snapshot.png?${query}`);
      const link = document.createElement('a');
      link.href = URL.createObjectURL(await answer.blob());
      link.download = `kinescope_${camera.value}_${new Date().toISOString().replace(/[:.]/g, '-')}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    } finally {
      this.#permitSaving();
    }
  }
}
