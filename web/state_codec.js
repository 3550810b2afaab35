// Reads the binary messages of the WebSocket. docs/http.md has the layout; server/http/protocol.cc writes them.

export const KIND = { state: 1, picture: 2, past: 3 };
export const VERSION = 10;

/** The name of this version among the subprotocols of a WebSocket. */
export const SOCKET_PROTOCOL = `kinescope.v${VERSION}`;

const STATE_HEADER_BYTES = 96;

// Names by their number in a message.
const LIVENESS = /** @type {const} */ (['no data', 'live', 'stale', 'no person']);
const LOAD_CLASS = /** @type {const} */ (['unknown', 'low', 'medium', 'high']);
const METRIC = /** @type {const} */ (['total', 'overload', 'external', 'norm']);
const SOLID_KIND = /** @type {const} */ (['box', 'cylinder']);

/** @typedef {{position: number[], quaternion: number[]}} Pose  metres; [x, y, z, w]; world_from_link
 *  @typedef {import('./messages.js').LoadClass} LoadClass
 *  @typedef {{joint: number, loadClass: LoadClass, radius: number, position: number[],
 *    ratio: number, moment: number, capacity: number}} Load  ratio: NaN if unknown; moment, capacity: N·m
 *  @typedef {{kind: (typeof SOLID_KIND)[number], position: number[], quaternion: number[], size: number[]}} Solid
 *    size: edges, or radius, radius, length along z
 *  @typedef {{cop: number[], force: number[]}} GroundForce  m; N, on the foot
 *  @typedef {{character: number, revision: number, com: number[]|null, cop: number[]|null,
 *    comSource: 'mvn'|'body_model', massIsAssumed: boolean, isDynamic: boolean, groundIsMeasured: boolean,
 *    leans: boolean, comDisagrees: boolean, compression: number, margin: number,
 *    comMinusMvn: number, heldKg: number[], metric: (typeof METRIC)[number],
 *    links: Pose[], loads: Load[], support: number[][], feet: GroundForce[], held: Solid[]}} Person
 *    compression (N), margin and comMinusMvn (m): NaN if unknown; heldKg: right, left; feet: those with a force that is shown
 *  @typedef {Pose & {character: number, number: number}} TrackedObject
 *  @typedef {{min: number[], max: number[]}} Extent  m
 *  @typedef {{liveness: (typeof LIVENESS)[number], counter: number, stateNumber: number,
 *    sentMicros: number, arrivalMicros: number, stampMicros: number, timeCodeMillis: number,
 *    rateHz: number, viewers: number, floor: number, waitedMillis: number, viewHeading: number,
 *    madeMicros: number, oldestMicros: number, oldestNumber: number, people: Person[], objects: TrackedObject[],
 *    ghosts: Person[], robots: Pose[][], cameraBase: Pose|null, extent: Extent|null}} State
 *    ghosts: reference poses; robots: those that move, the links that are drawn of each; not finite: nowhere;
 *    arrivalMicros 0: unknown; waitedMillis: in the server's machine; viewHeading: by which named views are turned about
 *    z, rad; cameraBase: of the frame that the server's own camera goes with; extent: of a scene without people;
 *    madeMicros: its moment in the server's history, oldestMicros, oldestNumber: of the first state in it, 0: none
 */

/** Whether time goes on in its stream.
 *  @param {State|null|undefined} state */
export const runs = (state) => state?.liveness === 'live' || state?.liveness === 'no person';

/** The kind of a message; throws if the server uses another version of the protocol.
 *  @param {ArrayBuffer} buffer */
export function messageKind(buffer) {
  const bytes = new Uint8Array(buffer);
  if (bytes.length < 2) throw new Error('message from the server is truncated');
  if (bytes[1] !== VERSION) {
    throw new Error(`the server uses protocol version ${bytes[1]} and this page version ${VERSION}; reload the page`);
  }
  return bytes[0];
}

/** Reads a message from its beginning to its end; little-endian. Each call returns the next value. */
class Bytes {
  #view;
  #offset = 0;

  /** @param {ArrayBuffer} buffer */
  constructor(buffer) {
    this.#view = new DataView(buffer);
  }

