// The scene over images of cameras, as each of them sees it: drawn into a part of the view's canvas, and copied from there
// before the view itself is drawn.
import * as THREE from 'three';
import { edgesAt } from './pinhole.js';

const NEAR_AND_FAR = [0.05, 80];  // m
const TO_THREE = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(1, 0, 0), Math.PI);  // y up, looks along -z
const PAUSE_MILLIS = 100;

/** @typedef {import('./messages.js').ImageCamera} ImageCamera
 *  @typedef {{camera: ImageCamera, canvas: HTMLCanvasElement}} ImageView  the canvas lies over the image */

export class ImageViews {
  #camera = new THREE.PerspectiveCamera();  // does not see the floor, which would hide the images
  #views = /** @type {ImageView[]} */ ([]);
  #said = '[]';  // of the views: cameras and sizes
  #drawnAt = -Infinity;
  #isDue = false;

  /** @param {ImageView[]} views
   *  @returns {boolean} whether they are others than before, or have other sizes */
  set(views) {
    const said = JSON.stringify(views.map(({ camera, canvas }) => [camera, canvas.clientWidth, canvas.clientHeight]));
    const isSame = said === this.#said && views.every(({ canvas }, i) => canvas === this.#views[i].canvas);
    this.#views = views;
    this.#said = said;
    return !isSame;
  }

  /** Whether they are to be drawn, although nothing has changed since the last call of draw(). */
  isDue(/** @type {number} */ now) {
    return this.#isDue && now - this.#drawnAt >= PAUSE_MILLIS;
  }

  get isAtRest() {
    return !this.#isDue;
  }

  /** Call it when the scene has changed, before the view is drawn.
   *  @param {THREE.WebGLRenderer} renderer
   *  @param {THREE.Scene} scene
   *  @param {number} now  ms */
  draw(renderer, scene, now) {
    this.#isDue = this.#views.length > 0 && now - this.#drawnAt < PAUSE_MILLIS;
    if (this.#views.length === 0 || this.#isDue) return;
    this.#drawnAt = now;
    const { background, fog } = scene, hasShadows = renderer.shadowMap.autoUpdate;
    const farness = fog instanceof THREE.Fog ? { near: fog.near, far: fog.far } : null;
    const size = renderer.getSize(new THREE.Vector2());
    scene.background = null;
    renderer.shadowMap.autoUpdate = false;  // they do not depend on the camera
    renderer.setClearAlpha(0);
    if (fog instanceof THREE.Fog) Object.assign(fog, { near: 1e6, far: 2e6 });  // what a camera sees is not hidden by it
    for (const view of this.#views) this.#drawOne(renderer, scene, view, size);
    if (fog instanceof THREE.Fog) Object.assign(fog, farness);
    renderer.setClearAlpha(1);
    renderer.shadowMap.autoUpdate = hasShadows;
    scene.background = background;
    renderer.setViewport(0, 0, size.x, size.y);
  }

  /** @param {THREE.WebGLRenderer} renderer
   *  @param {THREE.Scene} scene
   *  @param {ImageView} view
   *  @param {THREE.Vector2} size  of the renderer's canvas, CSS px */
  #drawOne(renderer, scene, { camera, canvas }, size) {
    const { clientWidth, clientHeight } = canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    // As large as it is seen, with the proportions of the image.
    const scale = Math.min(clientWidth / camera.width, clientHeight / camera.height, size.x / camera.width,
      size.y / camera.height);
    const ratio = renderer.getPixelRatio();
    const width = Math.max(1, Math.round(scale * camera.width * ratio));
    const height = Math.max(1, Math.round(scale * camera.height * ratio));
    placeCamera(this.#camera, camera);
    renderer.setViewport(0, 0, width / ratio, height / ratio);
    renderer.render(scene, this.#camera);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = canvas.getContext('2d');
    context?.clearRect(0, 0, width, height);
    const whole = renderer.domElement;
    context?.drawImage(whole, 0, whole.height - height, width, height, 0, 0, width, height);
  }
}

/** @param {THREE.PerspectiveCamera} camera
 *  @param {ImageCamera} taken */
function placeCamera(camera, taken) {
  const [near, far] = NEAR_AND_FAR;
  const { left, right, top, bottom } = edgesAt(taken, near);
  camera.near = near;
  camera.far = far;
  camera.projectionMatrix.makePerspective(left, right, top, bottom, near, far);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.position.fromArray(taken.position);
  camera.quaternion.fromArray(taken.orientation).multiply(TO_THREE);
  camera.updateMatrixWorld();
}
