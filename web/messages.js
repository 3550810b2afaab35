// Reads JSON from the server: answers of /api and text messages of the WebSocket (docs/http.md). A reader checks a
// value against its shape and returns it with the type of that shape, so that check and type have one definition.
// Members that the page does not use are dropped, so that a newer server may send more. Pure functions.

/** @template T
 *  @typedef {(value: unknown, path: string) => T} Reader  throws if `value`, found at `path`, has another shape */

const LONGEST_QUOTE = 60;  // characters of an invalid value

/** @param {unknown} value
 *  @param {string} path
 *  @param {string} expected
 *  @returns {never} */
function reject(value, path, expected) {
  const quote = value === undefined ? 'nothing' : JSON.stringify(value).slice(0, LONGEST_QUOTE);
  throw new Error(`the server sent ${quote} as ${path}; expected ${expected}; reload the page`);
}

/** @type {Reader<string>} */
export const string = (value, path) => (typeof value === 'string' ? value : reject(value, path, 'a text'));

/** @type {Reader<number>} */
export const number = (value, path) => (typeof value === 'number' ? value : reject(value, path, 'a number'));
/** @type {Reader<number|null>} null: unknown */
const numberOrNull = (value, path) => (value === null ? null : number(value, path));

/** @type {Reader<boolean>} */
export const boolean = (value, path) =>
  (typeof value === 'boolean' ? value : reject(value, path, 'true or false'));

/** @template {string} Word
 *  @param {readonly Word[]} words
 *  @returns {Reader<Word>} */
export const oneOf = (words) => (value, path) =>
  words.find((word) => word === value) ?? reject(value, path, words.join(', '));

/** @template T
 *  @param {Reader<T>} entry
 *  @param {number} [count]  length of the list; default: any
 *  @returns {Reader<T[]>} */
export const listOf = (entry, count) => (value, path) => {
  if (!Array.isArray(value)) return reject(value, path, 'a list');
  if (count !== undefined && value.length !== count) return reject(value, path, `a list of ${count}`);
  return value.map((/** @type {unknown} */ each, i) => entry(each, `${path}[${i}]`));
};

/** @param {number} [count] */
const numbers = (count) => listOf(number, count);

/** @template T
 *  @param {Reader<T>} reader
 *  @returns {Reader<T|null>} */
export const orNull = (reader) => (value, path) => (value === null ? null : reader(value, path));

/** @template T
 *  @param {Reader<T>} reader
 *  @returns {Reader<T|undefined>} */
export const optional = (reader) => (value, path) => (value === undefined ? undefined : reader(value, path));

/** @param {unknown} value
 *  @param {string} path
 *  @returns {Record<string, unknown>} */
const members = (value, path) =>
  (typeof value === 'object' && value !== null && !Array.isArray(value)
    ? Object.fromEntries(Object.entries(value)) : reject(value, path, 'an object'));

/** An object with any keys.
 *  @template T
 *  @param {Reader<T>} entry
 *  @returns {Reader<Record<string, T>>} */
export const recordOf = (entry) => (value, path) => Object.fromEntries(
  Object.entries(members(value, path)).map(([key, each]) => [key, entry(each, `${path}["${key}"]`)]));

/** @template {Record<string, Reader<unknown>>} Shape
 *  @typedef {{[Key in keyof Shape]: ReturnType<Shape[Key]>}} Shaped */

/** @template {Record<string, Reader<unknown>>} Shape
 *  @param {Shape} shape
 *  @returns {Reader<Shaped<Shape>>} */
export const object = (shape) => (value, path) => {
  const given = members(value, path);
  const read = Object.entries(shape).map(([key, reader]) => [key, reader(given[key], `${path}.${key}`)]);
  return /** @type {Shaped<Shape>} */ (Object.fromEntries(read));
};

/** In the order of legends and exposure strips. */
export const LOAD_CLASSES = /** @type {const} */ (['low', 'medium', 'high', 'unknown']);
/** @typedef {(typeof LOAD_CLASSES)[number]} LoadClass */

const rgb = numbers(3);

