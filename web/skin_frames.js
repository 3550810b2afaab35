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

/** @param {THREE.Quaternion} rotation
 *  @param {number} share */
const partOf = (rotation, share) => IDENTITY.clone().slerp(rotation, share);

/** parent_from_child = rise * rest * twist. The bone rises in its own plane; straight up that plane could be any, so it
 *  goes over to that of the middle of the joint's range.
 *  @param {THREE.Quaternion} rotation  parent_from_child
 *  @param {THREE.Quaternion|undefined} middle  undefined: the joint has no twist of its own
 *  @param {Rig} rig */
function split(rotation, middle, { ownPlaneUntil, middleShare }) {
  const bone = Z.clone().applyQuaternion(rotation);
  const risen = Math.acos(Math.min(1, Math.max(-1, bone.z)));
  const t = Math.min(1, Math.max(0, (risen - ownPlaneUntil) / (Math.PI - ownPlaneUntil)));
  const plane = Z.clone().applyQuaternion(middle ?? IDENTITY).multiplyScalar(middleShare * t * t * (3 - 2 * t)).add(bone);
  const towards = new THREE.Vector3(-plane.x, -plane.y, 0);
  if (towards.length() > 1e-9) towards.normalize();
  else towards.set(1, 0, 0);
  if (!middle) return { risen, towards, rise: rotation, rest: IDENTITY, twist: IDENTITY };
  const rise = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(towards.y, -towards.x, 0), risen);
  const swing = swingTo(Z.clone().applyQuaternion(rise), bone).multiply(rise);
  return {
    risen, towards, rise, rest: rise.clone().conjugate().multiply(swing),
    twist: aboutZ(twistAngle(swing.clone().conjugate().multiply(rotation))),
  };
}

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
  return rig.frames.map(({ kind, link, parent, share, intoBend, upBone }, i) => {
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
    const { risen, towards, rise, rest, twist } = jointOf(link, up);
    const swung = (/** @type {number} */ part) => up.clone().multiply(partOf(rise, part)).multiply(partOf(rest, part));
    if (kind === 'twist') return { position: own.position, rotation: swung(1).multiply(partOf(twist, share)) };
    const bent = 0.5 * (1 - Math.cos(risen));
    const move = towards.clone().multiplyScalar(bent * intoBend).addScaledVector(Z, risen / Math.PI * upBone)
      .applyQuaternion(up.clone().multiply(partOf(rise, 0.5)));
    return { position: move.add(own.position), rotation: swung(share) };
  });
}
