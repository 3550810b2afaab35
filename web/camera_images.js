// Pictures of cameras of other nodes, over a corner of the 3-D view. Each is asked for again when the last one is shown, a
// few times a second; one that has not changed is not sent again.
import { request } from './server_api.js';

const PAUSE_MILLIS = 200;

/** @typedef {import('./messages.js').CameraImage} CameraImage
 *  @typedef {import('./image_views.js').ImageView} ImageView */

/** Whether it is a picture.
 *  @param {string} url */
function isDecoded(url) {
  const image = new Image();
  image.src = url;
  return image.decode().then(() => true, () => false);
}

export class CameraImages {
  /** @type {Map<string, {figure: HTMLElement, image: HTMLImageElement, canvas: HTMLCanvasElement, note: HTMLElement,
   *    enlarge: HTMLButtonElement, number: number, url: string, tag: string, isAsking: boolean, dueAt: number}>} */
  #shown = new Map();
  #host;

  /** @param {HTMLElement} host */
  constructor(host) {
    this.#host = host;
  }

  /** Call it several times a second.
   *  @param {CameraImage[]} images  of the moment that is shown; former moments have none
   *  @param {number} now  browser's clock, ms
   *  @returns {ImageView[]} those over which the scene is drawn */
  update(images, now) {
    const names = new Set(images.map(({ name }) => name));
    for (const [name, { figure, url }] of this.#shown) {
      if (names.has(name)) continue;
      if (figure.dataset.large === 'true') this.#setLarge(null);
      figure.remove();
      URL.revokeObjectURL(url);
      this.#shown.delete(name);
    }
    const views = /** @type {ImageView[]} */ ([]);
    images.forEach(({ name, is_old: isOld, camera }, number) => {
      const one = this.#shown.get(name) ?? this.#add(name);
      one.number = number;
      one.figure.dataset.old = String(isOld);
      one.note.textContent = isOld ? `No new picture: ${name}` : name;
      one.canvas.hidden = camera === null || one.url === '';
      if (camera !== null && one.url !== '') {
        one.canvas.style.opacity = String(camera.scene_opacity);
        views.push({ camera, canvas: one.canvas });
      }
      if (!one.isAsking && now >= one.dueAt && !document.hidden) this.#load(name);
    });
    this.#host.hidden = images.length === 0;
    return views;
  }

  /** @param {string} name */
  #add(name) {
    const figure = document.createElement('figure'), image = document.createElement('img');
    const canvas = document.createElement('canvas'), note = document.createElement('figcaption');
    image.alt = `Camera ${name}`;
    canvas.ariaHidden = 'true';  // the scene has a description of its own
    const enlarge = document.createElement('button');
    enlarge.type = 'button';
    enlarge.ariaLabel = `Enlarge camera ${name}`;
    enlarge.ariaPressed = 'false';
    enlarge.addEventListener('click', () => this.#setLarge(figure.dataset.large === 'true' ? null : figure));
    figure.append(image, canvas, note, enlarge);
    this.#host.append(figure);
    const one = { figure, image, canvas, note, enlarge, number: 0, url: '', tag: '', isAsking: false, dueAt: 0 };
    this.#shown.set(name, one);
    return one;
  }

  /** @param {HTMLElement|null} large  null: none is */
  #setLarge(large) {
    this.#host.dataset.large = String(large !== null);
    for (const { figure, enlarge } of this.#shown.values()) {
      figure.dataset.large = enlarge.ariaPressed = String(figure === large);
    }
  }

  /** @param {string} name */
  async #load(name) {
    const one = this.#shown.get(name);
    if (one === undefined) return;
    one.isAsking = true;
    // One that does not come is asked for again: the banner says what has become of the server.
    const answer = await request(`api/v1/image/${one.number}`).catch(() => null);
    const tag = answer?.headers.get('ETag') ?? '';
    const picture = tag === one.tag ? null : await answer?.blob().catch(() => null);
    const url = picture ? URL.createObjectURL(picture) : '';
    const isPicture = url !== '' && await isDecoded(url);  // before it is shown, so that the place is never empty
    one.isAsking = false;
    one.dueAt = performance.now() + PAUSE_MILLIS;
    if (!isPicture || this.#shown.get(name) !== one) return URL.revokeObjectURL(url);
    one.image.src = url;
    URL.revokeObjectURL(one.url);
    one.url = url;
    one.tag = tag;
  }
}
