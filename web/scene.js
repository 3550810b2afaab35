// The 3-D view: camera, lights, floor and people. It is drawn only after a change.
// World frame: z up, metres.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { OWN_CAMERA, ownAim } from './cameras.js';
import { FLOOR_LAYER } from './floor_shadow.js';
import { watchFreeArea } from './free_area.js';
import { makeMarkerMaterials } from './human.js';
import { ImageViews } from './image_views.js';
import { LiveCamera } from './live_camera.js';
import { ObjectMarkers } from './objects.js';
import { placeText, shifted, turned, zoomed } from './orbit.js';
import { People } from './people.js';
import { Quality, REST_MILLIS } from './quality.js';
import { Surroundings } from './surroundings.js';
import { theme } from './theme.js';
import { Trails } from './trails.js';

const FOLLOW_SECONDS = 0.35;  // time constant with which the view follows a walking person
// Until the server has sent its cameras.
const START_POSITION = [3.6, -2.8, 2.2];
const START_TARGET = [0, 0, 1];
const HEAD = 6;  // number of its link
const HEAD_TOP = 0.3;  // m above its joint, with some air
const DISTANCES = { least: 0.6, most: 30 };  // m, from the target
const LEAST_STEP = 1e-5;  // m
const FAR = 80, FOG = { near: 7, far: 15 };  // m, of scenes with people

export class Scene {
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(30, 1, 0.05, FAR);
  #floor = new THREE.Group();  // follows the people in whole metres, so that it appears endless
  #sun = new THREE.DirectionalLight(0xffffff, 2.3);
  #sky = new THREE.HemisphereLight(0xffffff, 0x8a8f98, 2);
  #shade = new THREE.Mesh(new THREE.PlaneGeometry(5, 5), new THREE.ShadowMaterial());
  #grid = new THREE.LineSegments(gridGeometry(12, 0.5), new THREE.LineBasicMaterial());
  #people = new People(() => { this.#dirty = true; });
  #ghosts = new People(() => { this.#dirty = true; });  // reference poses
  #trails = new Trails();
  #surroundings = new Surroundings(() => { this.#dirty = true; });
  #markers = /** @type {ReturnType<typeof makeMarkerMaterials>|null} */ (null);
  #objects = /** @type {ObjectMarkers|null} */ (null);
  #objectNames = /** @type {import('./messages.js').ObjectName[]} */ ([]);
  #middle = [0, 0, 0];  // of the people on the floor
  #liveCamera = new LiveCamera();
  #imageViews = new ImageViews();
  #followed = [0, 0, 0];  // the middle that the view has reached
  #isFollowing = false;
  #stillness = matchMedia('(prefers-reduced-motion: reduce)');  // the view then goes at once where it is to be
  #view = /** @type {import('./messages.js').CameraView|null} */ (null);  // null: selected by hand, or not received yet
  #framing = /** @type {import('./messages.js').Framing|null} */ (null);
  #cameraBase = /** @type {import('./state_codec.js').Pose|null} */ (null);
  /** @type {{character: number, position: number[]}[]} */ #heads = [];
  /** @type {import('./orbit.js').Place|null} */ #placeWanted = null;  // until the people are there
  #hasExtent = false;  // there was a scene without people
  #isSeen = true;
  #dirty = true;
  #lastFrameAt = 0;
  #drawnAt = 0;
  #drawnReductions = 0;  // of the frame that is seen
  #quality = new Quality(new URLSearchParams(location.search).has('quality'));