// Data of people and objects that do not change with every sample.
const readSecs = object({ low: number, medium: number, high: number, unknown: number });
const readHandLoad = object({ right_kg: number, left_kg: number, both_kg: number });
const readPersonDetails = object({
  character: number, name: string, mass_kg: number, mass_is_assumed: boolean, why_other_metric: string,
  why_no_ground: string, filter: string, delay_secs: number, floor_z_m: numberOrNull, hand_load: readHandLoad,
  loads: listOf(object({
    joint: number, channel: string, reason: string, is_external: boolean, secs_in_band: readSecs,
  })),
});
const readObjectName = object({ character: number, number, name: string });
const readImageCamera = object({
  width: number, height: number, focal_px: numbers(2), center_px: numbers(2), position: numbers(3), orientation: numbers(4),
  scene_opacity: number,
});
const readCameraImage = object({ name: string, is_old: boolean, camera: orNull(readImageCamera) });
const readLeftOut = object({ character: number, name: string, reason: string });
const readRecording = object({
  start_micros: number, length_secs: numberOrNull, round_secs: numberOrNull, ended_micros: numberOrNull,
});
const readDetails = object({
  source: string, camera: string, has_pictures: boolean, people: listOf(readPersonDetails),
  objects: listOf(readObjectName), left_out: listOf(readLeftOut), images: listOf(readCameraImage),
  recording: orNull(readRecording),
  marks_revision: numberOrNull, surroundings: numberOrNull, class_limits: numbers(2), class_falls_below: numbers(2),
});
/** @typedef {ReturnType<typeof readSecs>} Secs  time in each class so far, s
 *  @typedef {ReturnType<typeof readHandLoad>} HandLoad
 *  @typedef {ReturnType<typeof readPersonDetails>} PersonDetails
 *  @typedef {ReturnType<typeof readObjectName>} ObjectName
 *  @typedef {ReturnType<typeof readImageCamera>} ImageCamera  a pinhole camera: px of an image of its width and height;
 *    its pose in the world: z forward, x to the right, y down, as a quaternion x, y, z, w
 *  @typedef {ReturnType<typeof readCameraImage>} CameraImage  of another node; old: no new one comes; its camera if the
 *    scene is drawn over it
 *  @typedef {ReturnType<typeof readLeftOut>} LeftOut  a person who is not shown, and why
 *  @typedef {ReturnType<typeof readRecording>} Recording  that is played: the stamp of its first sample; its length and
 *    the time after which it begins anew, null: not known, or not repeated; the moment of its last sample, null: it plays
 *  @typedef {ReturnType<typeof readDetails>} Details */

const readStreamEvents = { count: number, count_10s: number, last_micros: numberOrNull };
const readNodeClock = object({
  node: string, offset_ms: numberOrNull, uncertainty_ms: numberOrNull, delay_ms: numberOrNull, most_delay_ms: numberOrNull,
  lag_ms: number, most_lag_ms: number, excess_ms: number, warning: string,
});
const readStream = object({
  samples: number, lost: number, loss_10s: numberOrNull, loss: numberOrNull, jitter_ms: numberOrNull,
  gaps: object(readStreamEvents), incomplete: object(readStreamEvents), clock_steps: optional(object(readStreamEvents)),
  rejected: listOf(object({ ...readStreamEvents, reason: string })),
  clocks: listOf(readNodeClock),
});
/** @typedef {{count: number, count_10s: number, last_micros: number|null}} StreamEvents  in all, in the last 10 s, and
 *    when last, in µs of the server's clock; null: never
 *  @typedef {ReturnType<typeof readNodeClock>} NodeClock  of a ROS node whose people are read: its clock minus that of the
 *    server and the delay, both null where the node does not tell its time; else from its stamps to their arrival; by how much its
 *    stamps are ahead so that none goes back
 *  @typedef {ReturnType<typeof readStream>} StreamHealth  losses as shares of the samples that were lost or
 *    incomplete; null: no samples */

const readPong = object({ pong: number, server_micros: number });

/** @typedef {{pong: number, server_micros: number}|{details: Details}|{stream: StreamHealth}|{alarms: ShownAlarms}
 *    |{controls: unknown}|{error: string}} TextMessage */