  u8() { return this.#view.getUint8(this.skip(1)); }

  u16() { return this.#view.getUint16(this.skip(2), true); }

  u32() { return this.#view.getUint32(this.skip(4), true); }

  i32() { return this.#view.getInt32(this.skip(4), true); }

  f32() { return this.#view.getFloat32(this.skip(4), true); }

  f64() { return this.#view.getFloat64(this.skip(8), true); }

  /** @param {number} count */
  floats(count) { return Array.from({ length: count }, () => this.f32()); }

  /** @template T
   *  @param {number} count
   *  @param {(bytes: Bytes) => T} read */
  list(count, read) { return Array.from({ length: count }, () => read(this)); }

  /** @param {number} size
   *  @returns {number} the offset of the skipped bytes */
  skip(size) {
    const offset = this.#offset;
    this.#offset += size;
    if (this.#offset > this.#view.byteLength) throw new Error('message from the server is truncated');
    return offset;
  }

  end() {
    if (this.#offset < this.#view.byteLength) throw new Error('message from the server is too long');
  }
}

/** @param {ArrayBuffer} buffer
 *  @returns {State} */
export function decodeState(buffer) {
  const bytes = new Bytes(buffer);
  const { peopleCount, objectCount, ghostCount, robotCount, hasCameraBase, hasExtent, ...header } = readStateHeader(bytes);
  const people = bytes.list(peopleCount, readPerson);
  const objects = bytes.list(objectCount, readObject);
  const ghosts = bytes.list(ghostCount, readPerson);
  const robots = bytes.list(robotCount, readRobot);
  const cameraBase = hasCameraBase ? readPose(bytes) : null;
  const extent = hasExtent ? { min: bytes.floats(3), max: bytes.floats(3) } : null;
  bytes.end();
  return { ...header, people, objects, ghosts, robots, cameraBase, extent };
}

/** @param {ArrayBuffer} buffer
 *  @returns {{stateNumber: number, arrivalMicros: number, jpeg: Uint8Array<ArrayBuffer>}} */
export function decodePicture(buffer) {
  const bytes = new Bytes(buffer);
  bytes.skip(8);
  return { stateNumber: bytes.f64(), arrivalMicros: bytes.f64(), jpeg: new Uint8Array(buffer, bytes.skip(0)) };
}

/** A former state. It is decoded when it is first wanted: of a run of many, a few ms each would delay a drawing. */
export class FormerState {
  #buffer;
  /** @type {State|null} */ #state = null;

  /** @param {ArrayBuffer} buffer  a message with a state
   *  @param {string} details  a text message */
  constructor(buffer, details) {
    if (buffer.byteLength < STATE_HEADER_BYTES) throw new Error('message from the server is truncated');
    const view = new DataView(buffer);
    this.#buffer = buffer;
    this.details = details;
    this.stateNumber = view.getFloat64(8, true);
    this.madeMicros = view.getFloat64(72, true);
  }

  /** @throws {Error} if it is not as described */
  get state() {
    this.#state ??= decodeState(this.#buffer);
    return this.#state;
  }
}

/** The answer to a request for former states.
 *  @param {ArrayBuffer} buffer
 *  @returns {{id: number, untilMicros: number, formers: FormerState[]}}  untilMicros: up to when there are no other states;
 *    formers: oldest first */
export function decodePast(buffer) {
  const bytes = new Bytes(buffer);
  bytes.skip(2);
  const count = bytes.u16(), id = bytes.u32(), untilMicros = bytes.f64();
  let details = '';
  const formers = bytes.list(count, () => {
    const stateBytes = bytes.u32(), detailsBytes = bytes.u32();
    const stateAt = bytes.skip(stateBytes), detailsAt = bytes.skip(detailsBytes);
    // Without details, those of the state before.
    if (detailsBytes > 0) details = new TextDecoder().decode(new Uint8Array(buffer, detailsAt, detailsBytes));
    return new FormerState(buffer.slice(stateAt, stateAt + stateBytes), details);
  });
  bytes.end();
  if (count === 0) throw new Error('the server sent no former state; reload the page');
  return { id, untilMicros, formers };
}

/** @param {Bytes} bytes */
function readStateHeader(bytes) {
  bytes.skip(2);  // kind and version
  const liveness = LIVENESS[bytes.u8()] ?? 'no data';
  const peopleCount = bytes.u8();
  const counter = bytes.u32();
  const [stateNumber, sentMicros, arrivalMicros, stampMicros, timeCodeMillis] = bytes.list(5, () => bytes.f64());
  const rateHz = bytes.f32();
  const viewers = bytes.u32();
  const floor = bytes.f32();
  const objectCount = bytes.u8();
  const ghostCount = bytes.u8();
  const waitedMillis = 10 * bytes.u16();
  const viewHeading = bytes.f32();
  const robotCount = bytes.u8();
  const hasCameraBase = bytes.u8() !== 0, hasExtent = bytes.u8() !== 0;
  bytes.skip(1);
  const [madeMicros, oldestMicros, oldestNumber] = bytes.list(3, () => bytes.f64());
  return {
    liveness, peopleCount, counter, stateNumber, sentMicros, arrivalMicros, stampMicros, timeCodeMillis, rateHz,
    viewers, floor, objectCount, ghostCount, robotCount, hasCameraBase,
    hasExtent, waitedMillis, viewHeading, madeMicros, oldestMicros, oldestNumber,
  };
}

/** @param {Bytes} bytes
 *  @returns {Person} */
function readPerson(bytes) {
  const { linkCount, loadCount, solidCount, cornerCount, ...header } = readPersonHeader(bytes);
  if (linkCount === 0) throw new Error('the server sent a person without links; reload the page');
  return {
    ...header,
    links: bytes.list(linkCount, readPose),
    loads: bytes.list(loadCount, readLoad),
    support: bytes.list(cornerCount, () => bytes.floats(2)),
    feet: bytes.list(2, readFoot).filter(({ force }) => !Number.isNaN(force[0])),
    held: bytes.list(solidCount, readSolid),
  };
}

/** @param {Bytes} bytes */
function readPersonHeader(bytes) {
  const character = bytes.i32();
  const flags = bytes.u8();
  const [linkCount, loadCount, solidCount] = bytes.list(3, () => bytes.u8());
  const revision = bytes.f64();
  const com = bytes.floats(3);
  const cop = bytes.floats(3);
  const [compression, margin, comMinusMvn] = bytes.floats(3);
  const heldKg = bytes.floats(2);
  const cornerCount = bytes.u8();
  const metric = METRIC[bytes.u8()] ?? 'total';
  bytes.skip(2);
  return {
    character, linkCount, loadCount, solidCount, cornerCount, revision, compression, margin, comMinusMvn, heldKg, metric,
    com: flags & 1 ? com : null,
    cop: flags & 2 ? cop : null,
    ...traitsOf(flags),
  };
}

/** @param {number} flags  of a person */
const traitsOf = (flags) => ({
  comSource: /** @type {'mvn'|'body_model'} */ (flags & 4 ? 'body_model' : 'mvn'),
  massIsAssumed: (flags & 8) !== 0,
  isDynamic: (flags & 16) !== 0,
  groundIsMeasured: (flags & 32) !== 0,
  leans: (flags & 64) !== 0,
  comDisagrees: (flags & 128) !== 0,
});

/** @param {Bytes} bytes
 *  @returns {GroundForce} */
const readFoot = (bytes) => ({ cop: bytes.floats(3), force: bytes.floats(3) });

/** @param {Bytes} bytes
 *  @returns {TrackedObject} */
function readObject(bytes) {
  const character = bytes.i32();
  const number = bytes.u8();
  bytes.skip(3);
  return { character, number, ...readPose(bytes) };
}

/** @param {Bytes} bytes
 *  @returns {Pose[]} */
function readRobot(bytes) {
  const linkCount = bytes.u16();
  bytes.skip(2);
  return bytes.list(linkCount, readPose);
}

/** @param {Bytes} bytes
 *  @returns {Solid} */
const readSolid = (bytes) => ({ kind: SOLID_KIND[bytes.u32()] ?? 'box', ...readPose(bytes), size: bytes.floats(3) });

/** @param {Bytes} bytes
 *  @returns {Pose} */
const readPose = (bytes) => ({ position: bytes.floats(3), quaternion: bytes.floats(4) });

/** @param {Bytes} bytes
 *  @returns {Load} */
function readLoad(bytes) {
  const joint = bytes.u8();
  const loadClass = LOAD_CLASS[bytes.u8()] ?? 'unknown';
  const radius = bytes.u16() / 1000;
  const position = bytes.floats(3);
  const [ratio, moment, capacity] = bytes.floats(3);
  return { joint, loadClass, radius, position, ratio, moment, capacity };
}
