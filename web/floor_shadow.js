// The soft shadow of a person on the floor, where limbs hide it from the sky, as in pictures of the server
// (render/shape/floor_shadow.cc): a grid of points around the limbs. World frame: z up, metres.
import * as THREE from 'three';
import { capsuleEnds, CAPSULE_FLOATS, openSkyOverFloor } from './skin_limbs.js';
import { theme } from './theme.js';

export const SIDE = 30;             // points
const MARGIN = 0.45;         // m, around the limbs
const FADING = 0.33;         // m, over which it ends
const ABOVE_FLOOR = 0.002;   // m
const DARKEST = 0.8, UNSEEN = 0.01;
const POINT = 1e-8;          // m², of a bone that stands upright
const { clamp } = THREE.MathUtils;
const COLORS = { light: new THREE.Vector3(0.20, 0.23, 0.30), dark: new THREE.Vector3() };  // sRGB

/** Where a grid around the limbs begins, and its size, m.
 *  @param {Float32Array} capsules */
export function extentOf(capsules) {
  const least = [Infinity, Infinity], most = [-Infinity, -Infinity];
  for (const end of capsuleEnds(capsules)) {
    for (const axis of [0, 1]) {
      least[axis] = Math.min(least[axis], end[axis]);
      most[axis] = Math.max(most[axis], end[axis]);
    }
  }
  return {
    first: least.map((value) => value - MARGIN),
    size: most.map((value, axis) => value - least[axis] + 2 * MARGIN),
  };
}

/** From the line within the nearest limb, seen from above, m.
 *  @param {Float32Array} capsules
 *  @param {number} x
 *  @param {number} y */
function distanceFromLimbs(capsules, x, y) {
  let least = Infinity;  // squared
  for (let i = 0; i < capsules.length; i += CAPSULE_FLOATS) {
    const awayX = x - capsules[i], awayY = y - capsules[i + 1], boneX = capsules[i + 4], boneY = capsules[i + 5];
    const along = clamp((awayX * boneX + awayY * boneY) / Math.max(boneX * boneX + boneY * boneY, POINT), 0, 1);
    least = Math.min(least, (awayX - along * boneX) ** 2 + (awayY - along * boneY) ** 2);
  }
  return Math.sqrt(least);
}

/** How dark each point of a grid is, row by row.
 *  @param {Float32Array} capsules
 *  @param {{first: number[], size: number[]}} extent  of the grid
 *  @param {number} height  of the grid, m
 *  @param {Float32Array} shades  are set; SIDE² */
export function setShades(capsules, { first, size }, height, shades) {
  for (let at = 0; at < SIDE * SIDE; ++at) {
    const x = first[0] + size[0] * (at % SIDE) / (SIDE - 1), y = first[1] + size[1] * Math.floor(at / SIDE) / (SIDE - 1);
    // As if light came from the cloudy part of the sky only. It ends before the grid does.
    const open = openSkyOverFloor(capsules, x, y, height);
    const left = clamp((MARGIN - distanceFromLimbs(capsules, x, y)) / FADING, 0, 1);
    shades[at] = Math.max(0, DARKEST * (1 - open ** 3) * left * left - UNSEEN);
  }
}

/** Of three.js: what lies on the floor, which not every camera sees. */
export const FLOOR_LAYER = 1;

export class FloorShadow {
  #first = new THREE.Vector3();
  #size = new THREE.Vector2();
  #color = { value: COLORS.light };
  #capsules;
  #shades = new Float32Array(SIDE * SIDE);
  #attribute = new THREE.BufferAttribute(this.#shades, 1).setUsage(THREE.DynamicDrawUsage);
  mesh;

  /** @param {Float32Array} capsules  the limbs; what they are at an update counts */
  constructor(capsules) {
    this.#capsules = capsules;
    this.mesh = new THREE.Mesh(gridGeometry().setAttribute('shade', this.#attribute), new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, transparent: true, depthWrite: false,
      uniforms: { first: { value: this.#first }, size: { value: this.#size }, color: this.#color },
      vertexShader: `
        uniform vec3 first;
        uniform vec2 size;
        in float shade;
        out float dark;
        void main() {
          dark = shade;
          gl_Position = projectionMatrix * viewMatrix * vec4(first + vec3(position.xy * size, 0.0), 1.0);
        }`,
      fragmentShader: `
        uniform vec3 color;
        in float dark;
        out vec4 pixel;
        void main() { pixel = vec4(color, dark); }`,
    }));
    this.mesh.layers.set(FLOOR_LAYER);
    this.mesh.frustumCulled = false;  // its vertices are placed in the shader
  }

  /** After the limbs have moved.
   *  @param {number} floor  its height, m */
  update(floor) {
    const extent = extentOf(this.#capsules), height = floor + ABOVE_FLOOR;
    this.#first.set(extent.first[0], extent.first[1], height);
    this.#size.set(extent.size[0], extent.size[1]);
    setShades(this.#capsules, extent, height, this.#shades);
    this.#attribute.needsUpdate = true;
    this.#color.value = COLORS[theme?.name ?? 'light'];
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Points from (0, 0) to (1, 1). */
function gridGeometry() {
  const points = [], triangles = [];
  for (let row = 0; row < SIDE; ++row) {
    for (let column = 0; column < SIDE; ++column) {
      points.push(column / (SIDE - 1), row / (SIDE - 1), 0);
      if (row === 0 || column === 0) continue;
      const at = row * SIDE + column;
      triangles.push(at - SIDE - 1, at - SIDE, at, at - SIDE - 1, at, at - 1);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  geometry.setIndex(triangles);
  return geometry;
}
