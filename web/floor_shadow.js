// The soft shadow of a person on the floor, where limbs hide it from the sky, as in pictures of the server
// (render/shape/floor_shadow.cc): a grid of points around the limbs. World frame: z up, metres.
import * as THREE from 'three';
import { capsuleEnds, openSky } from './skin_limbs.js';
import { theme } from './theme.js';

const SIDE = 30;             // points
const MARGIN = 0.45;         // m, around the limbs
const FADING = 0.33;         // m, over which it ends
const ABOVE_FLOOR = 0.002;   // m
const COLORS = { light: new THREE.Vector3(0.20, 0.23, 0.30), dark: new THREE.Vector3() };  // sRGB

const grid = gridGeometry();

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

export class FloorShadow {
  #first = new THREE.Vector3();
  #size = new THREE.Vector2();
  #color = { value: COLORS.light };
  #capsules;
  mesh;

  /** @param {Float32Array} capsules  the limbs; what they are when the shadow is drawn counts
   *  @param {number} count  of limbs */
  constructor(capsules, count) {
    this.#capsules = capsules;
    this.mesh = new THREE.Mesh(grid, new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, transparent: true, depthWrite: false,
      uniforms: {
        capsules: { value: capsules }, covers: { value: new Uint32Array(2 * count).fill(2 ** 32 - 1) },
        first: { value: this.#first }, size: { value: this.#size }, color: this.#color,
      },
      vertexShader: `
        uniform vec3 first;
        uniform vec2 size;
        out float shade;${openSky(count)}
        // From the line within the nearest limb, seen from above, m.
        float distanceFromLimbs(vec2 place) {
          float least = 1e9;
          for (int i = 0; i < ${count}; ++i) {
            vec2 away = place - capsules[3 * i].xy, bone = capsules[3 * i + 1].xy;
            vec2 beside = away - clamp(dot(away, bone) / max(dot(bone, bone), 1e-8), 0.0, 1.0) * bone;
            least = min(least, dot(beside, beside));
          }
          return sqrt(least);
        }
        void main() {
          vec3 place = first + vec3(position.xy * size, 0.0);
          float open = openSky(place, vec3(0.0, 0.0, 1.0), 0);
          // It ends before the grid does.
          float left = clamp((${MARGIN} - distanceFromLimbs(place.xy)) / ${FADING}, 0.0, 1.0);
          shade = max(0.0, 0.8 * (1.0 - open * open * open) * left * left - 0.01);
          gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
        }`,
      fragmentShader: `
        uniform vec3 color;
        in float shade;
        out vec4 pixel;
        void main() { pixel = vec4(color, shade); }`,
    }));
    this.mesh.frustumCulled = false;  // its vertices are placed in the shader
  }

  /** After the limbs have moved.
   *  @param {number} floor  its height, m */
  update(floor) {
    const { first, size } = extentOf(this.#capsules);
    this.#first.set(first[0], first[1], floor + ABOVE_FLOOR);
    this.#size.set(size[0], size[1]);
    this.#color.value = COLORS[theme?.name ?? 'light'];
  }

  dispose() {
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