/** @param {string} text
 *  @returns {unknown} */
function parseJson(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Error('the server sent a message that is not JSON; check for a proxy in front of the server');
  }
}

/** @param {string} text  a text message of the WebSocket
 *  @returns {TextMessage|null}  null: a kind of message that this page does not support */
export function readTextMessage(text) {
  const message = members(parseJson(text), 'a message');
  if ('pong' in message) return readPong(message, 'a message');
  if ('details' in message) return { details: readDetails(message.details, 'details') };
  if ('stream' in message) return { stream: readStream(message.stream, 'stream') };
  if ('controls' in message) return { controls: message.controls };  // read by control_messages.js
  if ('alarms' in message) return { alarms: readShownAlarms(message.alarms, 'alarms') };
  if ('error' in message) return { error: string(message.error, 'error') };
  return null;
}

// /api/v1/marks and /api/v1/mark
const readMoment = object({ state: number, micros: number, stamp_micros: number, time_code_millis: number, counter: number });
const MARK_KINDS = /** @type {const} */ (['mark', 'change', 'trial']);
export const readMark = object({
  id: number, revision: number, run_micros: number, kind: oneOf(MARK_KINDS), button: number, text: string, role: string, at: readMoment,
  end: orNull(readMoment), is_open: boolean, is_removed: boolean, behind_secs: number,
});
export const readMarks = object({ names: listOf(string), run_micros: number, revision: number, marks: listOf(readMark) });
/** @typedef {ReturnType<typeof readMark>} Mark */

// /api/v1/alarms and the message "alarms"
/** From the highest. */
export const PRIORITIES = /** @type {const} */ (['high', 'medium', 'low']);
const readAlarmMoment = object({ state: number, micros: number, stamp_micros: number });
/** @type {Reader<number|string>}  a class is a word */
const readAlarmValue = (value, path) => (typeof value === 'string' ? value : number(value, path));
const readAlarm = object({
  id: number, rule: string, priority: oneOf(PRIORITIES), quantity: string, unit: string, limit: readAlarmValue,
  person: numberOrNull, name: string, joint: orNull(string), value: readAlarmValue, worst: readAlarmValue,
  times: number, began: readAlarmMoment, over: orNull(readAlarmMoment), is_on: boolean, is_shown: boolean,
  acknowledged: orNull(object({ role: string, micros: number })),
});
const readShownAlarms = object({ shown: listOf(readAlarm), count: number, last: orNull(readAlarm) });
export const readAlarmLog = object({ alarms: listOf(readAlarm) });
/** @typedef {(typeof PRIORITIES)[number]} Priority
 *  @typedef {ReturnType<typeof readAlarm>} Alarm
 *  @typedef {ReturnType<typeof readShownAlarms>} ShownAlarms  those that are on or wait for being acknowledged; how many
 *    there are; the one that began last */

