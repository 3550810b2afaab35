// The person in the view: the skin, the links of /api/v1/model at the streamed poses, load spheres, CoM, CoP, support
// polygon, ground reaction forces and hand loads. World frame: z up, metres.
import * as THREE from 'three';
import { STLLoader } from 'three/addons/loaders/STLLoader.js';
import { toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import { toColor } from './colors.js';
import { ARROW_SHAPES, ForceArrows, makeArrowMaterials, OCCLUDED_OPACITY } from './force_arrows.js';
import { request } from './server_api.js';
import { SkinnedBody } from './skin.js';
import { readSkin } from './skin_buffer.js';
import { theme } from './theme.js';

const SPHERE_DEPTH = 0.11;      // m, by which a sphere counts as nearer than its joint's centre
const RIM = 1.14;               // radius of the dark rim of the class "high", as a multiple of the sphere's radius
const CREASE = 0.7;             // rad; edges with a smaller angle are shaded smooth
const MARKER_LIFT = 0.004;      // m above the floor, so that disc and floor do not flicker
const SUPPORT_LIFT = 0.003;     // m above the floor; the support polygon is below the markers

const unitSphere = new THREE.SphereGeometry(1, 32, 20);
// Shapes of hand loads, scaled to their sizes.
const unitBox = new THREE.BoxGeometry(1, 1, 1);
const unitCylinder = new THREE.CylinderGeometry(1, 1, 1, 32).rotateX(Math.PI / 2);
/** @type {Set<THREE.BufferGeometry>} */
const SHARED = new Set([unitSphere, unitBox, unitCylinder, ...ARROW_SHAPES]);

/** @typedef {import('./messages.js').Visual} Visual
 *  @typedef {import('./messages.js').Palette} Palette
 *  @typedef {Pick<import('./messages.js').Look, 'loads'|'style'> & {hidden: import('./scene_parts.js').ScenePart[]}} HumanLook */

/** Makes what `material` draws count as nearer by `depth` than its centre: a load sphere is drawn over the limb around
 *  it, and is hidden by other limbs.
 *  @template {THREE.Material} T
 *  @param {T} material
 *  @param {number} depth  m
 *  @returns {T} */
function nearer(material, depth) {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <project_vertex>', `#include <project_vertex>
      vec3 center = modelViewMatrix[3].xyz;
      vec4 before = projectionMatrix * vec4(center * (1.0 - ${depth.toFixed(4)} / length(center)), 1.0);
      gl_Position.z = before.z / before.w * gl_Position.w;`);
  };
  material.customProgramCacheKey = () => `nearer ${depth}`;
  return material;
}

/** Two materials: opaque where the marker is unobstructed, and translucent without depth test, so that it is visible
 *  through the body.
 *  @param {THREE.Color} color */
function makeMarkerMaterial(color) {
  const solid = nearer(new THREE.MeshStandardMaterial({ color, roughness: 0.55 }), SPHERE_DEPTH);
  const occluded = new THREE.MeshBasicMaterial({
    color, transparent: true, opacity: OCCLUDED_OPACITY, depthTest: false, depthWrite: false,
  });
  return { solid, occluded };
}

/** @param {THREE.BufferGeometry} geometry
 *  @param {ReturnType<typeof makeMarkerMaterial>} materials */
function markerMesh(geometry, materials) {
  const group = new THREE.Group();
  const solid = new THREE.Mesh(geometry, materials.solid);
  const occluded = new THREE.Mesh(geometry, materials.occluded);
  occluded.renderOrder = 10;
  group.add(solid, occluded);
  return group;
}

/** Materials of the markers, shared by all people.
 *  @param {Palette} palette */
export function makeMarkerMaterials(palette) {
  return {
    classes: Object.fromEntries(
      palette.classes.map(({ name, color }) => [name, makeMarkerMaterial(toColor(color))])),
    rim: nearer(new THREE.MeshBasicMaterial({ color: 0x2a0608, side: THREE.BackSide }), SPHERE_DEPTH - 0.01),
    com: makeMarkerMaterial(toColor(palette.com)),
    cop: new THREE.MeshBasicMaterial({ color: toColor(palette.cop) }),
    force: makeArrowMaterials(toColor(palette.cop)),
    line: new THREE.LineBasicMaterial({ color: toColor(palette.com) }),
    support: new THREE.LineBasicMaterial({ color: toColor(palette.support) }),
    held: new THREE.MeshStandardMaterial({ color: toColor(palette.held), roughness: 0.6 }),
  };
}

/** @param {THREE.Object3D} part
 *  @returns {part is THREE.Mesh|THREE.Line} */
const hasGeometry = (part) => part instanceof THREE.Mesh || part instanceof THREE.Line;

export class Human {
  group = new THREE.Group();
  /** @type {string[]} */ failedMeshes = [];
  #loading = 0;  // meshes and skins under way
  #skin = /** @type {SkinnedBody|null} */ (null);
  #isDisposed = false;
  #look;
  #last = /** @type {{person: import('./state_codec.js').Person, isLive: boolean, floor: number}|null} */ (null);
  #links = /** @type {THREE.Group[]} */ ([]);
  #materials = /** @type {Map<string, {material: THREE.MeshStandardMaterial, live: THREE.Color}>} */ (new Map());
  #held = /** @type {THREE.Mesh[]} */ ([]);
  #spheres = /** @type {Map<number, {group: THREE.Group, rim: THREE.Mesh}>} */ (new Map());

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
    this.ghostOpacity = model.ghost_opacity;  // null: a person of the stream
    this.staleColor = toColor(palette.stale_body);
    this.clayColor = toColor(palette.clay);
    for (const link of model.links) {
      const group = new THREE.Group();
      for (const visual of link.visuals) this.#addVisual(group, visual, onChange);
      this.#links.push(group);
      this.group.add(group);
    }
    if (model.skin !== null) this.#loadSkin(model.skin, onChange);
    this.com = markerMesh(unitSphere, markers.com);
    this.com.scale.setScalar(0.03);
    this.comLine = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, -1)]), markers.line);
    this.comRing = new THREE.Mesh(new THREE.RingGeometry(0.035, 0.045, 40), markers.com.solid);
    this.cop = new THREE.Mesh(new THREE.CircleGeometry(0.04, 40), markers.cop);
    this.support = new THREE.LineLoop(new THREE.BufferGeometry(), markers.support);
    this.forces = new ForceArrows(markers.force);
    this.group.add(this.com, this.comLine, this.comRing, this.cop, this.support, this.forces.group);
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
    this.#updatePoints(person, isLive, floor);
    this.#updateSupport(person, isLive, floor);
    this.forces.update(isLive ? person.feet : []);
    this.#updateHeld(person);
    this.#hide();
  }

  #hide() {
    for (const part of this.#look.hidden) for (const each of this.#partsOf(part)) each.visible = false;
  }

  /** What of the person is a part of the scene.
   *  @param {import('./scene_parts.js').ScenePart} part
   *  @returns {THREE.Object3D[]} */
  #partsOf(part) {
    switch (part) {
      case 'body': return [...this.#links, ...this.#skin?.bodies ?? []];
      case 'shadows': return this.#skin?.shadows ?? [];
      case 'loads': return [...this.#spheres.values()].map(({ group }) => group);
      case 'com': return [this.com, this.comLine, this.comRing];
      case 'cop': return [this.cop];
      case 'support': return [this.support];
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
    return this.#loading === 0;
  }

  get hasSkin() {
    return this.#skin !== null;
  }

  /** Before it is drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    this.#skin?.pose(renderer);
  }

  dispose() {
    this.#isDisposed = true;
    this.#skin?.dispose();
    this.group.removeFromParent();
    this.group.traverse((part) => {
      if (hasGeometry(part) && !SHARED.has(part.geometry)) part.geometry.dispose();
    });
    for (const { material } of this.#materials.values()) material.dispose();
  }

  /** @param {string} url  an absolute path; the page may be served below another path
   *  @param {() => void} onChange */
  async #loadSkin(url, onChange) {
    ++this.#loading;
    try {
      const answer = await request(url.slice(1));
      const skin = readSkin(await answer.arrayBuffer(), url);
      if (this.#isDisposed) return;
      this.#skin = new SkinnedBody(skin, this.palette, this.ghostOpacity);
      if (this.#last) {
        this.#updateSkin(this.#last);
        this.#updateSpheres(this.#last.person, this.#last.isLive);
        this.#hide();
      }
      this.group.add(this.#skin.group);
    } catch {
      this.failedMeshes.push(url);
    } finally {
      --this.#loading;
    }
    onChange();
  }

  /** That replaces those of body and clothes; null: none.
   *  @param {boolean} isLive */
  #bodyColor(isLive) {
    const { on_light: onLight, on_dark: onDark } = this.palette.ghost;
    if (this.ghostOpacity !== null) return toColor(theme?.name === 'dark' ? onDark : onLight);
    if (!isLive) return this.staleColor;
    return this.#look.style === 'clay' ? this.clayColor : null;
  }

  /** Of that color. */
  get #colorShare() {
    return this.ghostOpacity === null ? 1 : this.palette.ghost.share;
  }

  /** @param {{person: import('./state_codec.js').Person, isLive: boolean, floor: number}} last */
  #updateSkin({ person, isLive, floor }) {
    this.#skin?.update(person.links, floor, this.#bodyColor(isLive), this.#colorShare);
    const isOnSkin = this.#look.loads !== 'spheres';
    this.#skin?.showLoads(isOnSkin ? person.loads.map(({ joint, loadClass }) =>
      ({ joint, loadClass: isLive ? loadClass : 'unknown' })) : null);
  }

  /** People without a skin keep them.
   *  @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive */
  #updateSpheres(person, isLive) {
    const hasSpheres = this.#skin === null || this.#look.loads !== 'skin';
    for (const load of person.loads) {
      const sphere = this.#spheres.get(load.joint) ?? this.#addSphere(load.joint);
      const loadClass = isLive ? load.loadClass : 'unknown';
      const { solid, occluded } = this.markers.classes[loadClass];
      const [front, through] = sphere.group.children[0].children;
      /** @type {THREE.Mesh} */ (front).material = solid;
      /** @type {THREE.Mesh} */ (through).material = occluded;
      sphere.rim.visible = loadClass === 'high';
      sphere.group.position.fromArray(load.position);
      sphere.group.scale.setScalar(load.radius);
    }
    for (const [joint, { group }] of this.#spheres) {
      group.visible = hasSpheres && person.loads.some((load) => load.joint === joint);
    }
  }

  /** @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive
   *  @param {number} floor */
  #updatePoints(person, isLive, floor) {
    const { com, cop } = person;
    for (const part of [this.com, this.comLine, this.comRing]) part.visible = com !== null && isLive;
    this.cop.visible = cop !== null && isLive;
    if (com) {
      this.com.position.fromArray(com);
      this.comLine.position.fromArray(com);
      this.comLine.scale.z = Math.max(0.001, com[2] - floor);
      this.comRing.position.set(com[0], com[1], floor + MARKER_LIFT);
    }
    if (cop) this.cop.position.set(cop[0], cop[1], cop[2] + MARKER_LIFT / 2);
  }

  /** The support polygon.
   *  @param {import('./state_codec.js').Person} person
   *  @param {boolean} isLive
   *  @param {number} floor */
  #updateSupport({ support }, isLive, floor) {
    this.support.visible = isLive && support.length > 1;
    if (!this.support.visible) return;
    const points = support.map(([x, y]) => new THREE.Vector3(x, y, floor + SUPPORT_LIFT));
    this.support.geometry.dispose();
    this.support.geometry = new THREE.BufferGeometry().setFromPoints(points);
  }

  /** @param {import('./state_codec.js').Person} person */
  #updateHeld({ held }) {
    while (this.#held.length < held.length) {
      const mesh = new THREE.Mesh(unitBox, this.markers.held);
      this.#held.push(mesh);
      this.group.add(mesh);
    }
    this.#held.forEach((mesh, i) => {
      const solid = held[i];
      mesh.visible = solid !== undefined;
      if (!solid) return;
      mesh.castShadow = this.#skin === null;  // a skin has a soft shadow, as in the server's pictures
      mesh.geometry = solid.kind === 'box' ? unitBox : unitCylinder;
      mesh.position.fromArray(solid.position);
      mesh.quaternion.fromArray(solid.quaternion);
      mesh.scale.fromArray(solid.size);
    });
  }

  /** @param {number} joint */
  #addSphere(joint) {
    const group = new THREE.Group();
    const rim = new THREE.Mesh(unitSphere, this.markers.rim);
    rim.scale.setScalar(RIM);
    group.add(markerMesh(unitSphere, this.markers.classes.unknown), rim);
    this.group.add(group);
    const sphere = { group, rim };
    this.#spheres.set(joint, sphere);
    return sphere;
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
    const opacity = (rgba[3] ?? 1) * (this.ghostOpacity ?? 1);
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