  /** @param {HTMLElement} host  filled with a canvas
   *  @param {HTMLElement[]} overlays  what lies over it, which people should not be under
   *  @param {{onOrbit: () => void}} events  onOrbit: called when the user moves the camera by hand
   *  @throws if WebGL is not available */
  constructor(host, overlays, events) {
    this.host = host;
    this.renderer = makeRenderer();
    host.append(this.renderer.domElement);
    this.#camera.up.set(0, 0, 1);  // before the controls are created: they take their axis from it
    this.#camera.position.fromArray(START_POSITION);
    this.controls = makeControls(this.#camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => { this.#dirty = true; });
    this.events = events;
    this.controls.addEventListener('start', () => this.#leaveView());
    this.#buildStage();
    new ResizeObserver(() => this.#resize()).observe(host);
    watchFreeArea(host, overlays, (area) => {
      this.#liveCamera.setArea(area);
      this.#aim();
    });
    theme?.follow(() => this.#applyTheme());
    this.#applyTheme();
    this.#resize();
  }

  /** Sets the bodies of the people; called again whenever a revision changes.
   *  @param {import('./messages.js').Model} model */
  setModel(model) {
    this.#markers ??= makeMarkerMaterials(model.palette);
    if (this.#objects === null) {
      this.#objects = new ObjectMarkers(model.palette, this.#camera.fov);
      this.#objects.setNames(this.#objectNames);
      this.#scene.add(this.#objects.group);
    }
    const isGhost = (/** @type {import('./messages.js').PersonModel} */ person) => person.ghost_opacity !== null;
    this.#liveCamera.setOutlines(model.people);
    this.#aim();
    this.#people.setModels(model.people.filter((person) => !isGhost(person)), model.palette, this.#markers);
    this.#ghosts.setModels(model.people.filter(isGhost), model.palette, this.#markers);
    this.#dirty = true;
  }

  /** Another server has other bodies and markers under the same revisions. */
  forget() {
    this.#people.clear();
    this.#ghosts.clear();
    this.#surroundings.forget();
    this.#dirty = true;
  }

  /** @param {import('./messages.js').Look & {hidden: import('./scene_parts.js').ScenePart[]}} look  from the next update
   *    on */
  setLook(look) {
    this.#people.setLook(look);
    this.#surroundings.hide(look.hidden);
    if (this.#objects !== null) this.#objects.group.visible = !look.hidden.includes('objects');
    if (look.hidden.includes('shadows')) this.#shade.visible = false;
    this.#trails.setLook(look.trails, look.trail_secs);
  }

  /** Whether any person is drawn as a skin. */
  get hasSkins() {
    return this.#people.hasSkins;
  }

  get canvas() {
    return this.renderer.domElement;
  }

  /** @param {boolean} isOn  whether the camera can be moved, by pointer and keys */
  setControls(isOn) {
    this.controls.enabled = isOn;
    this.canvas.tabIndex = isOn ? 0 : -1;
    this.canvas.setAttribute('role', isOn ? 'application' : 'img');
    this.canvas.ariaLabel = `The people in the stream, in 3-D${isOn ? ': arrows turn the view, + and − zoom' : ''}`;
  }

  /** @param {import('./state_codec.js').Person} person */
  hasModelOf(person) {
    return [this.#people, this.#ghosts].some((people) => people.has(person.character, person.revision));
  }

  get failedMeshes() {
    return this.#people.failedMeshes;
  }

  /** Sets the names of tracked objects.
   *  @param {import('./messages.js').ObjectName[]} names */
  setObjectNames(names) {
    this.#objectNames = names;
    this.#objects?.setNames(names);
    this.#dirty = true;
  }

  /** External markers and robots.
   *  @param {number|null} revision  null: none
   *  @param {number|null} former  number of the former state that is shown; null: the newest one is
   *  @param {number} now */
  updateSurroundings(revision, former, now) {
    this.#surroundings.update(revision, former, now);
  }

  /** What is not shown as it should be, one line each. */
  get problems() {
    return this.#surroundings.problems;
  }

  /** @param {import('./state_codec.js').State} state
   *  @param {boolean} isLive */
  update(state, isLive) {
    this.#people.update(state, isLive);
    this.#ghosts.update({ ...state, people: state.ghosts }, isLive);
    this.#trails.update(state);
    this.#objects?.update(state.objects, isLive);
    this.#surroundings.place(state.robots);
    this.#cameraBase = state.cameraBase;
    if (state.people.length > 0) {
      this.#makeRoom(0);
      this.#middle = this.#liveCamera.setState(state, this.#framing?.reach_m ?? Infinity);
      this.#aim();
    } else if (state.extent !== null) {
      const { min, max } = state.extent;
      this.#hasExtent = true;
      this.#makeRoom(Math.hypot(...max.map((v, i) => v - min[i])));
      this.#followed = this.#middle = [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2, state.floor];
      this.#liveCamera.setExtent(state.extent);
      this.#aim();
    } else if (this.#isOwn) {
      this.#aim();
    }
    this.#heads = state.people.filter(({ links }) => links.length > HEAD)
      .map(({ character, links }) => ({ character, position: links[HEAD].position }));
    this.#dirty = true;
  }

  /** @param {import('./messages.js').CameraView} view
   *  @param {import('./messages.js').Framing} framing */
  setView(view, framing) {
    this.#view = view;
    this.#framing = framing;
    this.#placeWanted = null;
    this.#followed = this.#middle;
    this.#liveCamera.cut();
    this.#aim();
  }

  /** Where the camera is, for the address; null: it shows a named view. */
  get placeText() {
    if (this.#view !== null) return null;
    return placeText({ position: this.#camera.position.toArray(), target: this.controls.target.toArray() }, this.#followed);
  }

  /** As if the viewer had moved the camera there.
   *  @param {import('./orbit.js').Place} place  from the middle of the people on the floor
   *  @param {import('./messages.js').CameraView} view  whose field of view it has
   *  @param {import('./messages.js').Framing} framing */
  setPlace(place, view, framing) {
    this.setView(view, framing);
    this.#placeWanted = place;
    this.#takePlace();
  }

  #takePlace() {
    if (this.#placeWanted === null || (this.#people.size === 0 && !this.#hasExtent)) return;
    const { position, target } = this.#placeWanted;
    this.#followed = this.#middle;
    this.#leaveView();
    this.#move({ position: position.map((v, i) => v + this.#followed[i]), target: target.map((v, i) => v + this.#followed[i]) });
  }

  /** Whether the view is that of the server's own camera: it does not go with the people. */
  get #isOwn() {
    return this.#view?.name === OWN_CAMERA;
  }

  /** The viewer moves the camera by hand: it is no named view any more. */
  #leaveView() {
    this.#camera.up.set(0, 0, 1);
    this.#view = null;
    this.#placeWanted = null;
    this.events.onOrbit();
  }

  /** @param {import('./orbit.js').Place} place */
  #move({ position, target }) {
    this.#camera.position.fromArray(position);
    this.controls.target.fromArray(target);
    this.controls.update();
    this.#dirty = true;
  }

  /** @param {(place: import('./orbit.js').Place) => import('./orbit.js').Place} change */
  #moveByKey(change) {
    this.#leaveView();
    this.#move(change({ position: this.#camera.position.toArray(), target: this.controls.target.toArray() }));
  }

  /** @param {number} azimuth  rad
   *  @param {number} elevation  rad */
  turn(azimuth, elevation) {
    this.#moveByKey((place) => turned(place, azimuth, elevation));
  }

  /** @param {number} factor  of the distance */
  zoom(factor) {
    this.#moveByKey((place) => zoomed(place, factor, DISTANCES));
  }

  /** @param {number} right  share of the distance
   *  @param {number} up */
  shift(right, up) {
    this.#moveByKey((place) => shifted(place, right, up));
  }

  /** Where the tops of the heads are in the view, px; without those behind the camera.
   *  @returns {import('./head_names.js').Head[]} */
  heads() {
    const { clientWidth: width, clientHeight: height } = this.host;
    return this.#heads.flatMap(({ character, position: [x, y, z] }) => {
      const at = new THREE.Vector3(x, y, z + HEAD_TOP).project(this.#camera);
      return at.z < 1 ? [{ character, x: (at.x + 1) / 2 * width, y: this.host.offsetTop + (1 - at.y) / 2 * height }] : [];
    });
  }

  /** Whether it stays as it is drawn until another state comes.
   *  @param {number|null} surroundings  revision of those that are to be shown */
  isAtRest(surroundings) {
    const isDrawn = !this.#isSeen || (!this.#dirty && !this.#isFollowing && this.#drawnReductions === 0);
    return isDrawn && this.#imageViews.isAtRest && this.#people.isComplete && this.#ghosts.isComplete
      && this.#surroundings.isAt(surroundings);
  }

  /** The scene is drawn over these images, too.
   *  @param {import('./image_views.js').ImageView[]} views */
  setImageViews(views) {
    if (this.#imageViews.set(views)) this.#dirty = true;
  }

  /** Draws the view if anything has changed since the last call.
   *  @param {number} now  time of requestAnimationFrame, ms
   *  @returns {boolean} whether it drew */
  draw(now) {
    const elapsed = now - this.#lastFrameAt;
    this.#follow(elapsed / 1000);
    this.controls.update();
    this.#lastFrameAt = now;
    const isToBeRefined = this.#drawnReductions > 0 && now - this.#drawnAt >= REST_MILLIS;
    if (!(this.#dirty || isToBeRefined || this.#imageViews.isDue(now)) || !this.#isSeen) return false;
    if (this.#dirty) this.#quality.measure(elapsed);
    this.#reduce(this.#dirty ? this.#quality.reductions : 0);
    this.#dirty = false;
    this.#drawnAt = now;
    this.#takePlace();
    this.#people.pose(this.renderer);
    this.#ghosts.pose(this.renderer);
    this.#imageViews.draw(this.renderer, this.#scene, now);
    this.renderer.render(this.#scene, this.#camera);
    return true;
  }

  /** Moves the camera to the named view, if there is one. */
  #aim() {
    if (this.#view === null || this.#framing === null) return;
    const { position, target, up, fovDegrees } = this.#isOwn ? ownAim(this.#view, this.#cameraBase, DISTANCES)
      : { ...this.#liveCamera.aim(this.#view, this.#followed), up: [0, 0, 1] };
    if (this.#camera.fov !== fovDegrees) {
      this.#camera.fov = fovDegrees;
      this.#objects?.setFieldOfView(fovDegrees);
      this.#camera.updateProjectionMatrix();
    }
    this.#camera.up.fromArray(up);
    this.#camera.position.fromArray(position);
    this.controls.target.fromArray(target);
    this.controls.update();
    this.#placeFloor();
    this.#dirty = true;
  }

  /** Neither the background nor the far plane hides a scene that is larger than people need.
   *  @param {number} size  its diagonal, m; 0: as people need it */
  #makeRoom(size) {
    const farthest = 8 * size;  // how far away a narrow view stands, with what is behind
    if (this.#scene.fog instanceof THREE.Fog) {
      this.#scene.fog.near = Math.max(FOG.near, farthest);
      this.#scene.fog.far = Math.max(FOG.far, 2 * farthest);
    }
    const far = Math.max(FAR, 2 * farthest);
    this.controls.maxDistance = Math.max(DISTANCES.most, farthest);
    this.controls.minDistance = size > 0 ? Math.min(DISTANCES.least, size) : DISTANCES.least;
    if (this.#camera.far === far) return;
    this.#camera.far = far;
    this.#camera.updateProjectionMatrix();
  }

  /** @param {number} seconds  since the last frame */
  #follow(seconds) {
    const share = this.#stillness.matches ? 1 : 1 - Math.exp(-Math.min(seconds, 1) / FOLLOW_SECONDS);
    const step = this.#middle.map((v, i) => share * (v - this.#followed[i]));
    this.#isFollowing = Math.hypot(...step) >= LEAST_STEP;
    if (!this.#isFollowing) return;
    if (share === 1 && this.#view !== null) {
      this.#followed = this.#middle;
      return this.#aim();
    }
    this.#followed = this.#followed.map((v, i) => v + step[i]);
    if (this.#isOwn) return this.#placeFloor();
    const shift = new THREE.Vector3().fromArray(step);
    this.#camera.position.add(shift);
    this.controls.target.add(shift);
    this.#placeFloor();
    this.#dirty = true;
  }

  #placeFloor() {
    const [x, y, z] = this.#followed;
    this.#floor.position.set(Math.round(x), Math.round(y), z);
    this.#sun.position.set(x + 1.5, y - 1.2, z + 4);
    this.#sun.target.position.set(x, y, z + 0.6);
    this.#sun.target.updateMatrixWorld();
  }

  #buildStage() {
    const shadow = this.#sun.shadow;
    this.#sun.castShadow = true;
    shadow.mapSize.set(1024, 1024);
    Object.assign(shadow.camera, { left: -2, right: 2, top: 2, bottom: -2, near: 0.5, far: 8 });
    shadow.radius = 5;
    shadow.normalBias = 0.02;
    const fill = new THREE.DirectionalLight(0xdfe8ff, 0.55);
    fill.position.set(-3, 3, 2);
    this.#scene.add(this.#sky, this.#sun, this.#sun.target, fill, this.#floor, this.#people.group, this.#ghosts.group,
      this.#trails.group, this.#surroundings.group);
    this.#shade.receiveShadow = true;
    this.#shade.material.depthWrite = false;  // the shadow lies on the grid and must not hide it
    this.#grid.material.depthWrite = false;  // so that a map on it is not hidden
    this.#grid.position.z = -0.002;
    this.#floor.add(this.#shade, this.#grid);
    for (const each of this.#floor.children) each.layers.set(FLOOR_LAYER);
    this.#camera.layers.enable(FLOOR_LAYER);
    this.#placeFloor();
  }

  /** The style sheet has the colours and intensities of both colour schemes. */
  #applyTheme() {
    const style = getComputedStyle(this.host);
    const valueOf = (/** @type {string} */ property) => style.getPropertyValue(property).trim();
    const background = new THREE.Color(valueOf('--scene'));
    this.#scene.background = background;
    this.#surroundings.setBackground(background);
    this.#scene.fog = new THREE.Fog(background, FOG.near, FOG.far);
    this.#sky.intensity = Number(valueOf('--scene-sky'));
    this.#shade.material.opacity = Number(valueOf('--scene-shadow'));
    this.#grid.material.color.set(valueOf('--scene-line'));
    this.#dirty = true;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    this.#isSeen = width > 0 && height > 0;
    if (!this.#isSeen) return;
    this.renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#liveCamera.setAspect(width / height);
    this.#aim();
    this.#dirty = true;
  }

  /** Draws with so many reductions of quality, of which each saves time.
   *  @param {number} count */
  #reduce(count) {
    if (count === this.#drawnReductions) return;
    this.#drawnReductions = count;
    this.#people.setCoarse(count > 0);
    this.#ghosts.setCoarse(count > 0);
    this.#sun.castShadow = count < 2;
    this.#shade.visible = count < 2;
    this.renderer.setPixelRatio(count >= 3 ? 0.7 : count >= 1 ? 1 : Math.min(devicePixelRatio, 2));
  }
}

/** @throws if WebGL is not available */
function makeRenderer() {
  const isSoftware = drawsInSoftware();
  const renderer = new THREE.WebGLRenderer({ antialias: !isSoftware });
  renderer.shadowMap.enabled = !isSoftware;
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  return renderer;
}

/** @param {THREE.Camera} camera
 *  @param {HTMLCanvasElement} canvas */
function makeControls(camera, canvas) {
  const controls = new OrbitControls(camera, canvas);
  controls.target.fromArray(START_TARGET);
  controls.enableDamping = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  controls.minDistance = DISTANCES.least;
  controls.maxDistance = DISTANCES.most;
  return controls;
}

/** Grid lines every `step` from -half to half, in pieces of that length: some drivers drop a line that extends behind
 *  the camera.
 *  @param {number} half
 *  @param {number} step */
function gridGeometry(half, step) {
  const points = [];
  for (let a = -half; a <= half; a += step) {
    for (let b = -half; b < half; b += step) {
      points.push(a, b, 0, a, b + step, 0, b, a, 0, b + step, a, 0);
    }
  }
  return new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
}

/** Whether WebGL is rendered in software (in a virtual machine, on a remote desktop). Antialiasing and shadows would
 *  then cost most of the frame rate. */
function drawsInSoftware() {
  if (new URLSearchParams(location.search).get('quality') === 'fine') return false;  // for screenshots of documents
  const gl = document.createElement('canvas').getContext('webgl2');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl?.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) ?? '');
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
