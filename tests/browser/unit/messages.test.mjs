import assert from 'node:assert/strict';
import test from 'node:test';
import { readCameras, readDiagnostics, readModel, readTextMessage } from '../../../web/messages.js';

const rgb = [0.1, 0.2, 0.3];
const person = {
  character: 0, name: 'Anna', mass_kg: 75, mass_is_assumed: true, why_other_metric: '', why_no_ground: '', filter: 'causal', delay_secs: 0.045, floor_z_m: 0,
  hand_load: { right_kg: 5, left_kg: 0, both_kg: 0 },
  loads: [{ joint: 3, channel: 'flexion', reason: '', is_external: false,
    secs_in_band: { low: 1, medium: 2, high: 0, unknown: 0 } }],
};
const details = { source: 'udp://:9763', camera: 'front', has_pictures: true, people: [person],
  objects: [{ character: 9, number: 2, name: 'cart' }],
  left_out: [{ character: 7, name: 'Eve', reason: '900 km from the others' }],
  images: [{
    name: 'camera', is_old: false, camera: {
      width: 640, height: 480, focal_px: [525, 525], center_px: [319.5, 239.5], position: [1, 2, 3], orientation: [0, 0, 0, 1],
      scene_opacity: 0.5,
    },
  }],
  recording: { start_micros: 1.5, length_secs: 190.5, round_secs: null, ended_micros: null },
  marks_revision: 7, surroundings: 3, class_limits: [0.3, 0.6], class_falls_below: [0.25, 0.55] };
const palette = {
  classes: ['unknown', 'low', 'medium', 'high'].map((name) => ({ name, color: rgb, size: 0.8, rim: 0 })),
  cop: rgb, com: rgb, support: rgb, held: rgb, body: rgb, stale_body: rgb, clay: rgb, object: rgb, axes: [rgb, rgb, rgb],
  ghost: { on_light: rgb, on_dark: rgb, share: 0.75 },
};
const visual = { kind: 'mesh', size: [1, 1, 1], position: [0, 0, 0], quaternion: [0, 0, 0, 1], rgba: null,
  mesh: '/api/v1/mesh/0/1/0' };
const model = { people: [{ character: 0, revision: 1, ghost_opacity: null, opacity: 1, skin: '/api/v1/skin/0/1', links: [{ visuals: [visual] }],
    outline: [{ link: 0, position: [0, 0, 0.1], radius: 0.12 }],
    marks: { depths: [0.1], com: 0.034, com_depth: 0.068, com_ring: 0.062, com_line: 0.0035, cop_edge: 0.046, cop: 0.038 } }],
  joints: [{ name: 'l5_s1', label: 'L5/S1' }], class_limits: [0.3, 0.6], compression_limits_n: [3400, 6400], look: { loads: 'both', style: 'clay', trails: [{ segment: -1, name: 'centre of mass', color: rgb }], trail_secs: 2 },
  palette };

/** A copy of `value` whose member at `path` ("people.0.name") is `other`. */
function changed(value, path, other) {
  const copy = JSON.parse(JSON.stringify(value));
  const keys = path.split('.');
  const last = keys.pop();
  keys.reduce((part, key) => part[key], copy)[last] = other;
  return copy;
}

/** The path of every member within `value`. */
const pathsOf = (value, path = '') => (typeof value === 'object' && value !== null
  ? Object.entries(value).flatMap(([key, part]) => {
    const at = path === '' ? key : `${path}.${key}`;
    return [at, ...pathsOf(part, at)];
  }) : []);

test('valid messages of the server are returned unchanged', () => {
  assert.deepEqual(readTextMessage(JSON.stringify({ details })), { details });
  assert.deepEqual(readTextMessage('{"pong": 12.5, "server_micros": 5000}'), { pong: 12.5, server_micros: 5000 });
  assert.deepEqual(readTextMessage('{"error": "no camera \'x\'"}'), { error: 'no camera \'x\'' });
  assert.deepEqual(readModel(model, 'api/v1/model'), model);
});

test('unknown members are removed, and unknown messages are ignored', () => {
  assert.deepEqual(readTextMessage(JSON.stringify({ details: { ...details, weather: 'fair' } })), { details });
  assert.equal(readTextMessage('{"greeting": "hello"}'), null);
});

