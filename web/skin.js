// A person as one skinned surface: the vertices, weights and clothes of the server's pictures. World frame: z up,
// metres.
import * as THREE from 'three';
import { toColor } from './colors.js';
import { framesOf } from './skin_frames.js';
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
const LIGHT = `
  uniform vec3 staleColor;
  uniform float stale;
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
function usePosedVertices(shader, declarations = '') {
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', `#include <common>${POSED_VERTEX}${declarations}`)
    .replace('#include <begin_vertex>', 'vec3 transformed = posed(posedPositions);');
}

export class SkinnedBody {
  mesh;
  #rig;
  #surface;
  #fromBind;
  #stale = { value: 0 };

  /** @param {import('./skin_buffer.js').Skin} skin
   *  @param {THREE.Color} staleColor */
  constructor(skin, staleColor) {
    this.#rig = skin.rig;
    this.#surface = new SkinSurface(skin);
    this.#fromBind = skin.rig.bind.map(({ position, rotation }) =>
      new THREE.Matrix4().compose(position, rotation, ONE).invert());
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(skin.positions, 3));
    geometry.setAttribute('paint', new THREE.BufferAttribute(skin.paint, 4));
    geometry.setIndex(new THREE.BufferAttribute(skin.triangles, 1));
    this.mesh = new THREE.Mesh(geometry, this.#material(skin, staleColor));
    this.mesh.customDepthMaterial = this.#depthMaterial();
    this.mesh.frustumCulled = false;  // its bounds move with the frames
    this.mesh.castShadow = true;  // only onto the floor: on the body itself shadows would disturb the shading
  }

  /** @param {import('./skin_frames.js').Pose[]} links  of all links, as they are streamed
   *  @param {boolean} isLive */
  update(links, isLive) {
    this.#stale.value = isLive ? 0 : 1;
    this.#surface.setPosture(framesOf(this.#rig, links).map(({ position, rotation }, i) =>
      new THREE.Matrix4().compose(position, rotation, ONE).multiply(this.#fromBind[i])), links);
  }

  /** Before it is drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    this.#surface.pose(renderer);
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.customDepthMaterial?.dispose();
    this.#surface.dispose();
  }

  /** @param {import('./skin_buffer.js').Skin} skin
   *  @param {THREE.Color} staleColor */
  #material({ colors, borderStep, paint, isTwoSided }, staleColor) {
    const paintedColor = paint instanceof Int8Array ? SUIT : OWN_COLORS;
    const material = new THREE.MeshBasicMaterial({ side: isTwoSided ? THREE.DoubleSide : THREE.FrontSide });
    material.onBeforeCompile = (shader) => {
      for (const [name, color] of Object.entries(colors)) shader.uniforms[`${name}Color`] = { value: toColor(color) };
      Object.assign(shader.uniforms, this.#surface.uniforms,
        { staleColor: { value: staleColor }, borderStep: { value: borderStep }, stale: this.#stale });
      usePosedVertices(shader, `
        attribute vec4 paint;
        varying vec4 suitPaint;
        varying vec3 suitNormal;
        varying vec2 suitSky;`);
      shader.vertexShader = shader.vertexShader.replace('#include <project_vertex>', `#include <project_vertex>
        vec3 posedNormal = posed(posedNormals);
        suitPaint = paint;
        suitNormal = mat3(modelViewMatrix) * posedNormal;
        suitSky = vec2(0.5 + 0.5 * posedNormal.z, posed(posedSky).x);`);
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>${LIGHT}${paintedColor}`)
        .replace('#include <color_fragment>', `#include <color_fragment>
          diffuseColor.rgb = mix(paintedColor(suitPaint), staleColor, stale);`)
        .replace('#include <fog_fragment>', `gl_FragColor.rgb *= lightOnSkin(normalize(gl_FrontFacing ? suitNormal : -suitNormal), suitSky);
          #include <fog_fragment>`);
    };
    return material;
  }

  #depthMaterial() {
    const material = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.#surface.uniforms);
      usePosedVertices(shader);
    };
    return material;
  }
}
