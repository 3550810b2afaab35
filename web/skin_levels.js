// The skin of a person, whole and with fewer triangles. The second is for a view that cannot keep up; it is loaded when it
// is first wanted.
import * as THREE from 'three';
import { request } from './server_api.js';
import { SkinnedBody } from './skin.js';
import { readSkin } from './skin_buffer.js';

// As in live pictures of the server where people are about this small: faces are still well lit.
const COARSE_ERROR_MM = 3;

/** @typedef {{links: import('./skin_frames.js').Pose[], floor: number, color: THREE.Color|null, share: number,
 *    loads: Parameters<SkinnedBody['showLoads']>[0]}} Shown  as `update` and `showLoads` of a SkinnedBody take it */

export class SkinLevels {
  group = new THREE.Group();
  #whole = /** @type {SkinnedBody|null} */ (null);
  #coarse = /** @type {SkinnedBody|null} */ (null);
  #isCoarse = false;
  #isCoarseWanted = false;
  #last = /** @type {Shown|null} */ (null);
  #loading = 0;
  #isDisposed = false;
  #url;
  #make;
  #events;

  /** @param {string} url  an absolute path; the page may be served below another path
   *  @param {import('./messages.js').Palette} palette
   *  @param {import('./skin.js').BodyLook} look
   *  @param {{onLoad: () => void, onFail: (url: string) => void}} events  of either level */
  constructor(url, palette, look, events) {
    this.#url = url;
    this.#make = (/** @type {import('./skin_buffer.js').Skin} */ skin) => new SkinnedBody(skin, palette, look);
    this.#events = events;
    this.#load(url, (body) => { this.#whole = body; });
  }

  /** @param {string} url
   *  @param {(body: SkinnedBody) => void} take */
  async #load(url, take) {
    ++this.#loading;
    const body = await this.#bodyOf(url);
    --this.#loading;
    if (this.#isDisposed) return;
    if (body === null) return this.#events.onFail(url);
    take(body);
    this.group.add(body.group);
    this.#show();
    this.#events.onLoad();
  }

  /** @param {string} url
   *  @returns {Promise<SkinnedBody|null>}  null: it cannot be loaded, or is no longer needed */
  async #bodyOf(url) {
    try {
      const answer = await request(url.slice(1));
      const skin = readSkin(await answer.arrayBuffer(), url);
      return this.#isDisposed ? null : this.#make(skin);
    } catch {
      return null;
    }
  }

  /** Whether nothing is under way. */
  get isComplete() {
    return this.#loading === 0;
  }

  get isLoaded() {
    return this.#whole !== null;
  }

  /** @param {boolean} isCoarse  whether fewer triangles will do, as soon as they are there */
  setCoarse(isCoarse) {
    if (isCoarse && !this.#isCoarseWanted) {
      this.#isCoarseWanted = true;
      this.#load(`${this.#url}?error_mm=${COARSE_ERROR_MM}`, (body) => { this.#coarse = body; });
    }
    this.#isCoarse = isCoarse;
    this.#show();
  }

  /** Borders of load classes may be anywhere, and would be ragged on large triangles. */
  get #shown() {
    return this.#isCoarse && this.#coarse !== null && (this.#last?.loads ?? null) === null ? this.#coarse : this.#whole;
  }

  #show() {
    const shown = this.#shown;
    for (const body of this.#bodies) body.group.visible = body === shown;
    if (shown === null || this.#last === null) return;
    const { links, floor, color, share, loads } = this.#last;
    shown.update(links, floor, color, share);
    shown.showLoads(loads);
  }

  /** @param {Shown} shown */
  update(shown) {
    this.#last = shown;
    this.#show();
  }

  get #bodies() {
    return [this.#whole, this.#coarse].filter((body) => body !== null);
  }

  /** Of all levels. */
  get meshes() {
    return this.#bodies.flatMap(({ bodies }) => bodies);
  }

  get shadows() {
    return this.#bodies.flatMap(({ shadows }) => shadows);
  }

  /** Before it is drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    this.#shown?.pose(renderer);
  }

  dispose() {
    this.#isDisposed = true;
    for (const body of this.#bodies) body.dispose();
  }
}