// /api/v1/model
const readVisual = object({
  kind: oneOf(['box', 'cylinder', 'sphere', 'mesh']), size: numbers(3), position: numbers(3),
  quaternion: numbers(4), rgba: orNull(numbers(4)), mesh: optional(string),
});
const readOutlinePoint = object({ link: number, position: numbers(3), radius: number });
const readMarkSizes = object({
  depths: numbers(), com: number, com_depth: number, com_ring: number, com_line: number, cop_edge: number, cop: number,
});
const readPersonModel = object({
  character: number, revision: number, ghost_opacity: numberOrNull, opacity: number, skin: orNull(string),
  links: listOf(object({ visuals: listOf(readVisual) })), outline: listOf(readOutlinePoint),
  marks: readMarkSizes,
});
const readClassColors = listOf(object({ name: oneOf(LOAD_CLASSES), color: rgb, size: number, rim: number }));
const readPalette = object({
  /** @type {Reader<ReturnType<typeof readClassColors>>} */
  classes: (value, path) => {
    const colors = readClassColors(value, path);
    const missing = LOAD_CLASSES.find((wanted) => !colors.some(({ name }) => name === wanted));
    return missing ? reject(value, path, `a colour of the class ${missing}`) : colors;
  },
  cop: rgb, com: rgb, support: rgb, held: rgb, body: rgb, stale_body: rgb, clay: rgb, object: rgb, axes: listOf(rgb, 3),
  ghost: object({ on_light: rgb, on_dark: rgb, share: number }),
});
/** Where the classes of joint loads are shown, and how bodies are drawn: the values of --loads and --style. */
export const LOADS_SHOWN = /** @type {const} */ (['spheres', 'skin', 'both']);
const readTrail = object({ segment: number, name: string, color: rgb });
const readLook = object({
  loads: oneOf(LOADS_SHOWN), style: oneOf(['matte', 'clay', 'line']), trails: listOf(readTrail), trail_secs: number,
});
export const readModel = object({
  people: listOf(readPersonModel), joints: listOf(object({ name: string, label: string })), class_limits: numbers(2),
  compression_limits_n: numbers(2), look: readLook,
  palette: readPalette,
});
/** @typedef {ReturnType<typeof readVisual>} Visual
 *  @typedef {ReturnType<typeof readOutlinePoint>} OutlinePoint  a ball that moves with a link, m
 *  @typedef {ReturnType<typeof readPersonModel>} PersonModel
 *  @typedef {ReturnType<typeof readMarkSizes>} MarkSizes  m; depths: of the sphere of each joint
 *  @typedef {ReturnType<typeof readPalette>} Palette  sRGB 0..1
 *  @typedef {ReturnType<typeof readTrail>} TrailLook  segment: number of its link; -1: the centre of mass
 *  @typedef {ReturnType<typeof readLook>} Look
 *  @typedef {ReturnType<typeof readModel>} Model */

// /api/v1/surroundings.glb: the extras of its scene, those of its texts and those of its points
export const readSurroundings = object({ problems: listOf(string) });
export const readLabelText = object({ text: string, height: number, color: rgb, opacity: number });
/** @typedef {ReturnType<typeof readLabelText>} LabelText  height of a capital, m; 0: a note of fixed size */
export const readPointsExtras = object({ size: numbers(2), in_pixels: boolean });

// /api/v1/series
const readColumns = listOf(numberOrNull);
export const readSeries = object({
  samples: numbers(), keys: recordOf(object({ min: readColumns, max: readColumns, last: readColumns })),
});
/** @typedef {ReturnType<typeof readSeries>} SeriesAnswer */

// /api/v1/cameras
const readCameraView = object({
  name: string, position: numbers(3), target: numbers(3), up: numbers(3), vertical_fov_rad: number,
  turn: oneOf(['none', 'heading', 'pose']),
});
const readFraming = object({
  min_width_m: number, margin_m: number, narrowest_aspect: number, reach_m: number, height_m: number,
});
export const readCameras = object({ cameras: listOf(readCameraView), framing: readFraming, live: string });
/** @typedef {ReturnType<typeof readCameraView>} CameraView  of a person at the origin; "own": where the server was told
 *  @typedef {ReturnType<typeof readFraming>} Framing  of several people and of narrow views; docs/http.md
 *  @typedef {ReturnType<typeof readCameras>} Cameras */

/** /api/v1/diagnostics: parts of the server that are not running are absent or null. */
export const readDiagnostics = object({
  pictures: optional(orNull(object({ problems: optional(listOf(string)), last_error: optional(string) }))),
  source: optional(object({
    left_out: optional(listOf(readLeftOut)), transport: optional(object({ ros_master_answers: optional(number) })),
    problems: optional(listOf(string)), passed_secs: optional(number),
  })),
  stream: optional(orNull(object({ clocks: listOf(readNodeClock) }))),
  ros: optional(orNull(object({
    master_uri: optional(string), frame: optional(string), not_shown: optional(listOf(string)),
  }))),
});
/** @typedef {ReturnType<typeof readDiagnostics>} Diagnostics */

/** /api/v1/session: what this client may do, the subprotocol of the WebSocket, and when the server was started. */
export const readSession = object({
  role: oneOf(/** @type {const} */ (['viewer', 'operator'])), socket: string, started_micros: optional(number),
});

/** The answer to any rejected request. */
export const readRejection = object({ error: string });
