// Reads the WebSocket's binary messages; docs/http.md has the layout, server/http/protocol.cc writes it.

export const KIND = { state: 1, picture: 2 };
export const VERSION = 2;
const STATE_HEADER = 64;
const PERSON_HEADER = 40;
const LINK = 28;
const LOAD = 28;
const OBJECT = 36;
const PICTURE_HEADER = 24;

const LIVENESS = ['no data', 'live', 'stale'];
const LOAD_CLASS = ['unknown', 'low', 'medium', 'high'];

/** @typedef {{position: number[], quaternion: number[]}} Pose  metres; [x, y, z, w]; world_from_link
 *  @typedef {'unknown'|'low'|'medium'|'high'} LoadClass
 *  @typedef {{joint: number, loadClass: LoadClass, radius: number, position: number[],
 *    ratio: number, moment: number, capacity: number}} Load  ratio NaN where unknown; N m
 *  @typedef {{character: number, revision: number, com: number[]|null, cop: number[]|null,
 *    comIsOurs: boolean, massIsAssumed: boolean, links: Pose[], loads: Load[]}} Person
 *  @typedef {Pose & {character: number, number: number}} TrackedObject
 *  @typedef {{liveness: 'no data'|'live'|'stale', counter: number, number: number,
 *    sentMicros: number, arrivalMicros: number, stampMicros: number, timeCodeMillis: number,
 *    rateHz: number, viewers: number, floor: number, people: Person[],
 *    objects: TrackedObject[]}} State  arrivalMicros 0: not known
 */

/** Which kind a message is; throws where the server speaks another version of the protocol.
 *  @param {ArrayBuffer} buffer */
export function messageKind(buffer) {
  const bytes = new Uint8Array(buffer);
  if (bytes.length < 2) throw new Error('a message of the server is cut short');
  if (bytes[1] !== VERSION) {
    throw new Error(`the server speaks version ${bytes[1]} and this page version ${VERSION}: reload it`);
  }
  return bytes[0];
}

/** @param {ArrayBuffer} buffer
 *  @returns {State} */
export function decodeState(buffer) {
  const view = new DataView(buffer);
  need(view, 0, STATE_HEADER);
  const state = {
    liveness: LIVENESS[view.getUint8(2)] ?? 'no data',
    counter: view.getUint32(4, true),
    number: view.getFloat64(8, true),
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
    offset += PERSON_HEADER + LINK * person.links.length + LOAD * person.loads.length;
  }
  for (let count = view.getUint8(60); count > 0; --count, offset += OBJECT) {
    need(view, offset, OBJECT);
    state.objects.push({
      character: view.getInt32(offset, true),
      number: view.getUint8(offset + 4),
      ...readPose(view, offset + 8),
    });
  }
  if (offset !== view.byteLength) throw new Error('a message of the server has bytes too many');
  return state;
}

/** @param {ArrayBuffer} buffer
 *  @returns {{stateNumber: number, arrivalMicros: number, jpeg: Uint8Array}} */
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
 *  @param {number} offset */
function readPerson(view, offset) {
  need(view, offset, PERSON_HEADER);
  const flags = view.getUint8(offset + 4);
  const linkCount = view.getUint8(offset + 5);
  const loadCount = view.getUint8(offset + 6);
  need(view, offset, PERSON_HEADER + LINK * linkCount + LOAD * loadCount);
  const firstLink = offset + PERSON_HEADER;
  const firstLoad = firstLink + LINK * linkCount;
  return {
    character: view.getInt32(offset, true),
    revision: view.getFloat64(offset + 8, true),
    com: flags & 1 ? floats(view, offset + 16, 3) : null,
    cop: flags & 2 ? floats(view, offset + 28, 3) : null,
    comIsOurs: (flags & 4) !== 0,
    massIsAssumed: (flags & 8) !== 0,
    links: Array.from({ length: linkCount }, (_, i) => readPose(view, firstLink + LINK * i)),
    loads: Array.from({ length: loadCount }, (_, i) => readLoad(view, firstLoad + LOAD * i)),
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
    loadClass: /** @type {LoadClass} */ (LOAD_CLASS[view.getUint8(offset + 1)] ?? 'unknown'),
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
  if (offset + size > view.byteLength) throw new Error('a message of the server is cut short');
}
