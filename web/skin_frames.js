// The frames that carry the skin, computed from the streamed link poses as the server computes them
// (urdf/skin/frames.cc). A joint has frames that turn by part of its swing; upper arm, forearm and thigh have frames
// that carry part of their twist. World frame: z up, metres. Pure functions.
import * as THREE from 'three';

/** @typedef {{position: number[], quaternion: number[]}} Pose  world_from_link
 *  @typedef {{position: THREE.Vector3, rotation: THREE.Quaternion}} Frame  world_from_frame
 *  @typedef {import('./skin_buffer.js').Rig} Rig */

const IDENTITY = new THREE.Quaternion();
const Z = new THREE.Vector3(0, 0, 1);

/** Rotation about z, rad, -pi..pi.
 *  @param {THREE.Quaternion} q */
function twistAngle({ z, w }) {
  const angle = 2 * Math.atan2(z, w);
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

/** @param {number} angle  rad */
const aboutZ = (angle) => new THREE.Quaternion().setFromAxisAngle(Z, angle);

/** @param {THREE.Vector3} from  unit
 *  @param {THREE.Vector3} to  unit */
const swingTo = (from, to) => new THREE.Quaternion().setFromUnitVectors(from, to);

/** parent_from_child = swing * twist. Low down it is the smallest swing from hanging; the one from the middle of the
 *  joint's range takes over while the bone rises.
 *  @param {THREE.Quaternion} rotation  parent_from_child
 *  @param {THREE.Quaternion|undefined} middle  undefined: the joint has no twist of its own
 *  @param {Rig} rig */
function split(rotation, middle, { naturalUntil, middleFrom }) {
  if (!middle) return { swing: rotation, twist: IDENTITY };
  const bone = Z.clone().applyQuaternion(rotation);
  const far = swingTo(Z.clone().applyQuaternion(middle), bone).multiply(middle);
  const risen = Math.acos(Math.min(1, Math.max(-1, bone.z)));
  let swing = far;
  if (risen < middleFrom) {
    const near = swingTo(Z, bone);
    const t = Math.min(1, Math.max(0, (risen - naturalUntil) / (middleFrom - naturalUntil)));
    const angle = t * t * (3 - 2 * t) * twistAngle(near.clone().conjugate().multiply(far));
    swing = near.multiply(aboutZ(angle));
  }
  return { swing, twist: aboutZ(twistAngle(swing.clone().conjugate().multiply(rotation))) };
}

/** @param {THREE.Quaternion} rotation
 *  @param {number} share */
const partOf = (rotation, share) => IDENTITY.clone().slerp(rotation, share);

/** All frames in the order of the rig.
 *  @param {Rig} rig
 *  @param {Pose[]} poses  of the links, as they are streamed
 *  @returns {Frame[]} */
export function framesOf(rig, poses) {
  const links = poses.map(({ position, quaternion }) => ({
    position: new THREE.Vector3().fromArray(position), rotation: new THREE.Quaternion().fromArray(quaternion),
  }));
  /** @type {Map<number, ReturnType<typeof split>>} */
  const joints = new Map();
  const jointOf = (/** @type {number} */ link, /** @type {THREE.Quaternion} */ up) => {
    const known = joints.get(link);
    if (known) return known;
    const joint = split(up.clone().conjugate().multiply(links[link].rotation), rig.middles.get(link), rig);
    joints.set(link, joint);
    return joint;
  };
  return rig.frames.map(({ kind, link, parent, share, offset }, i) => {
    const own = links[link];
    if (kind === 'link') return own;
    if (kind === 'fixed') {
      const { position, rotation } = rig.inHand[i];
      return {
        position: position.clone().applyQuaternion(own.rotation).add(own.position),
        rotation: own.rotation.clone().multiply(rotation),
      };
    }
    const up = links[parent].rotation;
    if (kind === 'half') return { position: own.position, rotation: up.clone().slerp(own.rotation, share) };
    const { swing, twist } = jointOf(link, up);
    if (kind === 'twist') {
      return { position: own.position, rotation: up.clone().multiply(swing).multiply(partOf(twist, share)) };
    }
    const cosine = Math.cos(2 * Math.acos(Math.min(1, Math.abs(swing.w))));
    const outwards = new THREE.Vector3(0.5 * offset * (1 - cosine), 0, 0)
      .applyQuaternion(up.clone().multiply(partOf(swing, 0.5)));
    return { position: outwards.add(own.position), rotation: up.clone().multiply(partOf(swing, share)) };
  });
}
