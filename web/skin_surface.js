// Poses a skin on the graphics card: a pass that writes the position of each vertex into a texture, one that writes its
// normal, the mean of the triangles around it by area, and one that writes how much of the sky it sees, as the server
// does. Materials read these textures. They hold the bits of floats as integers, because every WebGL 2 can draw into
// those.
import * as THREE from 'three';
import { emptyPlanes, foldsOfVertices, pressed, setPlanes } from './skin_folds.js';
import { coversOf, emptyCapsules, limbsOfVertices, openSky, setCapsules } from './skin_limbs.js';

const WIDTH = 256;  // of the textures, texels
const RING_WIDTH = 1024;
/** The sky is computed for every third posture: it changes slowly, and takes a software renderer longer than all else. */
const SKY_PERIOD = 3;

/** GLSL: the posed position and normal of the vertex `gl_VertexID`, and the share of the sky that no limb covers (x), in
 *  the uniforms of SkinSurface. */
export const POSED_VERTEX = `
  uniform highp usampler2D posedPositions, posedNormals, posedSky;
  vec3 posed(highp usampler2D values) {
    return uintBitsToFloat(texelFetch(values, ivec2(gl_VertexID % ${WIDTH}, gl_VertexID / ${WIDTH}), 0).xyz);
  }`;

const FULL_SCREEN = `
  void main() {
    gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 0.0, 1.0);
  }`;

/** @param {import('./skin_folds.js').Folds} folds
 *  @param {number} most  folds of a vertex
 *  @param {number} rows */
const positionsOf = (folds, most, rows) => `
  uniform highp sampler2D rest, frames;
  uniform sampler2D indices, weights;
  out highp uvec4 bits;${pressed(folds, most)}
  void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 bound = vec4(texelFetch(rest, at, 0).xyz, 1.0);
    vec4 index = 255.0 * texelFetch(indices, at, 0), weight = texelFetch(weights, at, 0);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
      int frame = int(index[k] + 0.5);
      sum += weight[k] * vec3(dot(texelFetch(frames, ivec2(0, frame), 0), bound),
                              dot(texelFetch(frames, ivec2(1, frame), 0), bound),
                              dot(texelFetch(frames, ivec2(2, frame), 0), bound));
    }
    bits = uvec4(floatBitsToUint(pressed(sum, at, ${rows})), 0u);
  }`;

// Of a skin of fewer triangles, a normal leans along the edges to two neighbours, as that of the whole one does
// (render/shape/fine_normals.h).
const LEANING = `
  uniform highp usampler2D leans;
  vec3 leaning(vec3 normal, vec3 own, ivec2 at) {
    highp uvec4 lean = texelFetch(leans, at, 0);
    vec3 shares = uintBitsToFloat(lean.xyz);
    return normalize(shares.x * normal + shares.y * (positionOf(int(lean.w & 0xffffu)) - own)
      + shares.z * (positionOf(int(lean.w >> 16)) - own));
  }`;

/** @param {boolean} isLeaning */
const normalsOf = (isLeaning) => `
  uniform highp sampler2D rest;
  uniform highp usampler2D posedPositions, ring;
  out highp uvec4 bits;
  vec3 positionOf(int vertex) {
    return uintBitsToFloat(texelFetch(posedPositions, ivec2(vertex % ${WIDTH}, vertex / ${WIDTH}), 0).xyz);
  }
  vec3 edgeTo(int place, vec3 from) {
    return positionOf(int(texelFetch(ring, ivec2(place % ${RING_WIDTH}, place / ${RING_WIDTH}), 0).x)) - from;
  }
  ${isLeaning ? LEANING : ''}
  void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int vertex = at.y * ${WIDTH} + at.x;
    int first = int(texelFetch(rest, at, 0).w);
    int end = int(texelFetch(rest, ivec2((vertex + 1) % ${WIDTH}, (vertex + 1) / ${WIDTH}), 0).w);
    vec3 own = positionOf(vertex), sum = vec3(0.0);
    if (first < end) {
      vec3 before = edgeTo(end - 1, own);
      for (int place = first; place < end; ++place) {
        vec3 next = edgeTo(place, own);
        sum += cross(before, next);
        before = next;
      }
    }
    vec3 normal = normalize(sum + vec3(0.0, 0.0, 1e-20));
    bits = uvec4(floatBitsToUint(${isLeaning ? 'leaning(normal, own, at)' : 'normal'}), 0u);
  }`;

