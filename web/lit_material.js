// Materials that are lit as in the server's pictures (kLitFunction of render/vtk/shaded_actor.cc): sRGB in, sRGB out.
import * as THREE from 'three';

/** GLSL: `normal` as the viewer sees it, z towards them; `sky`: 0 where a surface looks down, 1 where it looks up. */
export const LIT = `
  vec3 lit(vec3 color, vec3 normal, float sky) {
    float key = max(dot(normal, vec3(-0.439, 0.634, 0.637)), 0.0);
    float fill = max(dot(normal, vec3(0.816, 0.102, 0.569)), 0.0);
    float edge = 1.0 - max(normal.z, 0.0);
    float light = 0.47 + 0.17 * sky + 0.50 * key + 0.13 * fill;
    return color * light * (1.0 - 0.42 * edge * edge * edge);
  }`;

/** Of what is drawn where something is in front of it. */
export const BEHIND = { transparent: true, depthWrite: false, depthFunc: THREE.GreaterDepth };

const VERTEX = `
  out vec3 seenNormal;
  out float sky;
  void main() {
    seenNormal = normalize(normalMatrix * normal);
    sky = 0.5 + 0.5 * (seenNormal * mat3(viewMatrix)).z;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = `
  uniform vec3 color;
  uniform float opacity;
  in vec3 seenNormal;
  in float sky;${LIT}
  void main() { gl_FragColor = vec4(lit(color, normalize(seenNormal), sky), opacity); }`;

/** @param {number[]} rgb  sRGB 0..1
 *  @param {number} [opacity]
 *  @param {THREE.ShaderMaterialParameters} [more] */
export const makeLitMaterial = (rgb, opacity = 1, more = {}) => new THREE.ShaderMaterial({
  vertexShader: VERTEX, fragmentShader: FRAGMENT,
  uniforms: { color: { value: new THREE.Vector3().fromArray(rgb) }, opacity: { value: opacity } }, ...more,
});
