// What is beside the people: external markers and robots, as the server makes them of the triangles of its pictures.
import * as THREE from 'three';
import { readLabelText, readPointsExtras, readSurroundings } from './messages.js';
import { request } from './server_api.js';

const RETRY_MILLIS = 1000;
const BEING_MADE = 202;  // the status of an answer: those of a former state are made when they are asked for
const BEING_MADE_MILLIS = 100;
const NOTE_HEIGHT = 0.05;   // m, of a capital in the name of a missing mesh
const CAPITAL_SHARE = 0.73; // of a font's size
const LINE = 1.2;           // from line to line, of a font's size
const TEXT_PIXELS = 64;     // size of the font of a label's texture
const PANEL_OPACITY = 0.78; // behind a text, as in pictures
// The materials of what others lie on: what of it is opaque, to hide what is behind it, and all of it. Both come before all else that
// shines through, and are farther than they are, by pixels along their slope and units of depth.
const GROUND = new Map([
  ['ground depth', { order: -2, pixels: 5, units: 160, hides: true }],
  ['ground', { order: -1, pixels: 4, units: 80, hides: false }],
]);
const LEAST_CONTRAST = 0.3; // of a text without a panel, in lightness
// From the axes of GLB to the world's: x forward, y left, z up.
const WORLD_FROM_FILE = new THREE.Quaternion(0.5, 0.5, 0.5, 0.5);

/** @typedef {import('./state_codec.js').Pose} Pose */

export class Surroundings {
  group = new THREE.Group();
  /** @type {string[]} */ problems = [];
  #shown = /** @type {number|null} */ (null);  // revision
  #asked = /** @type {number|null} */ (null);  // revision
  #askAgainAt = -Infinity;  // browser's clock, ms
  #isLoading = false;
  #lightness = 1;  // of the background of the scene
  #hidden = /** @type {readonly string[]} */ ([]);
  /** @type {THREE.Object3D[][]} */ #links = [];  // of the robots that move, by their numbers
  /** @type {readonly Pose[][]} */ #robots = [];

  /** @param {() => void} onChange */
  constructor(onChange) {
    this.group.quaternion.copy(WORLD_FROM_FILE);
    this.onChange = onChange;
  }

  /** Loads all again, as texts have a panel where the background is like them.
   *  @param {THREE.Color} background  of the scene */
  setBackground(background) {
    const { r, g, b } = background.getRGB({ r: 0, g: 0, b: 0 }, THREE.SRGBColorSpace);
    this.#lightness = lightnessOf([r, g, b]);
    this.forget();
  }

  /** @param {readonly string[]} parts */
  hide(parts) {
    this.#hidden = parts;
    this.#hideParts();
  }

