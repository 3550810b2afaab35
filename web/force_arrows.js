// The ground reaction force on each foot as an arrow from its centre of pressure. World frame: z up, metres.
import * as THREE from 'three';
import { BEHIND, makeLitMaterial } from './lit_material.js';

const METRES_PER_NEWTON = 1e-3;  // as in pictures and RViz
const SHAFT = 0.009, HEAD = 0.024, HEAD_LENGTH = 0.06;  // m; radii, and the length of the head
const LONGEST_HEAD = 0.6;  // of the arrow
export const OCCLUDED_OPACITY = 0.45;  // of what is visible through the body
const UP = new THREE.Vector3(0, 0, 1);

// Along z, from 0 to 1.
const shaft = new THREE.CylinderGeometry(1, 1, 1, 16).rotateX(Math.PI / 2).translate(0, 0, 0.5);
const head = new THREE.ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
/** Shared by all arrows. */
export const ARROW_SHAPES = [shaft, head];

/** Shared by all people: where nothing is in front of an arrow, and where something is.
 *  @param {number[]} rgb */
export const makeArrowMaterials = (rgb) => ({
  solid: makeLitMaterial(rgb),
  occluded: makeLitMaterial(rgb, OCCLUDED_OPACITY, BEHIND),
});

/** @typedef {ReturnType<typeof makeArrowMaterials>} ArrowMaterials */

export class ForceArrows {
  group = new THREE.Group();
  #materials;

  /** @param {ArrowMaterials} materials */
  constructor(materials) {
    this.#materials = materials;
  }

  /** @param {import('./state_codec.js').GroundForce[]} feet  with a force that is shown */
  update(feet) {
    while (this.group.children.length < feet.length) this.group.add(this.#makeArrow());
    this.group.children.forEach((arrow, i) => {
      arrow.visible = i < feet.length;
      if (arrow.visible) place(arrow, feet[i]);
    });
  }

  #makeArrow() {
    const arrow = new THREE.Group();
    for (const shape of ARROW_SHAPES) {
      const part = new THREE.Group();
      const occluded = new THREE.Mesh(shape, this.#materials.occluded);
      occluded.renderOrder = 10;
      part.add(new THREE.Mesh(shape, this.#materials.solid), occluded);
      arrow.add(part);
    }
    return arrow;
  }
}

/** @param {THREE.Object3D} arrow
 *  @param {import('./state_codec.js').GroundForce} foot */
function place(arrow, { cop, force }) {
  const direction = new THREE.Vector3().fromArray(force);
  const length = METRES_PER_NEWTON * direction.length(), headLength = Math.min(HEAD_LENGTH, LONGEST_HEAD * length);
  arrow.position.fromArray(cop);
  arrow.quaternion.setFromUnitVectors(UP, direction.normalize());
  const [shaftPart, headPart] = arrow.children;
  shaftPart.scale.set(SHAFT, SHAFT, length - headLength);
  headPart.position.z = length - headLength;
  headPart.scale.set(HEAD, HEAD, headLength);
}
