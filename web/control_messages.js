// What the server tells about its controls: the WebSocket message "controls" and /api/v1/files (docs/http.md).
import { boolean, listOf, number, object, oneOf, orNull, string } from './messages.js';

const readTrial = object({
  trial: string, person: string, condition: string, number, started_micros: number, secs: number, from_micros: number,
  to_micros: orNull(number), run_micros: number, has_recording: boolean, recording_problem: string,
});
const readJob = object({
  id: number, kind: oneOf(/** @type {const} */ (['clip', 'report'])), file: string, progress: number, problem: string,
  state: oneOf(/** @type {const} */ (['waiting', 'making', 'done', 'failed', 'cancelled'])),
});
const ORIGINS = /** @type {const} */ (['operator', 'option', 'assumed', 'stream', 'poses', 'bridge']);
const readOrigin = oneOf(ORIGINS);
const readHands = object({
  is_known: boolean, right_kg: number, left_kg: number, both_kg: number, since_micros: orNull(number), by: string,
});
const readPerson = object({
  character: number,
  name: object({ value: string, from: readOrigin }),
  mass_kg: object({ value: number, from: readOrigin }),
  sex: object({ value: oneOf(/** @type {const} */ (['male', 'female'])), from: readOrigin }),
  height_m: object({ value: number, from: readOrigin, stated: orNull(number) }),
  hands: readHands,
});
const readRecordingState = object({
  why_not: string, state: oneOf(/** @type {const} */ (['off', 'on', 'saving'])), file: string, secs: number, bytes: number,
  dropped: number, problem: string, free_bytes: orNull(number), secs_left: orNull(number),
});
const readWhyNot = object({ why_not: string });
export const readControls = object({
  recording: readRecordingState, clips: readWhyNot, trials: readWhyNot, trial: orNull(readTrial), jobs: listOf(readJob),
  people: listOf(readPerson), class_limits: object({ value: listOf(number, 2), from: readOrigin }), files_revision: number,
});
export const readFiles = object({
  revision: number, run_micros: number, trials: listOf(readTrial),
  files: listOf(object({ name: string, bytes: number, modified_micros: number })),
});
/** The answer to an order to make clip and report. */
export const readMade = object({ refused: listOf(string) });
/** @typedef {ReturnType<typeof readTrial>} Trial
 *  @typedef {ReturnType<typeof readJob>} Job
 *  @typedef {(typeof ORIGINS)[number]} Origin  where a value comes from
 *  @typedef {ReturnType<typeof readHands>} Hands
 *  @typedef {ReturnType<typeof readPerson>} ControlledPerson
 *  @typedef {ReturnType<typeof readRecordingState>} RecordingState
 *  @typedef {ReturnType<typeof readControls>} ControlState
 *  @typedef {ReturnType<typeof readFiles>} Files */