/** @param {number} limbs */
const skyOf = (limbs) => `
  uniform sampler2D limbs;
  uniform highp usampler2D posedPositions, posedNormals;
  out highp uvec4 bits;${openSky(limbs)}
  void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 position = uintBitsToFloat(texelFetch(posedPositions, at, 0).xyz);
    vec3 normal = uintBitsToFloat(texelFetch(posedNormals, at, 0).xyz);
    int limb = int(255.0 * texelFetch(limbs, at, 0).x + 0.5);
    bits = uvec4(floatBitsToUint(openSky(position, normal, limb)), 0u, 0u, 0u);
  }`;

/** The vertices around each vertex, counter-clockwise from outside, one vertex after another. Where the triangles
 *  around a vertex do not close, the vertex itself stands in the gap: its edge is zero and adds nothing to the normal.
 *  @param {Uint16Array} triangles
 *  @param {number} vertices
 *  @returns {{ring: Uint16Array, first: Uint32Array}}  first: where each begins, and the end */
export function neighboursOf(triangles, vertices) {
  // The triangles a, b, c around a: b is followed by c.
  const begin = new Uint32Array(vertices + 1);
  triangles.forEach((corner) => { begin[corner + 1] += 1; });
  for (let i = 0; i < vertices; ++i) begin[i + 1] += begin[i];
  const from = new Uint16Array(triangles.length), to = new Uint16Array(triangles.length);
  const filled = begin.slice();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let i = 0; i < 3; ++i) {
      const place = filled[triangles[t + i]]++;
      from[place] = triangles[t + (i + 1) % 3];
      to[place] = triangles[t + (i + 2) % 3];
    }
  }
  // At most three for each triangle: from, to and a gap.
  const ring = new Uint16Array(3 * triangles.length);
  const first = new Uint32Array(vertices + 1);
  let end = 0;
  for (let vertex = 0; vertex < vertices; ++vertex) {
    first[vertex] = end;
    end = putRing(vertex, from.subarray(begin[vertex], begin[vertex + 1]), to.subarray(begin[vertex], begin[vertex + 1]),
      ring, end);
  }
  first[vertices] = end;
  return { ring: ring.slice(0, end), first };
}

/** @param {number} vertex
 *  @param {Uint16Array} from  of its triangles
 *  @param {Uint16Array} to
 *  @param {Uint16Array} ring  is written
 *  @param {number} end  of what has been written
 *  @returns {number} the new end */
function putRing(vertex, from, to, ring, end) {
  /** @type {Map<number, number>} */
  const byFrom = new Map();
  from.forEach((corner, i) => { if (!byFrom.has(corner)) byFrom.set(corner, i); });
  const begins = new Set(from);
  to.forEach((corner) => begins.delete(corner));
  // A closed ring begins anywhere; others where no triangle leads to.
  const open = begins.size > 0 || byFrom.size < from.length;
  const used = new Uint8Array(from.length);
  const follow = (/** @type {number} */ start) => {
    let count = 0;
    for (let i = /** @type {number|undefined} */ (start); i !== undefined && !used[i]; i = byFrom.get(to[i])) {
      used[i] = 1;
      ring[end++] = from[i];
      count += 1;
      start = i;
    }
    return { last: to[start], count };
  };
  if (!open) {
    const before = end;
    if (from.length > 0 && follow(0).count === from.length) return end;
    end = before;
    used.fill(0);
  }
  for (const starts of [[...begins].map((corner) => byFrom.get(corner) ?? 0), from.keys()]) {
    for (const start of starts) {
      if (used[start]) continue;
      ring[end++] = vertex;
      const { last } = follow(start);
      ring[end++] = last;
    }
  }
  return end;
}

