// Reads the binary messages of the WebSocket. docs/http.md has the layout; server/http/protocol.cc writes them.

export const KIND = { state: 1, picture: 2 };
export const VERSION = 2;
const STATE_HEADER = 64;
const PERSON_HEADER = 64;
const LINK = 28;
const LOAD = 28;
const CORNER = 8;
const SOLID = 44;
const OBJECT = 36;
const PICTURE_HEADER = 24;

// Names by their number in a message.
const LIVENESS = /** @type {const} */ (['no data', 'live', 'stale']);
const LOAD_CLASS = /** @type {const} */ (['unknown', 'low', 'medium', 'high']);
const METRIC = /** @type {const} */ (['total', 'overload', 'external', 'norm']);
const SOLID_KIND = /** @type {const} */ (['box', 'cylinder']);

/** @typedef {{position: number[], quaternion: number[]}} Pose  metres; [x, y, z, w]; world_from_link
 *  @typedef {import('./messages.js').LoadClass} LoadClass
 *  @typedef {{joint: number, loadClass: LoadClass, radius: number, position: number[],
 *    ratio: number, moment: number, capacity: number}} Load  ratio: NaN if unknown; moment, capacity: N·m
 *  @typedef {{kind: (typeof SOLID_KIND)[number], position: number[], quaternion: number[], size: number[]}} Solid
 *    size: edges, or radius, radius, length along z
 *  @typedef {{character: number, revision: number, com: number[]|null, cop: number[]|null,
 *    comSource: 'mvn'|'body_model', massIsAssumed: boolean, isDynamic: boolean, groundIsMeasured: boolean,
 *    leans: boolean, comDisagrees: boolean, compression: number, margin: number,
 *    comMinusMvn: number, heldKg: number[], metric: (typeof METRIC)[number],
 *    links: Pose[], loads: Load[], support: number[][], held: Solid[]}} Person
 *    compression (N), margin and comMinusMvn (m): NaN if unknown; heldKg: right, left
 *  @typedef {Pose & {character: number, number: number}} TrackedObject
 *  @typedef {{liveness: (typeof LIVENESS)[number], counter: number, stateNumber: number,
 *    sentMicros: number, arrivalMicros: number, stampMicros: number, timeCodeMillis: number,
 *    rateHz: number, viewers: number, floor: number, people: Person[],
 *    objects: TrackedObject[]}} State  arrivalMicros 0: unknown
 */

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

/** @param {ArrayBuffer} buffer
 *  @returns {State} */
export function decodeState(buffer) {
  const view = new DataView(buffer);
  need(view, 0, STATE_HEADER);
  /** @type {State} */
  const state = {
    liveness: LIVENESS[view.getUint8(2)] ?? 'no data',
    counter: view.getUint32(4, true),
    stateNumber: view.getFloat64(8, true),
    sentMicros: view.getFloat64(16, true),
    arrivalMicros: view.getFloat64(24, true),
    stampMicros: view.getFloat64(32, true),
    timeCodeMillis: view.getFloat64(40, true),
    rateHz: view.getFloat32(48, true),
    viewers: view.getUint32(52, true),
    floor: view.getFloat32(56, true),
    people: [],
    objects: [],
  };
  let offset = STATE_HEADER;
  for (let count = view.getUint8(3); count > 0; --count) {
    const person = readPerson(view, offset);
    state.people.push(person);
    offset += PERSON_HEADER + LINK * person.links.length + LOAD * person.loads.length
      + CORNER * person.support.length + SOLID * person.held.length;
  }
  for (let count = view.getUint8(60); count > 0; --count, offset += OBJECT) {
    need(view, offset, OBJECT);
    state.objects.push({
      character: view.getInt32(offset, true),
      number: view.getUint8(offset + 4),
      ...readPose(view, offset + 8),
    });
  }
  if (offset !== view.byteLength) throw new Error('message from the server is too long');
  return state;
}

/** @param {ArrayBuffer} buffer
 *  @returns {{stateNumber: number, arrivalMicros: number, jpeg: Uint8Array<ArrayBuffer>}} */
