// The person in the view: the skin, the links of /api/v1/model at the streamed poses, load spheres, CoM, CoP, support
// polygon, ground reaction forces and hand loads. World frame: z up, metres.
import * as THREE from 'three';
import { RoundedBoxGeometry } from 'three/addons/geometries/RoundedBoxGeometry.js';
import { STLLoader } from 'three/addons/loaders/STLLoader.js';
import { toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import { toColor } from './colors.js';
import { ARROW_SHAPES, ForceArrows, makeArrowMaterials, OCCLUDED_OPACITY } from './force_arrows.js';
import { makeLitMaterial } from './lit_material.js';
import { makeFlatMaterials, MARK_SHAPES, PointMarks } from './point_marks.js';
import { SkinLevels } from './skin_levels.js';
import { Spheres } from './spheres.js';
import { theme } from './theme.js';

const HELD_ROUNDING = 0.04;     // radius of the edges of a box, as a share of its side
const CREASE = 0.7;             // rad; edges with a smaller angle are shaded smooth

// Shapes of hand loads, scaled to their sizes.
const unitBox = new RoundedBoxGeometry(1, 1, 1, 3, HELD_ROUNDING);
const unitCylinder = new THREE.CylinderGeometry(1, 1, 1, 32).rotateX(Math.PI / 2);
/** @type {Set<THREE.BufferGeometry>} */
const SHARED = new Set([unitBox, unitCylinder, ...ARROW_SHAPES, ...MARK_SHAPES]);

/** @typedef {import('./messages.js').Visual} Visual
 *  @typedef {import('./messages.js').Palette} Palette
 *  @typedef {Pick<import('./messages.js').Look, 'loads'|'style'> & {hidden: import('./scene_parts.js').ScenePart[]}} HumanLook */

/** Materials of the markers, shared by all people.
 *  @param {Palette} palette */
export function makeMarkerMaterials(palette) {
  return {
    flat: makeFlatMaterials(palette, OCCLUDED_OPACITY),
    force: makeArrowMaterials(palette.cop),
    held: makeLitMaterial(palette.held),
    staleHeld: makeLitMaterial(palette.stale_body),
  };
}

/** @param {THREE.Object3D} part
 *  @returns {part is THREE.Mesh|THREE.Line} */
const hasGeometry = (part) => part instanceof THREE.Mesh || part instanceof THREE.Line;

export class Human {
  group = new THREE.Group();
  /** @type {string[]} */ failedMeshes = [];
  #loading = 0;  // meshes under way
  #skin = /** @type {SkinLevels|null} */ (null);
  #look;
  #last = /** @type {{person: import('./state_codec.js').Person, isLive: boolean, floor: number}|null} */ (null);
  #links = /** @type {THREE.Group[]} */ ([]);
  #materials = /** @type {Map<string, {material: THREE.MeshStandardMaterial, live: THREE.Color}>} */ (new Map());
  #held = /** @type {THREE.Mesh[]} */ ([]);
  #sizes;
  #marks;
  #spheres = new Spheres(OCCLUDED_OPACITY);

  /** @param {import('./messages.js').PersonModel} model
   *  @param {Palette} palette
   *  @param {ReturnType<typeof makeMarkerMaterials>} markers
   *  @param {HumanLook} look
   *  @param {() => void} onChange  called whenever a mesh has been loaded */
  constructor(model, palette, markers, look, onChange) {
    this.#look = look;
    this.palette = palette;
    this.markers = markers;
    this.revision = model.revision;
    this.isGhost = model.ghost_opacity !== null;  // else a person of the stream
    this.opacity = model.opacity;
    this.staleColor = toColor(palette.stale_body);
    this.clayColor = toColor(palette.clay);
    for (const link of model.links) {
      const group = new THREE.Group();
      for (const visual of link.visuals) this.#addVisual(group, visual, onChange);
      this.#links.push(group);
      this.group.add(group);
    }
    if (model.skin !== null) this.#skin = this.#loadSkin(model.skin, onChange);
    this.#sizes = model.marks;
    this.#marks = new PointMarks(model.marks, markers.flat);
    this.forces = new ForceArrows(markers.force);
    this.group.add(this.#spheres.group, this.#marks.com, this.#marks.cop, this.#marks.support, this.forces.group);
  }

  /** @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive
   *  @param {number} floor  height of the floor, m */
  update(person, isLive, floor) {
    const color = this.#bodyColor(isLive);
    for (const { material, live } of this.#materials.values()) {
      material.color.copy(color ?? live).lerp(live, 1 - this.#colorShare);
    }
    this.#last = { person, isLive, floor };
    this.#updateSkin(this.#last);
    person.links.forEach(({ position, quaternion }, i) => {
      this.#links[i]?.position.fromArray(position);
      this.#links[i]?.quaternion.fromArray(quaternion);
    });
    this.#updateSpheres(person, isLive);
    this.#marks.update(person, floor);
    if (!isLive) this.#marks.hide();
    this.forces.update(isLive ? person.feet : []);
    this.#updateHeld(person, isLive);
    this.#hide();
  }

  #hide() {
    for (const part of this.#look.hidden) for (const each of this.#partsOf(part)) each.visible = false;
  }

  /** What of the person is a part of the scene, without spheres.
   *  @param {import('./scene_parts.js').ScenePart} part
   *  @returns {THREE.Object3D[]} */
  #partsOf(part) {
    switch (part) {
      case 'body': return [...this.#links, ...this.#skin?.meshes ?? []];
      case 'shadows': return this.#skin?.shadows ?? [];
      case 'com': return [this.#marks.com];
      case 'cop': return [this.#marks.cop];
      case 'support': return [this.#marks.support];
      case 'forces': return [this.forces.group];
      case 'hand_loads': return this.#held;
      default: return [];
    }
  }

  /** @param {HumanLook} look  from the next update on */
  setLook(look) {
    this.#look = look;
  }

  /** Whether nothing of the body is still to be loaded. */
  get isComplete() {
    return this.#loading === 0 && (this.#skin?.isComplete ?? true);
  }

  get hasSkin() {
    return this.#skin?.isLoaded ?? false;
  }

  /** @param {boolean} isCoarse  whether a skin of fewer triangles will do */
  setCoarse(isCoarse) {
    this.#skin?.setCoarse(isCoarse);
  }

  /** Before it is drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    this.#skin?.pose(renderer);
  }

  dispose() {
    this.#skin?.dispose();
    this.#spheres.dispose();
    this.#marks.dispose();
    this.group.removeFromParent();
    this.group.traverse((part) => {
      if (hasGeometry(part) && !SHARED.has(part.geometry)) part.geometry.dispose();
    });
    for (const { material } of this.#materials.values()) material.dispose();
  }

  /** @param {string} url
   *  @param {() => void} onChange */
  #loadSkin(url, onChange) {
    const onFail = (/** @type {string} */ failed) => {
      this.failedMeshes.push(failed);
      onChange();
    };
    const skin = new SkinLevels(url, this.palette, { opacity: this.opacity, isGhost: this.isGhost }, {
      onFail,
      onLoad: () => {
        if (this.#last) {
          this.#updateSpheres(this.#last.person, this.#last.isLive);
          this.#hide();
        }
        onChange();
      },
    });
    this.group.add(skin.group);
    return skin;
  }

  /** That replaces those of body and clothes; null: none.
   *  @param {boolean} isLive */
  #bodyColor(isLive) {
    const { on_light: onLight, on_dark: onDark } = this.palette.ghost;
    if (this.isGhost) return toColor(theme?.name === 'dark' ? onDark : onLight);
    if (!isLive) return this.staleColor;
    return this.#look.style === 'clay' ? this.clayColor : null;
  }

  /** Of that color. */
  get #colorShare() {
    return this.isGhost ? this.palette.ghost.share : 1;
  }

  /** @param {{person: import('./state_codec.js').Person, isLive: boolean, floor: number}} last */
  #updateSkin({ person, isLive, floor }) {
    const loads = this.#look.loads === 'spheres' ? null
      : person.loads.map(({ joint, loadClass }) => ({ joint, loadClass: isLive ? loadClass : /** @type {const} */ ('unknown') }));
    this.#skin?.update({ links: person.links, floor, color: this.#bodyColor(isLive), share: this.#colorShare, loads });
  }

  /** Of loads, which people without a skin keep, and of the CoM.
   *  @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive */
  #updateSpheres({ loads, com }, isLive) {
    const { hidden } = this.#look, { classes, com: color } = this.palette;
    const hasLoads = (!this.hasSkin || this.#look.loads !== 'skin') && !hidden.includes('loads');
    const spheres = !hasLoads ? [] : loads.map(({ joint, loadClass, position, radius }) => {
      const known = isLive ? loadClass : 'unknown', look = classes.find(({ name }) => name === known);
      return { center: position, radius, depth: this.#sizes.depths[joint], color: look?.color ?? [0, 0, 0], rim: look?.rim ?? 0 };
    });
    const { com: radius, com_depth: depth } = this.#sizes;
    if (com && isLive && !hidden.includes('com')) spheres.push({ center: com, radius, depth, color, rim: 0 });
    this.#spheres.show(spheres);
  }

  /** @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive */
  #updateHeld({ held }, isLive) {
    while (this.#held.length < held.length) {
      const mesh = new THREE.Mesh(unitBox, this.markers.held);
      this.#held.push(mesh);
      this.group.add(mesh);
    }
    this.#held.forEach((mesh, i) => {
      const solid = held[i];
      mesh.visible = solid !== undefined;
      if (!solid) return;
      mesh.castShadow = !this.hasSkin;  // a skin has a soft shadow, as in the server's pictures
      mesh.material = isLive ? this.markers.held : this.markers.staleHeld;
      mesh.geometry = solid.kind === 'box' ? unitBox : unitCylinder;
      mesh.position.fromArray(solid.position);
      mesh.quaternion.fromArray(solid.quaternion);
      mesh.scale.fromArray(solid.size);
    });
  }

  /** @param {THREE.Group} link
   *  @param {Visual} visual
   *  @param {() => void} onChange */
  #addVisual(link, visual, onChange) {
    const part = new THREE.Group();
    part.position.fromArray(visual.position);
    part.quaternion.fromArray(visual.quaternion);
    link.add(part);
    const material = this.#materialOf(visual);
    const put = (/** @type {THREE.BufferGeometry} */ geometry) => {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.castShadow = true;  // only onto the floor: on the body itself shadows would disturb the shading
      part.add(mesh);
    };
    if (visual.kind !== 'mesh' || !visual.mesh) return put(primitive(visual));
    part.scale.fromArray(visual.size);
    ++this.#loading;
    // The server sends an absolute path; the page may be served below another path.
    new STLLoader().load(visual.mesh.slice(1), (geometry) => {
      put(toCreasedNormals(geometry, CREASE));
      --this.#loading;
      onChange();
    }, undefined, () => {
      // A missing mesh is replaced by a small sphere at its link and reported by name.
      part.scale.setScalar(1);
      put(new THREE.SphereGeometry(0.04, 16, 12));
      this.failedMeshes.push(/** @type {string} */ (visual.mesh));
      --this.#loading;
      onChange();
    });
  }

  /** @param {Visual} visual */
  #materialOf(visual) {
    const rgba = visual.rgba ?? this.palette.body;
    const key = rgba.join();
    const known = this.#materials.get(key);
    if (known) return known.material;
    const live = toColor(rgba);
    const material = new THREE.MeshStandardMaterial({ color: live.clone(), roughness: 0.82 });
    const opacity = (rgba[3] ?? 1) * this.opacity;
    if (opacity < 1) Object.assign(material, { transparent: true, opacity });
    this.#materials.set(key, { material, live });
    return material;
  }
}

/** @param {Visual} visual */
function primitive({ kind, size }) {
  if (kind === 'box') return new THREE.BoxGeometry(size[0], size[1], size[2]);
  if (kind === 'sphere') return new THREE.SphereGeometry(size[0], 32, 20);
  // A URDF cylinder lies along z, one of three.js along y.
  return new THREE.CylinderGeometry(size[0], size[0], size[1], 32).rotateX(Math.PI / 2);
}
