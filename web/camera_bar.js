// The buttons and keys of the named cameras. They turn the page's own view; without WebGL, the server's picture has its
// place, and they choose the camera of that, which is the same for all who see it.
import { OWN_CAMERA } from './cameras.js';
import { cameraLabel, shortCameraLabel } from './format.js';
import { placeOf } from './orbit.js';

const START_VIEW = 'three_quarter';
const KEYS = { front: 'F', back: 'B', left: 'L', right: 'R', top: 'T', iso: 'I', three_quarter: 'V' };

/** @typedef {import('./messages.js').CameraView} CameraView
 *  @typedef {import('./messages.js').Framing} Framing */

export class CameraBar {
  /** @type {CameraView[]} */ #cameras = [];
  /** @type {Framing|null} */ #framing = null;
  #name = '';  // "" after the viewer moved the view by hand

  /** @param {HTMLElement} bar
   *  @param {import('./scene.js').Scene|null} scene  null: without WebGL
   *  @param {string|null} linked  of the address with which the page was opened
   *  @param {(camera: string) => void} tellServer */
  constructor(bar, scene, linked, tellServer) {
    this.bar = bar;
    this.scene = scene;
    this.linked = linked;
    this.tellServer = tellServer;
    if (scene === null) bar.append(gate());
  }

  /** @param {import('./keys.js').Keys} keys */
  addKeys(keys) {
    for (const [name, key] of Object.entries(KEYS)) {
      keys.add('View', key, `Camera ${cameraLabel(name)}`, () => this.#chooseByKey(name));
    }
  }

  /** For the address; null: as the page begins. */
  get text() {
    if (this.scene === null || this.#cameras.length === 0) return this.linked;
    return this.scene.placeText ?? (this.#name === this.#start?.name ? null : this.#name);
  }

  /** With which the page begins. */
  get #start() {
    const named = (/** @type {string} */ wanted) => this.#cameras.find(({ name }) => name === wanted);
    return named(OWN_CAMERA) ?? named(START_VIEW) ?? this.#cameras[0];
  }

  /** Whether the server has told them. */
  get isKnown() {
    return this.#cameras.length > 0;
  }

  /** A reconnection keeps the camera that the viewer has.
   *  @param {import('./messages.js').Cameras} answer */
  setCameras({ cameras, framing, live }) {
    const isFirst = this.#cameras.length === 0;
    this.#cameras = cameras;
    this.#framing = framing;
    if (isFirst) (this.bar.querySelector('fieldset') ?? this.bar).replaceChildren(...cameras.map((view) => this.#button(view)));
    if (this.scene === null) this.mark(live);
    else if (isFirst) this.#begin(this.scene, framing);
  }

  /** @param {import('./scene.js').Scene} scene
   *  @param {Framing} framing */
  #begin(scene, framing) {
    const start = this.#start;
    const named = this.#cameras.find(({ name }) => name === this.linked), place = placeOf(this.linked ?? '');
    if (named ?? start) this.#choose(named ?? start);
    if (place !== null && start) scene.setPlace(place, start, framing);
  }

  /** @param {string} name  "" after the viewer moved the view by hand */
  mark(name) {
    this.#name = name;
    for (const button of this.bar.querySelectorAll('button')) button.ariaPressed = String(button.dataset.camera === name);
  }

  /** @param {CameraView} view */
  #button(view) {
    const button = document.createElement('button');
    const label = view.name === OWN_CAMERA ? 'own: the camera that the server was started with' : cameraLabel(view.name);
    button.type = 'button';
    button.textContent = shortCameraLabel(view.name);
    button.title = label;
    button.ariaLabel = label;
    button.dataset.camera = view.name;
    button.ariaPressed = 'false';
    button.addEventListener('click', () => this.#choose(view));
    return button;
  }

  /** @param {string} name */
  #chooseByKey(name) {
    const view = this.#cameras.find((each) => each.name === name);
    if (view && !this.bar.querySelector('fieldset')?.disabled) this.#choose(view);
  }

  /** @param {CameraView} view */
  #choose(view) {
    if (this.scene === null) return this.tellServer(view.name);
    if (this.#framing) this.scene.setView(view, this.#framing);
    this.mark(view.name);
  }
}

/** Only operators change what all see (role.js). */
function gate() {
  const element = document.createElement('fieldset');
  element.className = 'gate';
  element.dataset.needs = 'operator';
  element.ariaLabel = 'Camera of the server’s picture, for all viewers';
  element.setAttribute('aria-describedby', 'role');
  return element;
}
