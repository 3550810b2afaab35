// A person as one skinned surface: the vertices, weights and clothes of the server's pictures. World frame: z up,
// metres.
import * as THREE from 'three';
import { toColor } from './colors.js';
import { FloorShadow } from './floor_shadow.js';
import { framesOf } from './skin_frames.js';
import { REGION_FLOATS, regionsOf } from './skin_regions.js';
import { POSED_VERTEX, SkinSurface } from './skin_surface.js';

const ONE = new THREE.Vector3(1, 1, 1);

// As in the server's pictures (render/vtk/skin_actor.cc): light as from a clouded sky, less where limbs cover it, and a
// lamp over the viewer's left shoulder, equal for all channels, because hues carry meaning; colours whose borders are
// distances, crisp at any zoom.
const SUIT = `
  uniform vec3 topColor, trousersColor, shoesColor, bareColor, bandColor;
  uniform float borderStep;
  vec3 paintedColor(vec4 paint) {
    vec4 borders = borderStep * paint;
    vec4 inside = clamp(borders / (fwidth(borders) + 1e-6) + 0.5, 0.0, 1.0);
    vec3 color = mix(topColor, bandColor, inside.w);
    color = mix(color, trousersColor, inside.x);
    color = mix(color, shoesColor, inside.z);
    return mix(color, bareColor, inside.y);
  }`;
// A skin of the user's own has a colour at each vertex, sRGB.
const OWN_COLORS = `
  vec3 paintedColor(vec4 paint) {
    vec3 color = paint.rgb / 255.0;
    return mix(pow((color + 0.055) / 1.055, vec3(2.4)), color / 12.92, step(color, vec3(0.04045)));
  }`;
// A region is as large, and has the rim, that the sphere of its class has; hatched where the class is unknown. The
// result: its colour and its share of the pixel.
const REGIONS = (/** @type {number} */ count) => `
  uniform vec4 regionLook[${count}];
  uniform float regionRim[${count}];
  varying vec3 skinRegion;
  vec4 regionOf(vec3 region) {
    int joint = int(region.y + 0.5);
    vec4 look = regionLook[joint];
    float rim = regionRim[joint];
    float soft = fwidth(region.x) + 1e-6;
    float share = look.a > 1.0 ? 0.0 : clamp((region.x - look.a) / soft + 0.5, 0.0, 1.0);
    float onRim = 1.0 - clamp((region.x - look.a - 0.14) / soft + 0.5, 0.0, 1.0);
    vec3 color = mix(look.rgb, rim > 0.0 ? vec3(0.15, 0.02, 0.02) : vec3(1.0), abs(rim) * onRim);
    float across = region.z / 0.014;
    float stripe = clamp((abs(fract(across) - 0.5) - 0.25) / (fwidth(across) + 1e-6) + 0.5, 0.0, 1.0);
    return vec4(color, share * (rim < 0.0 ? max(stripe, onRim) : 1.0));
  }`;
const HIDDEN = 2;  // further inside than any vertex is
const LIGHT = `
  uniform vec3 overrideColor;
  uniform float overrideShare;
  varying vec4 suitPaint;
  varying vec3 suitNormal;
  varying vec2 suitSky;
  float lightOnSkin(vec3 normal, vec2 sky) {
    float key = max(dot(normal, vec3(-0.439, 0.634, 0.637)) + 0.12, 0.0) / 1.12;
    float fill = max(dot(normal, vec3(0.816, 0.102, 0.569)) + 0.5, 0.0) / 1.5;
    float edge = 1.0 - max(normal.z, 0.0);
    float light = sky.y * (0.44 + 0.20 * sky.x + 0.16 * fill) + (0.35 + 0.65 * sky.y) * 0.50 * key;
    return light * (1.0 - 0.32 * edge * edge * edge);
  }`;

/** @param {{vertexShader: string}} shader
 *  @param {string} declarations  GLSL */
function usePosedVertices(shader, declarations) {
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', `#include <common>${POSED_VERTEX}${declarations}`)
    .replace('#include <begin_vertex>', 'vec3 transformed = posed(posedPositions);');
}

/** @typedef {{opacity: number, isGhost: boolean}} BodyLook  isGhost: it is a reference pose */

export class SkinnedBody {
  /** Of a reference pose: what is in front is drawn into the depth first, so that one layer shines through. */
  group = new THREE.Group();
  mesh;
  #front = /** @type {THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>|null} */ (null);
  #shadow = /** @type {FloorShadow|null} */ (null);  // of a person of the stream
  #rig;
  #surface;
  #fromBind;
  #skin;
  #palette;
  #override = { color: { value: new THREE.Color() }, share: { value: 0 } };
  #regionLook;
  #regionRim;

