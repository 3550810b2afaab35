// How long after the arrival of a sample the page's 3-D view shows it. A person changes between N-pose and T-pose every half
// second at 60 Hz; a patch of the view where only raised arms are is the marker, and is read back after every picture.
// Headless Chromium renders WebGL in software. Real sockets; the time until a display shows the picture is not in it.
//   node sample_to_pixel.mjs KINESCOPE SECONDS [WIDTHxHEIGHT]   (needs npm ci --prefix web and tests/browser, and Chromium)
import { execFileSync } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { startLab } from '../browser/lab.mjs';
import { closeBrowser, openPage } from '../browser/open_page.mjs';

const [program, seconds, size = '1440x900'] = process.argv.slice(2);
const [width, height] = size.split('x').map(Number);
if (!(Number(seconds) > 0) || !(width > 0) || !(height > 0)) {
  console.error('sample_to_pixel.mjs KINESCOPE SECONDS [WIDTHxHEIGHT]');
  process.exit(2);
}
process.env.KINESCOPE = program;
const HALF_SECOND = 30;  // samples

const FRAME = /(<frame [^>]*type="normal"[^>]*>)([^]*?<\/frame>)/g;

/** @param {string} folder
 *  @returns {Promise<string>}  a recording of a person who raises and lowers the arms at once */
async function recording(folder) {
  const poses = await Promise.all(['n_pose', 't_pose'].map(async (pose) => {
    const file = join(folder, `${pose}.mvnx`);
    execFileSync(program, ['convert', `demo:${pose}`, '--seconds', '10', '--rate_hz', '60', '--out', file], { stdio: 'ignore' });
    return readFile(file, 'utf8');
  }));
  const bodies = poses.map((text) => [...text.matchAll(FRAME)].at(-1)[2]);
  const file = join(folder, 'arms.mvnx');
  let frame = 0;
  await writeFile(file, poses[0].replace(FRAME, (_, head) => head + bodies[Math.floor(frame++ / HALF_SECOND) % 2]));
  return file;
}

// In the page, before its own programs: each time that a picture has been drawn, `afterDrawing` is called.
function watchDrawing() {
  let hasDrawn = false;
  const { drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawElements = function draw(...all) {
    hasDrawn = true;
    return drawElements.apply(this, all);
  };
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => request((time) => {
    callback(time);
    if (!hasDrawn) return;
    hasDrawn = false;
    window.afterDrawing?.();
  });
}

// In the page: when each change of the arms came to the server, by the page's clock, and when the patch had changed, ms.
async function watchChanges(millis) {
  const { KinescopeClient } = await import('/client.js');
  const changes = [], seen = [], gl = document.querySelector('#view canvas').getContext('webgl2');
  let offset = Infinity, wasRaised = null;  // of the page's clock to the server's, ms
  const client = new KinescopeClient({
    onState: ({ people, arrivalMicros, sentMicros }) => {
      offset = Math.min(offset, performance.now() - sentMicros / 1000);
      if (people.length === 0) return;
      const hand = people[0].links[10].position, shoulder = people[0].links[8].position;  // right
      const isRaised = Math.hypot(hand[0] - shoulder[0], hand[1] - shoulder[1]) > 0.3;
      if (wasRaised !== null && isRaised !== wasRaised) changes.push({ isRaised, arrived: arrivalMicros / 1000 });
      wasRaised = isRaised;
    },
  }, { token: new URL(location.href).searchParams.get('token') ?? undefined });
  const read = (x, y, w, h) => {
    const bytes = new Uint8Array(4 * w * h), bound = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    gl.readPixels(x, y, w, h, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, bound);
    return bytes;
  };
  const sleep = (time) => new Promise((done) => { setTimeout(done, time); });
  // The patch: where two whole pictures, half a period apart, differ most. Its quality must have been chosen by then.
  const wholes = { true: null, false: null };
  window.afterDrawing = () => {
    if (wasRaised === null || changes.length === 0) return;
    const age = performance.now() - (changes.at(-1).arrived + offset);
    if (age > 300 && age < 480) wholes[String(wasRaised)] = read(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
  };
  for (let i = 0; i < 100 && !(wholes.true && wholes.false); ++i) await sleep(100);
  if (!wholes.true || !wholes.false) return { why: 'the view did not show both poses within 10 s' };
  const columns = gl.drawingBufferWidth, rows = gl.drawingBufferHeight, patch = 4;
  let best = { difference: 0, x: 0, y: 0, raised: 0 };
  for (let y = 0; y + patch <= rows; y += patch) {
    for (let x = 0; x + patch <= columns; x += patch) {
      let difference = 0, raised = 0;
      for (let i = 0; i < patch * patch; ++i) {
        const at = 4 * ((y + Math.floor(i / patch)) * columns + x + i % patch);
        difference += Math.abs(wholes.true[at] - wholes.false[at]);
        raised += wholes.true[at];
      }
      if (difference > best.difference) best = { difference, x, y, raised };
    }
  }
  const sumOf = (bytes) => bytes.reduce((sum, value, i) => sum + (i % 4 === 0 ? value : 0), 0);
  let shown = null, pictures = 0, from = performance.now();
  window.afterDrawing = () => {
    ++pictures;
    const isRaised = Math.abs(sumOf(read(best.x, best.y, patch, patch)) - best.raised) < best.difference / 2;
    if (shown !== null && isRaised !== shown) seen.push({ isRaised, at: performance.now() });
    shown = isRaised;
  };
  changes.length = 0;
  await sleep(millis);
  window.afterDrawing = undefined;
  const rate = 1000 * pictures / (performance.now() - from);
  const delays = changes.flatMap(({ isRaised, arrived }) => {
    const first = seen.find((each) => each.isRaised === isRaised && each.at > arrived + offset);
    return first === undefined ? [] : [first.at - arrived - offset];
  });
  client.close();
  return { delays, changes: changes.length, rate, canvas: `${columns}x${rows}` };
}

const folder = await mkdtemp(join(tmpdir(), 'kinescope-pixel-'));
const lab = await startLab({ folder });
try {
  const suit = lab.stream([await recording(folder), '--loop']);
  const { page, close } = await openPage(lab.viewer, {
    viewport: { width, height }, beforeLoad: (opened) => opened.addInitScript(watchDrawing),
  });
  await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live', null, { timeout: 60000 });
  await page.waitForTimeout(8000);  // until the page has chosen its quality
  const { why, delays, changes, rate, canvas } = await page.evaluate(watchChanges, 1000 * Number(seconds));
  if (why) throw new Error(why);
  delays.sort((a, b) => a - b);
  const at = (share) => delays[Math.min(delays.length - 1, Math.floor(share * delays.length))].toFixed(1);
  console.log(`${size}, drawn at ${canvas}, ${rate.toFixed(1)} pictures/s: ${delays.length} of ${changes} changes seen; `
    + `ms after arrival: p50 ${at(0.5)}, p95 ${at(0.95)}, most ${at(1)}`);
  await close();
  await suit.stop();
} finally {
  await closeBrowser();
  await lab.stop();
  await rm(folder, { recursive: true });
}
