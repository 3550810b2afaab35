// Flat marks of a person: the ring below the CoM and the line to it, the disc of the CoP, the support polygon. Shapes and
// sizes are those of the server's pictures. World frame: z up, metres.
import * as THREE from 'three';
import { toColor } from './colors.js';
import { BEHIND } from './lit_material.js';

/** @typedef {import('./messages.js').MarkSizes} MarkSizes */

const RING_HOLE = 0.78;         // its radius, as a share of the ring's
const SUPPORT_WIDTH = 0.006;    // m, of its lines
const SUPPORT_LIFT = 0.0045;    // m above the floor, so that floor and marks do not flicker
const RING_LIFT = 0.004, EDGE_LIFT = 0.006, DISC_LIFT = 0.008;
const CORNERS = 32;

const ring = new THREE.RingGeometry(RING_HOLE, 1, CORNERS);
const disc = new THREE.CircleGeometry(1, CORNERS);
const line = new THREE.CylinderGeometry(1, 1, 1, 16).rotateX(Math.PI / 2).translate(0, 0, -0.5);  // from 0 down
const axis = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, -1)]);
/** Shared by all people. */
export const MARK_SHAPES = [ring, disc, line, axis];

/** Shared by all people: where nothing is in front of a mark, and where something is.
 *  @param {THREE.Color} color
 *  @param {number} opacity  of what shines through */
function flat(color, opacity) {
  const side = THREE.DoubleSide;
  return {
    solid: new THREE.MeshBasicMaterial({ color, side }),
    ghost: new THREE.MeshBasicMaterial({ color, side, opacity, ...BEHIND }),
  };
}

/** @param {import('./messages.js').Palette} palette
 *  @param {number} opacity */
export const makeFlatMaterials = (palette, opacity) => ({
  com: flat(toColor(palette.com), opacity), edge: flat(new THREE.Color(1, 1, 1), opacity), cop: flat(toColor(palette.cop), opacity),
  support: flat(toColor(palette.support), opacity),
  // Of one pixel: what is thinner would have gaps where edges are not smoothed.
  comLine: new THREE.LineBasicMaterial({ color: toColor(palette.com) }),
  supportLine: new THREE.LineBasicMaterial({ color: toColor(palette.support) }),
});

/** @param {THREE.BufferGeometry} shape
 *  @param {ReturnType<typeof flat>} materials
 *  @param {number} order  among the marks that shine through */
function mark(shape, { solid, ghost }, order) {
  const group = new THREE.Group(), through = new THREE.Mesh(shape, ghost);
  through.renderOrder = 10 + order;
  group.add(new THREE.Mesh(shape, solid), through);
  return group;
}

export class PointMarks {
  com = new THREE.Group();
  cop = new THREE.Group();
  /** It does not shine through shoes. */
  support = new THREE.Group();
  #sizes;
  #ring;
  #line;
  #axis;
  #edges;
  #outline;

  /** @param {MarkSizes} sizes
   *  @param {ReturnType<typeof makeFlatMaterials>} materials */
  constructor(sizes, materials) {
    this.#sizes = sizes;
    this.#ring = mark(ring, materials.com, 0);
    this.#line = mark(line, materials.com, 0);
    this.#axis = new THREE.Line(axis, materials.comLine);
    this.com.add(this.#ring, this.#line, this.#axis);
    const edge = mark(disc, materials.edge, 0), inner = mark(disc, materials.cop, 1);
    edge.scale.setScalar(sizes.cop_edge);
    inner.scale.setScalar(sizes.cop);
    edge.position.z = EDGE_LIFT;
    inner.position.z = DISC_LIFT;
    this.cop.add(edge, inner);
    this.#edges = new THREE.Mesh(new THREE.BufferGeometry(), materials.support.solid);
    this.#outline = new THREE.LineLoop(new THREE.BufferGeometry(), materials.supportLine);
    for (const part of [this.#edges, this.#outline]) part.frustumCulled = false;
    this.support.add(this.#edges, this.#outline);
  }

  /** @param {import('./state_codec.js').Person} person
   *  @param {number} floor  height of the floor, m */
  update({ com, cop, support }, floor) {
    this.com.visible = com !== null;
    this.cop.visible = cop !== null;
    this.support.visible = support.length > 1;
    if (com) {
      this.#ring.position.set(com[0], com[1], floor + RING_LIFT);
      this.#ring.scale.setScalar(this.#sizes.com_ring);
      const top = com[2] - this.#sizes.com;  // below the sphere: it must not shine through that
      for (const part of [this.#line, this.#axis]) {
        part.position.set(com[0], com[1], top);
        part.scale.set(this.#sizes.com_line, this.#sizes.com_line, Math.max(0.001, top - floor));
      }
    }
    if (cop) this.cop.position.fromArray(cop);
    if (this.support.visible) this.#drawSupport(support, floor + SUPPORT_LIFT);
  }

  hide() {
    for (const each of [this.com, this.cop, this.support]) each.visible = false;
  }

  /** @param {number[][]} corners
   *  @param {number} z */
  #drawSupport(corners, z) {
    const points = [], triangles = [];
    for (const [i, [x0, y0]] of corners.entries()) {
      const [x1, y1] = corners[(i + 1) % corners.length];
      const length = Math.max(Math.hypot(x1 - x0, y1 - y0), 1e-9);
      const u = SUPPORT_WIDTH / 2 * (x1 - x0) / length, v = SUPPORT_WIDTH / 2 * (y1 - y0) / length;  // along it
      const first = points.length / 3;
      points.push(x0 - u - v, y0 - v + u, z, x0 - u + v, y0 - v - u, z, x1 + u + v, y1 + v - u, z, x1 + u - v, y1 + v + u, z);
      triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
    this.dispose();
    this.#edges.geometry = new THREE.BufferGeometry();
    this.#edges.geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    this.#edges.geometry.setIndex(triangles);
    this.#outline.geometry = new THREE.BufferGeometry().setFromPoints(corners.map(([x, y]) => new THREE.Vector3(x, y, z)));
  }

  dispose() {
    this.#edges.geometry.dispose();
    this.#outline.geometry.dispose();
  }
}