/** @template {Float32Array|Uint8Array|Uint16Array|Uint32Array} T
 *  @param {T} values
 *  @param {T} padded  as long as the texture
 *  @param {number} width
 *  @param {{format: THREE.PixelFormat, type: THREE.TextureDataType, internalFormat: THREE.PixelFormatGPU|null}} kind */
function texture(values, padded, width, { format, type, internalFormat }) {
  padded.set(values);
  const isOne = format === THREE.RedFormat || format === THREE.RedIntegerFormat;
  const texels = isOne ? padded.length : padded.length / 4;
  const made = new THREE.DataTexture(padded, width, texels / width, format, type);
  if (internalFormat) made.internalFormat = internalFormat;
  made.needsUpdate = true;
  return made;
}

const FLOATS = { format: THREE.RGBAFormat, type: THREE.FloatType, internalFormat: null };
const BYTES = { format: THREE.RGBAFormat, type: THREE.UnsignedByteType, internalFormat: null };
const BYTE = { format: THREE.RedFormat, type: THREE.UnsignedByteType, internalFormat: null };
const WORDS = /** @type {const} */ ({ format: THREE.RGBAIntegerFormat, type: THREE.UnsignedIntType, internalFormat: 'RGBA32UI' });
const SHORTS = /** @type {const} */ (
  { format: THREE.RedIntegerFormat, type: THREE.UnsignedShortType, internalFormat: 'R16UI' });

/** A texel of each vertex: the bits of its shares, then both neighbours.
 *  @param {NonNullable<import('./skin_buffer.js').Skin['leans']>} leans
 *  @param {number} rows */
function leansTexture({ shares, neighbours }, rows) {
  const words = new Uint32Array(4 * WIDTH * rows), floats = new Float32Array(words.buffer);
  for (let i = 0; 2 * i < neighbours.length; ++i) {
    floats.set(shares.subarray(3 * i, 3 * i + 3), 4 * i);
    words[4 * i + 3] = neighbours[2 * i] | neighbours[2 * i + 1] << 16;
  }
  return texture(words, words, WIDTH, WORDS);
}

/** @param {number} rows */
const target = (rows) => new THREE.WebGLRenderTarget(WIDTH, rows, {
  format: THREE.RGBAIntegerFormat, type: THREE.UnsignedIntType, internalFormat: 'RGBA32UI', depthBuffer: false,
  minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false,
});