  /** @param {import('./skin_buffer.js').Skin} skin
   *  @param {import('./messages.js').Palette} palette
   *  @param {BodyLook} [look] */
  constructor(skin, palette, { opacity, isGhost } = { opacity: 1, isGhost: false }) {
    this.#rig = skin.rig;
    this.#skin = skin;
    this.#palette = palette;
    this.#regionLook = { value: skin.rig.regions.shapes.map(() => new THREE.Vector4(0, 0, 0, HIDDEN)) };
    this.#regionRim = { value: skin.rig.regions.shapes.map(() => 0) };
    this.#surface = new SkinSurface(skin);
    this.#fromBind = skin.rig.bind.map(({ position, rotation }) =>
      new THREE.Matrix4().compose(position, rotation, ONE).invert());
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(skin.positions, 3));
    geometry.setAttribute('paint', new THREE.BufferAttribute(skin.paint, 4));
    geometry.setIndex(new THREE.BufferAttribute(skin.triangles, 1));
    this.mesh = new THREE.Mesh(geometry, this.#material(skin));
    this.mesh.frustumCulled = false;  // its bounds move with the frames
    this.group.add(this.mesh);
    if (!isGhost) {
      this.#shadow = new FloorShadow(this.#surface.capsules);
      this.group.add(this.#shadow.mesh);
    }
    if (isGhost || opacity < 1) this.#becomeVeil(skin, opacity);
  }

  /** @param {import('./skin_buffer.js').Skin} skin
   *  @param {number} opacity */
  #becomeVeil(skin, opacity) {
    const front = this.#front = new THREE.Mesh(this.mesh.geometry, this.#material(skin));
    front.material.colorWrite = false;
    front.frustumCulled = false;
    front.renderOrder = 1;
    this.mesh.renderOrder = 2;
    Object.assign(this.mesh.material, { transparent: true, opacity, depthWrite: false });
    this.group.add(front);
  }

  /** @param {import('./skin_frames.js').Pose[]} links  of all links, as they are streamed
   *  @param {number} floor  its height, m
   *  @param {THREE.Color|null} color  instead of those of the suit
   *  @param {number} [share]  of that color */
  update(links, floor, color, share = 1) {
    this.#override.share.value = color ? share : 0;
    if (color) this.#override.color.value = color;
    this.#surface.setPosture(framesOf(this.#rig, links).map(({ position, rotation }, i) =>
      new THREE.Matrix4().compose(position, rotation, ONE).multiply(this.#fromBind[i])), links);
    this.#shadow?.update(floor);
  }

  /** Shows loads as regions around their joints.
   *  @param {{joint: number, loadClass: import('./messages.js').LoadClass}[]|null} loads  null: none, which costs
   *    nothing */
  showLoads(loads) {
    const { shapes } = this.#rig.regions;
    const { material, geometry } = this.mesh;
    const isShown = loads !== null && shapes.length > 0;
    if (isShown && !geometry.hasAttribute('region')) {
      geometry.setAttribute('region', new THREE.BufferAttribute(regionsOf(this.#skin), REGION_FLOATS));
    }
    if (isShown !== ('LOADS_ON_SKIN' in (material.defines ?? {}))) {
      material.defines = isShown ? { LOADS_ON_SKIN: '' } : {};
      material.needsUpdate = true;
    }
    if (!isShown) return;
    shapes.forEach(({ joint }, i) => {
      const load = loads.find((each) => each.joint === joint);
      const look = this.#palette.classes.find(({ name }) => name === load?.loadClass);
      const [red, green, blue] = look?.color ?? [0, 0, 0];
      this.#regionLook.value[i].set(red, green, blue, look ? 1 - look.size : HIDDEN);
      this.#regionRim.value[i] = look?.rim ?? 0;
    });
  }

  get bodies() {
    return this.#front === null ? [this.mesh] : [this.#front, this.mesh];
  }

  get shadows() {
    return this.#shadow === null ? [] : [this.#shadow.mesh];
  }

  /** Before it is drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    this.#surface.pose(renderer);
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.#front?.material.dispose();
    this.#shadow?.dispose();
    this.#surface.dispose();
  }

  /** @param {import('./skin_buffer.js').Skin} skin */
  #material({ rig, colors, borderStep, paint, isTwoSided }) {
    const paintedColor = paint instanceof Int8Array ? SUIT : OWN_COLORS;
    const material = new THREE.MeshBasicMaterial({ side: isTwoSided ? THREE.DoubleSide : THREE.FrontSide });
    material.onBeforeCompile = (shader) => {
      for (const [name, color] of Object.entries(colors)) shader.uniforms[`${name}Color`] = { value: toColor(color) };
      Object.assign(shader.uniforms, this.#surface.uniforms,
        { overrideColor: this.#override.color, overrideShare: this.#override.share, borderStep: { value: borderStep },
          regionLook: this.#regionLook, regionRim: this.#regionRim });
      usePosedVertices(shader, `
        attribute vec4 paint;
        varying vec4 suitPaint;
        varying vec3 suitNormal;
        varying vec2 suitSky;
        #ifdef LOADS_ON_SKIN
          attribute vec3 region;
          varying vec3 skinRegion;
        #endif`);
      shader.vertexShader = shader.vertexShader.replace('#include <project_vertex>', `#include <project_vertex>
        vec3 posedNormal = posed(posedNormals);
        suitPaint = paint;
        suitNormal = mat3(modelViewMatrix) * posedNormal;
        suitSky = vec2(0.5 + 0.5 * posedNormal.z, posed(posedSky).x);
        #ifdef LOADS_ON_SKIN
          skinRegion = region;
        #endif`);
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>${LIGHT}${paintedColor}
          #ifdef LOADS_ON_SKIN
            ${REGIONS(rig.regions.shapes.length)}
          #endif`)
        .replace('#include <color_fragment>', `#include <color_fragment>
          diffuseColor.rgb = mix(paintedColor(suitPaint), overrideColor, overrideShare);`)
        // Between pure hue and full light, as on a sphere: a class reads the same on the dark side.
        .replace('#include <fog_fragment>', `
          float lightHere = lightOnSkin(normalize(gl_FrontFacing ? suitNormal : -suitNormal), suitSky);
          gl_FragColor.rgb *= lightHere;
          #ifdef LOADS_ON_SKIN
            vec4 loadHere = regionOf(skinRegion);
            gl_FragColor.rgb = mix(gl_FragColor.rgb, loadHere.rgb * mix(1.0, lightHere, 0.75), loadHere.a);
          #endif
          #include <fog_fragment>`);
    };
    return material;
  }
}
