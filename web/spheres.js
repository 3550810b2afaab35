// The load spheres and the CoM of a person, in one draw call for those that are visible and one for what shines through:
// the shader of the server's pictures (render/vtk/sphere_actor.cc), so that both cover the same pixels in the same colours.
// Each is a dome that faces the viewer, whose rim is a ring from every side. World frame: z up, metres.
import * as THREE from 'three';
import { BEHIND, LIT } from './lit_material.js';

/** Spheres of a person. */
export const CAPACITY = 16;
const RIM_BEGINS = 0.76;  // of the radius
const CORNERS = 40;

/** @typedef {{center: number[], radius: number, depth: number, color: number[], rim: number}} Sphere
 *    center and radius: m; depth: m, by which it counts as nearer than its centre where it meets bodies and other spheres;
 *    color: sRGB 0..1; rim: opacity of the outer ring, above 0 dark, below 0 white */

/** Unit domes around +z, one for each sphere. */
function domes() {
  const dome = new THREE.SphereGeometry(1, CORNERS, 3, 0, 2 * Math.PI, 0, Math.PI / 2).rotateX(Math.PI / 2);
  const corners = dome.getAttribute('position'), triangles = dome.getIndex();
  if (!triangles) throw new Error('a sphere of three.js has no triangles');
  const position = new Float32Array(3 * CAPACITY * corners.count), part = new Float32Array(CAPACITY * corners.count);
  const index = new Uint16Array(CAPACITY * triangles.count);
  for (let i = 0; i < CAPACITY; ++i) {
    position.set(corners.array, 3 * i * corners.count);
    part.fill(i, i * corners.count, (i + 1) * corners.count);
    triangles.array.forEach((corner, at) => { index[i * triangles.count + at] = corner + i * corners.count; });
  }
  return { position, part, index, each: triangles.count };
}

const DOMES = domes();

const VERTEX = `
  attribute float part;
  uniform vec4 balls[${CAPACITY}];
  uniform float depths[${CAPACITY}];
  flat out int which;
  out vec3 dome;
  out vec3 place;
  out float sky;
  void main() {
    which = int(part + 0.5);
    vec4 ball = balls[which];
    vec3 toEye = normalize(cameraPosition - ball.xyz);
    vec3 cameraUp = vec3(viewMatrix[0].y, viewMatrix[1].y, viewMatrix[2].y);
    vec3 side = normalize(cross(cameraUp, toEye));
    vec3 above = cross(toEye, side);
    vec3 outward = side * position.x + above * position.y + toEye * position.z;
    mat4 toPicture = projectionMatrix * viewMatrix;
    dome = position;
    place = ball.xyz + ball.w * outward;
    sky = 0.5 + 0.5 * outward.z;
    gl_Position = toPicture * vec4(place, 1.0);
    vec4 nearer = toPicture * vec4(ball.xyz + depths[which] * toEye, 1.0);
    gl_Position.z = nearer.z / nearer.w * gl_Position.w;
  }`;

/** @param {boolean} isGhost  two classes that shine through one another would mix to a third: only the nearest is drawn */
const fragment = (isGhost) => `
  uniform vec4 balls[${CAPACITY}];
  uniform vec4 looks[${CAPACITY}];
  uniform int count;
  uniform float opacity;
  flat in int which;
  in vec3 dome;
  in vec3 place;
  in float sky;
  ${LIT}
  void main() {
    ${isGhost ? `
      vec3 ray = normalize(place - cameraPosition);
      float mine = dot(balls[which].xyz - cameraPosition, ray);
      for (int i = 0; i < count; ++i) {
        vec3 center = balls[i].xyz - cameraPosition;
        float along = dot(center, ray);
        vec3 off = center - along * ray;
        if (i != which && along < mine && dot(off, off) < balls[i].w * balls[i].w) discard;
      }` : ''}
    vec4 look = looks[which];
    float fromAxis2 = min(dot(dome.xy, dome.xy), 1.0);
    vec3 normal = vec3(dome.xy, sqrt(1.0 - fromAxis2));
    float fromAxis = sqrt(fromAxis2);
    float onRim = abs(look.a) * clamp((fromAxis - ${RIM_BEGINS}) / fwidth(fromAxis) + 0.5, 0.0, 1.0);
    vec3 color = mix(look.rgb, look.a > 0.0 ? vec3(0.15, 0.02, 0.02) : vec3(1.0), onRim);
    float shine = pow(max(dot(normal, vec3(-0.284, 0.410, 0.867)), 0.0), 32.0);
    // Between pure hue and full light: a class must read the same on the dark side.
    color = mix(color, lit(color, normal, sky), 0.75) + vec3(0.28 * shine * (1.0 - onRim));
    gl_FragColor = vec4(color, opacity);
  }`;

export class Spheres {
  group = new THREE.Group();
  #balls = Array.from({ length: CAPACITY }, () => new THREE.Vector4());
  #looks = Array.from({ length: CAPACITY }, () => new THREE.Vector4());
  #depths = new Float32Array(CAPACITY);
  #count = { value: 0 };
  #materials;
  #domes = new THREE.BufferGeometry();

  /** @param {number} ghostOpacity  of what shines through */
  constructor(ghostOpacity) {
    // Attributes of its own: three.js deletes the buffers of those of a geometry that is given back.
    this.#domes.setAttribute('position', new THREE.BufferAttribute(DOMES.position, 3));
    this.#domes.setAttribute('part', new THREE.BufferAttribute(DOMES.part, 1));
    this.#domes.setIndex(new THREE.BufferAttribute(DOMES.index, 1));
    const common = {
      balls: { value: this.#balls }, looks: { value: this.#looks }, depths: { value: this.#depths }, count: this.#count,
    };
    this.#materials = [
      new THREE.ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: fragment(false), uniforms: { ...common, opacity: { value: 1 } },
      }),
      new THREE.ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: fragment(true), uniforms: { ...common, opacity: { value: ghostOpacity } },
        ...BEHIND,
      }),
    ];
    this.#materials.forEach((each, i) => {
      const mesh = new THREE.Mesh(this.#domes, each);
      mesh.frustumCulled = false;
      mesh.renderOrder = 10 * i;
      this.group.add(mesh);
    });
  }

  /** @param {Sphere[]} spheres  those beyond the capacity are left out */
  show(spheres) {
    const shown = spheres.slice(0, CAPACITY);
    this.#count.value = shown.length;
    this.group.visible = shown.length > 0;
    this.#domes.setDrawRange(0, shown.length * DOMES.each);
    shown.forEach(({ center: [x, y, z], radius, depth, color: [red, green, blue], rim }, i) => {
      this.#balls[i].set(x, y, z, radius);
      this.#looks[i].set(red, green, blue, rim);
      this.#depths[i] = depth;
    });
  }

  dispose() {
    this.#domes.dispose();
    for (const material of this.#materials) material.dispose();
  }
}