export class SkinSurface {
  /** Of materials with POSED_VERTEX. */
  uniforms;
  #positions;
  #normals;
  #sky;
  #posed = 0;  // postures
  #limbs;
  #folds;
  #planes;
  #frames;
  #capsules;
  #textures;
  #leans = /** @type {THREE.DataTexture|null} */ (null);
  #passes;
  #screen = new THREE.Mesh(new THREE.BufferGeometry().setAttribute(
    'position', new THREE.BufferAttribute(new Float32Array(9), 3)));
  #camera = new THREE.Camera();
  #isPosed = false;

  /** @param {import('./skin_buffer.js').Skin} skin */
  constructor(skin) {
    const { rig, positions, indices, weights, triangles, leans } = skin;
    const vertices = positions.length / 3;
    const rows = Math.ceil((vertices + 1) / WIDTH);  // one more, for where the last ring ends
    const { ring, first } = neighboursOf(triangles, vertices);
    const rest = new Float32Array(4 * WIDTH * rows);
    for (let i = 0; i <= vertices; ++i) {
      rest.set(positions.subarray(3 * i, 3 * i + 3), 4 * i);
      rest[4 * i + 3] = first[i];  // below 2^24: exact
    }
    this.#frames = texture(new Float32Array(), new Float32Array(12 * rig.frames.length), 3, FLOATS);
    this.#limbs = rig.limbs;
    this.#folds = rig.folds;
    this.#planes = emptyPlanes(rig.folds);
    const { values: foldValues, most } = foldsOfVertices(skin);
    const folds = new Float32Array(4 * WIDTH * rows * most);
    for (let k = 0; k < most; ++k) {
      folds.set(foldValues.subarray(4 * k * vertices, 4 * (k + 1) * vertices), 4 * k * WIDTH * rows);
    }
    this.#capsules = emptyCapsules(rig.limbs);
    const bytes = () => new Uint8Array(4 * WIDTH * rows);
    this.#textures = {
      rest: texture(rest, rest, WIDTH, FLOATS), frames: this.#frames,
      indices: texture(indices, bytes(), WIDTH, BYTES), weights: texture(weights, bytes(), WIDTH, BYTES),
      folds: texture(folds, folds, WIDTH, FLOATS),
      limbs: texture(limbsOfVertices(indices, weights, rig.limbOfFrame), new Uint8Array(WIDTH * rows), WIDTH, BYTE),
      ring: texture(ring, new Uint16Array(RING_WIDTH * Math.ceil(ring.length / RING_WIDTH)), RING_WIDTH, SHORTS),
    };
    this.#positions = target(rows);
    this.#normals = target(rows);
    this.#sky = target(rows);
    this.uniforms = {
      posedPositions: { value: this.#positions.texture }, posedNormals: { value: this.#normals.texture },
      posedSky: { value: this.#sky.texture },
    };
    const { rest: restTexture, ring: ringTexture, limbs, ...others } = this.#textures;
    const pass = (/** @type {string} */ fragmentShader,
      /** @type {Record<string, THREE.Texture|Float32Array|Uint32Array>} */ values) =>
      new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, vertexShader: FULL_SCREEN, fragmentShader, depthTest: false, depthWrite: false,
        blending: THREE.NoBlending,
        uniforms: Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }])),
      });
    this.#passes = [
      {
        material: pass(positionsOf(rig.folds, most, rows), { rest: restTexture, planes: this.#planes, ...others }),
        into: this.#positions,
      },
      {
        material: pass(normalsOf(leans !== null), {
          rest: restTexture, ring: ringTexture, posedPositions: this.#positions.texture,
          ...leans === null ? {} : { leans: this.#leans = leansTexture(leans, rows) },
        }),
        into: this.#normals,
      },
      {
        material: pass(skyOf(rig.limbs.length), {
          limbs, posedPositions: this.#positions.texture, posedNormals: this.#normals.texture,
          capsules: this.#capsules, covers: coversOf(rig.limbs),
        }),
        into: this.#sky,
      },
    ];
    this.#screen.frustumCulled = false;
  }

  /** The limbs at the newest posture, for `openSky`. */
  get capsules() {
    return this.#capsules;
  }

  /** @param {THREE.Matrix4[]} matrices  world_from_bind of each frame
   *  @param {import('./skin_frames.js').Pose[]} links  of all links, as they are streamed */
  setPosture(matrices, links) {
    const rows = /** @type {Float32Array} */ (this.#frames.image.data);
    let at = 0;
    for (const { elements: e } of matrices) {
      for (let row = 0; row < 3; ++row, at += 4) rows.set([e[row], e[row + 4], e[row + 8], e[row + 12]], at);
    }
    this.#frames.needsUpdate = true;
    setCapsules(this.#limbs, links, this.#capsules);
    setPlanes(this.#folds, matrices, links, this.#planes);
    this.#isPosed = false;
  }

  /** Before the skin is drawn; does nothing if no frame has moved.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    if (this.#isPosed) return;
    this.#isPosed = true;
    const { autoClear } = renderer;
    const before = renderer.getRenderTarget();
    renderer.autoClear = false;  // integers cannot be cleared by a colour
    const hasSky = this.#posed++ % SKY_PERIOD === 0;
    for (const { material, into } of hasSky ? this.#passes : this.#passes.slice(0, 2)) {
      this.#screen.material = material;
      renderer.setRenderTarget(into);
      renderer.render(this.#screen, this.#camera);
    }
    renderer.setRenderTarget(before);
    renderer.autoClear = autoClear;
  }

  dispose() {
    for (const each of Object.values(this.#textures)) each.dispose();
    this.#leans?.dispose();
    for (const { material, into } of this.#passes) {
      material.dispose();
      into.dispose();
    }
    this.#screen.geometry.dispose();
  }
}
