// What the page and the pictures of the server show of the same sample from the same camera, pixel by pixel.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, before } from 'node:test';
import { LiveCamera } from '../../web/live_camera.js';
import { decodePast, decodeState, KIND } from '../../web/state_codec.js';
import { closeBrowser, drawSeldom, endWithTests, openPage, pixelsOfPng, settled } from './open_page.mjs';

export const LONG = { timeout: 60000 };  // only a failure takes so long
const kinescope = process.env.KINESCOPE;
export let folder;
drawSeldom();
before(async () => { folder = await mkdtemp(join(tmpdir(), 'kinescope-pixels-')); });
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true });
});

/** A recording of nothing but the posture of `motion` after `seconds`. */
export async function record(motion, seconds, person, change = (frame) => frame) {
  const file = join(folder, `${motion}${change.name}.mvnx`);
  execFileSync(kinescope, ['convert', `demo:${motion}`, '--seconds', `${seconds}`, '--rate_hz', '60', ...person, '--out', file],
    { stdio: 'ignore' });
  const xml = await readFile(file, 'utf8');
  const frames = [...xml.matchAll(/<frame [^>]*type="normal"[^]*?<\/frame>/g)];
  const last = change(frames.at(-1)[0].replace(/^<frame [^>]*>/, ''));
  await writeFile(file, xml.replace(/(<frame [^>]*type="normal"[^>]*>)[^]*?<\/frame>/g, `$1${last}`));
  return file;
}

/** The people in the text of a frame elsewhere.
 *  @param {string} frame
 *  @param {(quaternion: number[]) => number[]} turn  w, x, y, z
 *  @param {(point: number[]) => number[]} move */
export function moved(frame, turn, move) {
  const changed = (tag, size, change) => (text) => text.replace(new RegExp(`(<${tag}>)([^<]*)`), (_, opened, values) => {
    const numbers = values.trim().split(/\s+/).map(Number);
    const parts = Array.from({ length: numbers.length / size }, (__, i) => change(numbers.slice(size * i, size * i + size)));
    return opened + parts.flat().join(' ');
  });
  return [changed('orientation', 4, turn), changed('position', 3, move), changed('centerOfMass', 3, move)]
    .reduce((text, change) => change(text), frame);
}

/** Serves it; the page then shows its last sample. */
export async function serve(file, options, env = {}) {
  const args = ['serve', '--source', file, '--http_port', '0', ...('ROS_MASTER_URI' in env ? [] : ['--ros', 'off']), ...options];
  const child = spawn(kinescope, args, { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, ...env } });
  endWithTests(child);
  const lines = createInterface({ input: child.stderr });
  let url = null;
  for await (const line of lines) {
    url = /page at (\S+)/.exec(line)?.[1];
    if (url) break;
  }
  child.stderr.resume();
  assert.ok(url, 'the server ended before it served');
  return {
    url,
    async stop() {
      child.kill('SIGTERM');
      if (child.exitCode === null) await once(child, 'exit');
    },
  };
}

/** Pixels that differ visibly. */
export function mask(one, other) {
  assert.deepEqual([one.width, one.height], [other.width, other.height]);
  const covered = new Uint8Array(one.width * one.height);
  const differ = (at) => Math.abs(one.data[at] - other.data[at]) > 12;
  for (let i = 0; i < covered.length; ++i) covered[i] = differ(4 * i) || differ(4 * i + 1) || differ(4 * i + 2) ? 1 : 0;
  return covered;
}

/** Covered by both, as a share of what is covered by either; without the pixels of `leftOut`. */
export function overlap(one, other, leftOut) {
  let both = 0, either = 0;
  for (let i = 0; i < one.length; ++i) {
    if (leftOut[i]) continue;
    both += one[i] & other[i];
    either += one[i] | other[i];
  }
  return { share: both / either, either };
}

/** The newest state of the server, or the one at a moment of its history, µs. */
export async function stateOf(page, micros = null) {
  const kind = micros === null ? KIND.state : KIND.past;
  const bytes = await page.evaluate(([wanted, moment]) => new Promise((resolve) => {
    const socket = new WebSocket(new URL('api/v1/ws', location.href.replace(/^http/, 'ws')));
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => { if (moment !== null) socket.send(JSON.stringify({ look: { id: 1, micros: moment } })); };
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string' || new Uint8Array(data)[0] !== wanted) return;
      resolve([...new Uint8Array(data)]);
      socket.close();
    };
  }), [kind, micros]);
  const { buffer } = Uint8Array.from(bytes);
  return micros === null ? decodeState(buffer) : decodePast(buffer).formers[0].state;
}

