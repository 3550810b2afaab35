// The recent paths of chosen points, of the samples that were on the screen: lines that become thicker towards their ends.
// World frame: z up, metres.
import * as THREE from 'three';
import { toColor } from './colors.js';

const OLD_RADIUS = 0.0015, NEW_RADIUS = 0.007;  // m
const SIDES = 8;
const MOST_POINTS = 600;  // of a trail
const LONGEST_GAP = 1.5;  // s; over a longer one, the way is not known

/** @typedef {import('./messages.js').TrailLook} TrailLook
 *  @typedef {{micros: number, at: THREE.Vector3}} Point
 *  @typedef {{points: Point[], mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>}} Trail */

/** Adds a point to a path, and forgets what is too old. Time that goes back, or a gap, begins a new path.
 *  @param {Point[]} points  oldest first; changed
 *  @param {Point} point
 *  @param {number} secs  length of the path */
export function remember(points, point, secs) {
  const last = points.at(-1);
  if (last?.micros === point.micros) return;
  if (last && (point.micros < last.micros || point.micros - last.micros > 1e6 * LONGEST_GAP)) points.length = 0;
  points.push(point);
  const first = points.findIndex(({ micros }) => micros >= point.micros - 1e6 * secs);
  points.splice(0, Math.max(first, points.length - MOST_POINTS));
}

export class Trails {
  group = new THREE.Group();
  /** @type {TrailLook[]} */ #looks = [];
  #secs = 2;
  #trails = /** @type {Map<string, Trail>} */ (new Map());  // by person and number of the look

  /** @param {TrailLook[]} looks
   *  @param {number} secs */
  setLook(looks, secs) {
    if (JSON.stringify(looks) !== JSON.stringify(this.#looks)) this.#keepOnly(new Set());
    this.#looks = looks;
    this.#secs = secs;
  }

  /** @param {import('./state_codec.js').State} state  that is on the screen */
  update(state) {
    const seen = new Set();
    for (const person of state.people) {
      this.#looks.forEach((look, i) => {
        const at = look.segment < 0 ? person.com : person.links[look.segment]?.position;
        if (!at) return;  // a path that is interrupted ends
        const key = `${person.character}/${i}`, trail = this.#trails.get(key) ?? this.#add(key, look);
        seen.add(key);
        const before = trail.points.at(-1)?.micros;
        remember(trail.points, { micros: state.stampMicros, at: new THREE.Vector3().fromArray(at) }, this.#secs);
        if (trail.points.at(-1)?.micros !== before) draw(trail);
      });
    }
    this.#keepOnly(seen);
  }

  /** @param {string} key
   *  @param {TrailLook} look */
  #add(key, look) {
    const material = new THREE.MeshStandardMaterial({ color: toColor(look.color), roughness: 0.7 });
    const trail = { points: [], mesh: new THREE.Mesh(new THREE.BufferGeometry(), material) };
    this.group.add(trail.mesh);
    this.#trails.set(key, trail);
    return trail;
  }

  /** @param {Set<string>} keys */
  #keepOnly(keys) {
    for (const [key, { mesh }] of this.#trails) {
      if (keys.has(key)) continue;
      mesh.removeFromParent();
      mesh.geometry.dispose();
      mesh.material.dispose();
      this.#trails.delete(key);
    }
  }
}

/** @param {Trail} trail */
function draw({ points, mesh }) {
  const geometry = tube(points.map(({ at }) => at));
  mesh.geometry.dispose();
  mesh.geometry = geometry ?? new THREE.BufferGeometry();
  mesh.visible = geometry !== null;
}

/** @param {THREE.Vector3[]} all
 *  @returns {THREE.BufferGeometry|null}  null: it has no length */
function tube(all) {
  const centers = all.filter((at, i) => i === 0 || at.distanceTo(all[i - 1]) > 1e-5);
  if (centers.length < 2) return null;
  const positions = new Float32Array(3 * SIDES * centers.length), normals = new Float32Array(positions.length);
  const across = new THREE.Vector3(), other = new THREE.Vector3(), along = new THREE.Vector3(), out = new THREE.Vector3();
  centers.forEach((center, i) => {
    along.subVectors(centers[Math.min(i + 1, centers.length - 1)], centers[Math.max(i - 1, 0)]).normalize();
    across.addScaledVector(along, -across.dot(along));
    if (across.lengthSq() < 1e-9) across.set(along.y, along.z, along.x).cross(along);
    across.normalize();
    other.crossVectors(along, across);
    const radius = OLD_RADIUS + (i + 1) / centers.length * (NEW_RADIUS - OLD_RADIUS);
    for (let k = 0; k < SIDES; ++k) {
      const angle = 2 * Math.PI * k / SIDES, at = 3 * (SIDES * i + k);
      out.copy(across).multiplyScalar(Math.cos(angle)).addScaledVector(other, Math.sin(angle)).toArray(normals, at);
      out.multiplyScalar(radius).add(center).toArray(positions, at);
    }
  });
  const triangles = [];
  for (let i = 0; i + 1 < centers.length; ++i) {
    for (let k = 0; k < SIDES; ++k) {
      const a = SIDES * i + k, b = SIDES * i + (k + 1) % SIDES;
      triangles.push(a, b, b + SIDES, a, b + SIDES, a + SIDES);
    }
  }
  return new THREE.BufferGeometry()
    .setAttribute('position', new THREE.BufferAttribute(positions, 3))
    .setAttribute('normal', new THREE.BufferAttribute(normals, 3))
    .setIndex(triangles);
}