  #hideParts() {
    for (const node of this.group.children[0]?.children[0]?.children ?? []) {
      node.visible = !this.#hidden.includes(node.name.startsWith('robot') ? 'robots' : 'markers');
    }
  }

  /** Moves robots.
   *  @param {readonly Pose[][]} robots  of the state that is shown */
  place(robots) {
    this.#robots = robots;
    this.#links.forEach((links, robot) => links.forEach((node, link) => {
      const pose = robots[robot]?.[link];
      node.visible = pose !== undefined && pose.position.every(Number.isFinite) && pose.quaternion.every(Number.isFinite);
      if (!pose || !node.visible) return;
      node.position.fromArray(pose.position);
      node.quaternion.fromArray(pose.quaternion);
    }));
  }

  /** Shows those of the server as soon as they are loaded. Call it often.
   *  @param {number|null} revision  null: there are none
   *  @param {number|null} former  the number of the state on the screen; null: it is the newest one
   *  @param {number} now */
  update(revision, former, now) {
    if (revision === null && this.#shown !== null) this.#show(null, null, []);
    const isAsked = this.#asked === revision && now < this.#askAgainAt;
    if (revision === null || revision === this.#shown || this.#isLoading || isAsked) return;
    this.#asked = revision;
    this.#askAgainAt = now + RETRY_MILLIS;
    this.#load(revision, former);
  }

  /** What is shown, and what is on its way. */
  forget() {
    this.#show(null, null, []);
  }

  /** Whether those of the server are shown.
   *  @param {number|null} revision */
  isAt(revision) {
    return revision === this.#shown && !this.#isLoading;
  }

  /** @param {number} revision
   *  @param {number|null} former */
  async #load(revision, former) {
    this.#isLoading = true;
    try {
      const answer = await request(`api/v1/surroundings.glb?${former === null ? `t=${revision}` : `state=${former}`}`);
      if (answer.status === BEING_MADE) {
        this.#askAgainAt = performance.now() + BEING_MADE_MILLIS;
        return;
      }
      const bytes = await answer.arrayBuffer();
      const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
      const { scene } = await new GLTFLoader().parseAsync(bytes, '');
      if (this.#asked === revision) this.#show(revision, scene, readSurroundings(scene.userData, 'extras').problems);
    } catch {
      this.problems = ['Could not load the external markers and robots'];
    } finally {
      this.#isLoading = false;
    }
  }

  /** @param {number|null} revision
   *  @param {THREE.Object3D|null} scene
   *  @param {string[]} problems */
  #show(revision, scene, problems) {
    this.group.traverse(dispose);
    this.group.clear();
    this.#links = [];
    this.#shown = revision;
    this.problems = problems;
    if (revision === null) this.#asked = null;
    if (scene !== null) {
      scene.traverse((part) => prepare(part, this.#lightness));
      this.group.add(scene);
      this.#links = linksOf(scene);
      this.place(this.#robots);
      this.#hideParts();
    }
    this.onChange();
  }
}

/** A whole number that the file has with a node; null: none.
 *  @param {THREE.Object3D|null} node
 *  @param {string} name */
function numberIn(node, name) {
  const value = /** @type {Record<string, unknown>} */ (node?.userData ?? {})[name];
  return typeof value === 'number' && Number.isInteger(value) && value >= 0 ? value : null;
}

/** The nodes of the links of each robot that moves, by the numbers in the file.
 *  @param {THREE.Object3D} scene */
function linksOf(scene) {
  /** @type {THREE.Object3D[][]} */ const robots = [];
  scene.traverse((node) => {
    const link = numberIn(node, 'link'), robot = numberIn(node.parent, 'robot');
    if (link === null || robot === null) return;
    robots[robot] ??= [];
    robots[robot][link] = node;
  });
  return robots;
}

/** @param {THREE.Object3D} part
 *  @returns {part is THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>} */
const isMesh = (part) => part instanceof THREE.Mesh;

/** @param {THREE.Object3D} part
 *  @returns {part is THREE.Points<THREE.BufferGeometry, THREE.Material>} */
const isPoints = (part) => part instanceof THREE.Points;

/** @param {THREE.Object3D} part
 *  @returns {part is THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>} */
const isLines = (part) => part instanceof THREE.LineSegments;

/** @param {THREE.Object3D} part
 *  @param {number} lightness  of the background */
function prepare(part, lightness) {
  if (isMesh(part)) {
    part.material.fog = false;  // only the floor ends in the distance
    part.castShadow = !part.material.transparent;
    layOnGround(part);
  } else if (isPoints(part)) {
    part.material = squares(part);
  } else if (isLines(part)) {
    part.material.fog = false;
  } else if ('text' in part.userData) {
    part.add(makeText(readLabelText(part.userData, 'extras'), lightness));
  }
}

/** As in pictures, what others lie on hides nothing that is a few pixels behind it, and its triangles are in their order.
 *  @param {THREE.Mesh<THREE.BufferGeometry, THREE.Material>} part */
function layOnGround(part) {
  const place = GROUND.get(part.material.name);
  if (!place) return;
  const { order, pixels, units, hides } = place;
  Object.assign(part.material, {
    polygonOffset: true, polygonOffsetFactor: pixels, polygonOffsetUnits: units, transparent: true, depthWrite: hides, colorWrite: !hides,
  });
  part.castShadow = false;
  part.renderOrder = order;
}

/** Squares that face the camera, with the width of the file's: in the world, or in CSS pixels at any distance.
 *  @param {THREE.Points<THREE.BufferGeometry, THREE.Material>} points */
export function squares({ material: { transparent }, userData }) {
  const { size: [width], in_pixels: isInPixels } = readPointsExtras(userData, 'extras');
  const material = new THREE.PointsMaterial({
    size: width, sizeAttenuation: !isInPixels, vertexColors: true, transparent, depthWrite: !transparent, fog: false,
  });
  if (isInPixels) return material;  // three.js takes the pixel ratio into account itself
  // three.js takes each camera for one that sees as much as it is away.
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('gl_PointSize = size;', 'gl_PointSize = size * projectionMatrix[1][1];');
  };
  return material;
}

/** @param {THREE.Object3D} part */
function dispose(part) {
  const hasShape = isMesh(part) || isPoints(part) || isLines(part);
  if (hasShape) part.geometry.dispose();
  if (!(hasShape || part instanceof THREE.Sprite)) return;
  if (isMesh(part) || part instanceof THREE.Sprite) part.material.map?.dispose();
  part.material.dispose();
}

/** Of a colour, 0 to 1.
 *  @param {readonly number[]} rgb */
const lightnessOf = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** A text that is as high as it is in the world, and in front of everything, as in pictures. RViz's are often white: where the background
 *  is like the text, it has a panel.
 *  @param {import('./messages.js').LabelText} label
 *  @param {number} lightness  of the background */
function makeText({ text, height, color, opacity }, lightness) {
  const canvas = document.createElement('canvas');
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const font = `${TEXT_PIXELS}px "DejaVu Sans", sans-serif`;
  pen.font = font;
  const lines = text.split('\n');
  const margin = 0.4 * TEXT_PIXELS;
  canvas.width = Math.ceil(Math.max(1, ...lines.map((line) => pen.measureText(line).width)) + 2 * margin);
  canvas.height = Math.ceil((1.4 + LINE * (lines.length - 1)) * TEXT_PIXELS);
  if (Math.abs(lightnessOf(color) - lightness) < LEAST_CONTRAST) {
    pen.fillStyle = `rgb(${lightness > 0.5 ? '23 26 31' : '255 255 255'} / ${PANEL_OPACITY * opacity})`;
    pen.beginPath();
    pen.roundRect(0, 0, canvas.width, canvas.height, 0.3 * TEXT_PIXELS);
    pen.fill();
  }
  pen.font = font;  // resizing a canvas resets its font
  pen.fillStyle = `rgb(${color.map((channel) => Math.round(255 * channel)).join(' ')} / ${opacity})`;
  pen.textBaseline = 'middle';
  lines.forEach((line, i) => pen.fillText(line, margin, (0.7 + LINE * i) * TEXT_PIXELS));
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthTest: false, fog: false }));
  const metresPerPixel = (height || NOTE_HEIGHT) / (CAPITAL_SHARE * TEXT_PIXELS);
  sprite.scale.set(canvas.width * metresPerPixel, canvas.height * metresPerPixel, 1);
  sprite.renderOrder = 20;
  return sprite;
}