test('an invalid or missing member of the details or the model is rejected with its path', () => {
  for (const [whole, read] of [[{ details }, (value) => readTextMessage(JSON.stringify(value))],
    [model, (value) => readModel(value, 'api/v1/model')]]) {
    const paths = pathsOf(whole);
    assert.ok(paths.length > 25, `${paths.length} members`);
    for (const path of paths) {
      const named = path.replace(/\.(\d+)/g, '[$1]');
      assert.throws(() => read(changed(whole, path, { odd: 1 })), ({ message }) =>
        message.startsWith('the server sent ') && message.includes(named), path);
      if (/^details$|\.mesh$/.test(path)) continue;  // another kind of message; a visual that is a box
      assert.throws(() => read(changed(whole, path, undefined)), /the server sent (nothing|null) as/, `without ${path}`);
    }
  }
});

test('the error states the received value, its place and the expected type', () => {
  const message = JSON.stringify({ details: changed(details, 'people.0.name', 5) });
  assert.throws(() => readTextMessage(message),
    /^Error: the server sent 5 as details\.people\[0\]\.name; expected a text; reload the page$/);
  assert.throws(() => readTextMessage('{"details": {}}'), /sent nothing as details\.source; expected a text/);
  assert.throws(() => readTextMessage('[1]'), /sent \[1\] as a message; expected an object/);
  assert.throws(() => readTextMessage('{"pong": 1}'), /sent nothing as a message\.server_micros; expected a number/);
  assert.throws(() => readModel(changed(model, 'class_limits', [0.3]), 'api/v1/model'),
    /sent \[0\.3\] as api\/v1\/model\.class_limits; expected a list of 2/);
  assert.throws(() => readModel(changed(model, 'palette.classes.2.name', 'mild'), 'api/v1/model'),
    /sent "mild" as .*classes\[2\]\.name; expected low, medium, high, unknown/);
});

test('a model without a colour for every class is rejected', () => {
  const three = { ...model, palette: { ...palette, classes: palette.classes.slice(1) } };
  assert.throws(() => readModel(three, 'api/v1/model'), /palette\.classes; expected a colour of the class unknown/);
});

test('cameras are read as numbers and rejected if invalid', () => {
  const framing = { min_width_m: 1.9, margin_m: 0.7, narrowest_aspect: 1.3, reach_m: 50, height_m: 2.5 };
  const front = { name: 'front', position: [4.6, 0, 1.5], target: [0, 0, 1], up: [0, 0, 1], vertical_fov_rad: 0.5, turn: 'none' };
  assert.deepEqual(readCameras({ cameras: [front], framing, live: 'front', has_pictures: true }, 'api/v1/cameras'),
    { cameras: [front], framing, live: 'front' });
  assert.throws(() => readCameras({ cameras: [{ ...front, up: [0, 1] }], framing, live: 'front' }, 'api/v1/cameras'),
    /\[0,1\] as api\/v1\/cameras\.cameras\[0\]\.up; expected a list of 3/);
});

test('diagnostics of parts that do not run are absent', () => {
  assert.deepEqual(readDiagnostics({}, ''), { pictures: undefined, ros: undefined, source: undefined, stream: undefined });
  assert.equal(readDiagnostics({ pictures: null, stream: null }, '').stream, null);
  assert.throws(() => readDiagnostics({ source: { left_out: [{ character: 3 }] } }, 'api/v1/diagnostics'),
    /nothing as api\/v1\/diagnostics\.source\.left_out\[0\]\.name; expected a text/);
});

test('the health of the stream is read with its events, and rejected if it is invalid', () => {
  const gaps = { count: 3, count_10s: 1, last_micros: 5e6 };
  const stream = { samples: 60, lost: 2, loss_10s: null, loss: 0.03, jitter_ms: 1.5, gaps, incomplete: gaps, clock_steps: gaps,
    rejected: [{ ...gaps, reason: 'cut short' }], clocks: [] };
  assert.deepEqual(readTextMessage(JSON.stringify({ stream: { ...stream, later: 1 } })), { stream });
  assert.throws(() => readTextMessage(JSON.stringify({ stream: { ...stream, gaps: { ...gaps, count: 'often' } } })),
    /"often" as stream\.gaps\.count; expected a number/);
  const clock = { node: '/a', offset_ms: -3000, uncertainty_ms: 1, delay_ms: 2, most_delay_ms: 3, lag_ms: 3002, most_lag_ms: 3003, excess_ms: 0, warning: '' };
  assert.deepEqual(readTextMessage(JSON.stringify({ stream: { ...stream, clocks: [clock] } })), { stream: { ...stream, clocks: [clock] } });
  assert.throws(() => readTextMessage(JSON.stringify({ stream: { ...stream, clocks: [{ ...clock, lag_ms: null }] } })),
    /null as stream\.clocks\[0\]\.lag_ms; expected a number/);
});