/** The page's camera, by its own functions from what the server sends: as options of `render`. `state`: that the page shows;
 *  default: the newest. */
export async function cameraOf(page, name, { width, height }, state = null) {
  state ??= await stateOf(page);
  const { cameras, framing, model, area } = await page.evaluate(async () => {
    const [{ freeAreaOf }, { cameras, framing }, model] = await Promise.all([import('./free_area.js'),
      ...['cameras', 'model'].map(async (name) => (await fetch(`api/v1/${name}`)).json())]);
    const boxes = ['view', 'cameras', 'points', 'loads-shown', 'banner']
      .map((id) => document.getElementById(id).getBoundingClientRect());
    return { cameras, framing, model, area: freeAreaOf(boxes[0], boxes.slice(1)) };
  });
  const camera = new LiveCamera();
  camera.setOutlines(model.people);
  const middle = camera.setState(state, framing.reach_m);
  camera.setAspect(width / height);
  camera.setArea(area);
  const { position, target, fovDegrees } = camera.aim(cameras.find((each) => each.name === name), middle);
  return ['--camera', `${position.join()}:${target.join()}`, '--fov', `${fovDegrees}`];
}

/** What the server draws of the same sample from the same camera. */
export async function serverPixels(file, camera, { width, height }, options, time = 0) {
  const out = join(folder, 'server.png');
  execFileSync(kinescope, ['render', file, '--time', `${time}`, ...camera, '--size', `${width}x${height}`, '--no_overlays', ...options, '--out', out],
    { stdio: 'ignore' });
  return pixelsOfPng(await readFile(out));
}

export const MARKS = 'loads,com,cop,support,forces,hand_loads';
export const PLAIN = ['--floor', 'off', '--background', 'black', '--hide'];

/** With the pixels beside them, two in each direction: the rims of spheres differ by that much on the page. */
export function grown(covered, { width }) {
  const by = [-2, -1, 0, 1, 2].flatMap((dy) => [-2, -1, 0, 1, 2].map((dx) => dy * width + dx));
  const wide = new Uint8Array(covered.length);
  for (let i = covered.indexOf(1); i >= 0; i = covered.indexOf(1, i + 1)) for (const step of by) wide[i + step] = 1;
  return wide;
}

/** The view is large enough that the rim of a body, which is of half pixels, is a small part of it. */
const TALL = { width: 1440, height: 1060 };

/** Hides what the page has over the view, or shows it again. */
export const onlyView = (page, isOnly) => page.evaluate((hidden) => {
  for (const over of document.querySelectorAll('.stage > :not(.view), .banner')) over.style.visibility = hidden ? 'hidden' : '';
}, isOnly);

/** The named view on the page, and which of its pixels differ from those of a page that cannot load `part`: the routes
 *  that are blocked then (or what is answered instead), and a piece of the address of what is loaded last. `status`: what the page says when it shows
 *  the moment that is compared. The overlays are hidden, but leave their room. part.query: of the address, beside the rest. */
export async function whatCovers({ url }, camera, part, status = { 'status-note': 'ended' }, viewport = TALL) {
  const open = async (hasPart) => {
    const visit = await openPage(`${url}?quality=steady&hide=shadows${part.query ?? ''}`, {
      colorScheme: 'dark', viewport,
      beforeLoad: async (page) => {
        const block = (route) => route.fulfill({ status: 404, body: '{"error": "hidden"}' });
        if (!hasPart) await page.route(part.route, part.answer ?? block);
      },
    });
    const { page } = visit;
    await page.waitForFunction((wanted) => Object.entries(wanted).every(([id, text]) =>
      document.getElementById(id).textContent.startsWith(text)), status, LONG);
    await page.locator(`#cameras button[data-camera="${camera}"]`).click();
    await onlyView(page, true);
    return visit;
  };
  const bare = await open(false), empty = await settled(bare.page);
  await bare.close();  // two pages at once would wait for each other's pictures
  const visit = await open(true);
  await visit.page.waitForFunction((address) => performance.getEntriesByType('resource').some(({ name, responseEnd }) =>
    name.includes(address) && responseEnd > 0), part.address, LONG);
  const shown = await settled(visit.page);
  return { page: visit.page, covered: mask(shown, empty), size: { width: shown.width, height: shown.height }, close: visit.close };
}