export function decodePicture(buffer) {
  const view = new DataView(buffer);
  need(view, 0, PICTURE_HEADER);
  return {
    stateNumber: view.getFloat64(8, true),
    arrivalMicros: view.getFloat64(16, true),
    jpeg: new Uint8Array(buffer, PICTURE_HEADER),
  };
}

/** @param {DataView} view
 *  @param {number} offset
 *  @returns {Person} */
function readPerson(view, offset) {
  need(view, offset, PERSON_HEADER);
  const flags = view.getUint8(offset + 4);
  const linkCount = view.getUint8(offset + 5);
  const loadCount = view.getUint8(offset + 6);
  const solidCount = view.getUint8(offset + 7);
  const cornerCount = view.getUint8(offset + 60);
  if (linkCount === 0) throw new Error('the server sent a person without links; reload the page');
  need(view, offset, PERSON_HEADER + LINK * linkCount + LOAD * loadCount + CORNER * cornerCount
    + SOLID * solidCount);
  const firstLink = offset + PERSON_HEADER;
  const firstLoad = firstLink + LINK * linkCount;
  const firstCorner = firstLoad + LOAD * loadCount;
  const firstSolid = firstCorner + CORNER * cornerCount;
  return {
    character: view.getInt32(offset, true),
    revision: view.getFloat64(offset + 8, true),
    com: flags & 1 ? floats(view, offset + 16, 3) : null,
    cop: flags & 2 ? floats(view, offset + 28, 3) : null,
    comSource: flags & 4 ? 'body_model' : 'mvn',
    massIsAssumed: (flags & 8) !== 0,
    isDynamic: (flags & 16) !== 0,
    groundIsMeasured: (flags & 32) !== 0,
    leans: (flags & 64) !== 0,
    comDisagrees: (flags & 128) !== 0,
    compression: view.getFloat32(offset + 40, true),
    margin: view.getFloat32(offset + 44, true),
    comMinusMvn: view.getFloat32(offset + 48, true),
    heldKg: floats(view, offset + 52, 2),
    metric: METRIC[view.getUint8(offset + 61)] ?? 'total',
    links: Array.from({ length: linkCount }, (_, i) => readPose(view, firstLink + LINK * i)),
    loads: Array.from({ length: loadCount }, (_, i) => readLoad(view, firstLoad + LOAD * i)),
    support: Array.from({ length: cornerCount }, (_, i) => floats(view, firstCorner + CORNER * i, 2)),
    held: Array.from({ length: solidCount }, (_, i) => readSolid(view, firstSolid + SOLID * i)),
  };
}

/** @param {DataView} view
 *  @param {number} offset
 *  @returns {Solid} */
function readSolid(view, offset) {
  return {
    kind: SOLID_KIND[view.getUint32(offset, true)] ?? 'box',
    position: floats(view, offset + 4, 3),
    quaternion: floats(view, offset + 16, 4),
    size: floats(view, offset + 32, 3),
  };
}

/** @param {DataView} view
 *  @param {number} offset
 *  @returns {Pose} */
function readPose(view, offset) {
  return { position: floats(view, offset, 3), quaternion: floats(view, offset + 12, 4) };
}

/** @param {DataView} view
 *  @param {number} offset
 *  @returns {Load} */
function readLoad(view, offset) {
  return {
    joint: view.getUint8(offset),
    loadClass: LOAD_CLASS[view.getUint8(offset + 1)] ?? 'unknown',
    radius: view.getUint16(offset + 2, true) / 1000,
    position: floats(view, offset + 4, 3),
    ratio: view.getFloat32(offset + 16, true),
    moment: view.getFloat32(offset + 20, true),
    capacity: view.getFloat32(offset + 24, true),
  };
}

/** @param {DataView} view
 *  @param {number} offset
 *  @param {number} count */
function floats(view, offset, count) {
  return Array.from({ length: count }, (_, i) => view.getFloat32(offset + 4 * i, true));
}

/** @param {DataView} view
 *  @param {number} offset
 *  @param {number} size */
function need(view, offset, size) {
  if (offset + size > view.byteLength) throw new Error('message from the server is truncated');
}
