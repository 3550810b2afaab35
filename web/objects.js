// Tracked objects: each is a small block with the axes of its frame and its name, because its appearance is not
// streamed. World frame: z up, metres.
import * as THREE from 'three';
import { toColor } from './colors.js';
import { labelText } from './format.js';

const BLOCK = 0.05;
const AXIS_LENGTH = 0.15;
const AXIS_RADIUS = 0.005;
const LABEL_LIFT = 0.1;      // m above the object
const LABEL_HEIGHT = 0.034;  // as a share of the view's height, at any distance
const LABEL_PIXELS = 44;     // font size of the label's texture

/** Unique key of an object.
 *  @param {{character: number, number: number}} object */
export const keyOf = ({ character, number }) => `${character}/${number}`;

export class ObjectMarkers {
  group = new THREE.Group();
  #fovDegrees;
  #markers = /** @type {Map<string, {group: THREE.Group, name: string, label: THREE.Sprite|null}>} */ (new Map());
  #names = /** @type {Map<string, string>} */ (new Map());
  #block = new THREE.BoxGeometry(BLOCK, BLOCK, BLOCK);
  #rod = new THREE.CylinderGeometry(AXIS_RADIUS, AXIS_RADIUS, AXIS_LENGTH, 12).translate(0, AXIS_LENGTH / 2, 0);

  /** @param {Pick<import('./messages.js').Palette, 'object'|'axes'|'stale_body'>} palette
   *  @param {number} fovDegrees  vertical field of view */
  constructor(palette, fovDegrees) {
    this.#fovDegrees = fovDegrees;
    this.materials = [palette.object, ...palette.axes].map(toColor).map(
      (color) => ({ color, material: new THREE.MeshStandardMaterial({ color, roughness: 0.7 }) }));
    this.staleColor = toColor(palette.stale_body);
  }

  /** Labels keep their size on the screen.
   *  @param {number} degrees  vertical field of view */
  setFieldOfView(degrees) {
    if (degrees === this.#fovDegrees) return;
    this.#fovDegrees = degrees;
    for (const { label } of this.#markers.values()) if (label) this.#fit(label);
  }

  /** Names arrive separately from poses, and later.
   *  @param {import('./messages.js').ObjectName[]} names */
  setNames(names) {
    this.#names = new Map(names.map((object) => [keyOf(object), object.name]));
    for (const [key, marker] of this.#markers) this.#relabel(key, marker);
  }

  /** @param {import('./state_codec.js').TrackedObject[]} objects
   *  @param {boolean} isLive */
  update(objects, isLive) {
    for (const { color, material } of this.materials) material.color.copy(isLive ? color : this.staleColor);
    const seen = new Set(objects.map(keyOf));
    for (const [key, { group, label }] of this.#markers) {
      if (seen.has(key)) continue;
      group.removeFromParent();
      dispose(label);
      this.#markers.delete(key);
    }
    for (const object of objects) {
      const { group, label } = this.#markers.get(keyOf(object)) ?? this.#add(keyOf(object));
      group.position.fromArray(object.position);
      group.children[0].quaternion.fromArray(object.quaternion);
      label?.position.set(0, 0, LABEL_LIFT);
    }
  }

  /** @param {string} key */
  #add(key) {
    const body = new THREE.Group();
    const [block, ...axes] = this.materials;
    body.add(new THREE.Mesh(this.#block, block.material));
    const turns = [[0, 0, -Math.PI / 2], [0, 0, 0], [Math.PI / 2, 0, 0]];  // the rod lies along y
    axes.forEach(({ material }, i) => {
      const rod = new THREE.Mesh(this.#rod, material);
      rod.rotation.set(turns[i][0], turns[i][1], turns[i][2]);
      body.add(rod);
    });
    body.traverse((part) => { part.castShadow = true; });
    const group = new THREE.Group();
    group.add(body);
    this.group.add(group);
    const marker = { group, name: '', label: null };
    this.#markers.set(key, marker);
    this.#relabel(key, marker);
    return marker;
  }

  /** @param {string} key
   *  @param {{group: THREE.Group, name: string, label: THREE.Sprite|null}} marker */
  #relabel(key, marker) {
    const name = this.#names.get(key) ?? '';
    if (name === marker.name) return;
    dispose(marker.label);
    marker.name = name;
    marker.label = name ? makeLabel(labelText(name)) : null;
    if (!marker.label) return;
    marker.label.position.set(0, 0, LABEL_LIFT);
    this.#fit(marker.label);
    marker.group.add(marker.label);
  }

  /** @param {THREE.Sprite} label */
  #fit(label) {
    const viewHeight = 2 * Math.tan((this.#fovDegrees * Math.PI) / 360);  // at 1 m: the reference distance of such a sprite
    const height = LABEL_HEIGHT * viewHeight;
    label.scale.multiplyScalar(height / label.scale.y);
  }
}

/** @param {THREE.Sprite|null} label */
function dispose(label) {
  label?.removeFromParent();
  label?.material.map?.dispose();
  label?.material.dispose();
}

/** Text that keeps its size on the screen.
 *  @param {string} text */
function makeLabel(text) {
  const canvas = document.createElement('canvas');
  const font = `${LABEL_PIXELS}px sans-serif`;
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(text).width) + LABEL_PIXELS;
  canvas.height = Math.ceil(1.7 * LABEL_PIXELS);
  pen.font = font;  // resizing a canvas resets its font
  pen.fillStyle = 'rgb(255 255 255 / .85)';
  pen.beginPath();
  pen.roundRect(0, 0, canvas.width, canvas.height, 0.4 * LABEL_PIXELS);
  pen.fill();
  pen.fillStyle = 'rgb(28 34 42)';
  pen.textBaseline = 'middle';
  pen.fillText(text, LABEL_PIXELS / 2, canvas.height / 2);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const label = new THREE.Sprite(new THREE.SpriteMaterial({ map, sizeAttenuation: false, depthTest: false, fog: false }));
  label.renderOrder = 20;
  label.scale.set(canvas.width / canvas.height, 1, 1);
  return label;
}
