// The page shows what the pictures of the server show: all objects, pixel by pixel.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { writeFile } from 'node:fs/promises';
import { connect, createServer } from 'node:net';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test as nodeTest } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { endWithTests, openPage, pixelsOf, pixelsOfPng, pressedCameras, saveScreenshot, settled } from './open_page.mjs';
import {
  cameraOf, folder, grown, LONG, mask, MARKS, onlyView, overlap, PLAIN, record, serve, serverPixels, stateOf, whatCovers,
} from './same_pixels.mjs';

const test = (name, body) => nodeTest(name, { timeout: 300000 }, body);  // only a failure takes so long

test('a former moment covers the same pixels on the page and in a picture', async () => {
  const file = join(folder, 'moving.mvnx'), place = 0.5, ghost = ['--ghost', 't_pose'];
  execFileSync(process.env.KINESCOPE, ['convert', 'demo:lift', '--seconds', '2', '--rate_hz', '60', '--out', file], { stdio: 'ignore' });
  const site = await serve(file, ['--stop_at', '1.5', '--pictures', 'off', ...ghost]);
  const { page, covered, size, close } = await whatCovers(site, 'front', { ...SKIN, query: `&at=${place}` },
    { 'status-word': 'Recording 0:00.5' });
  await saveScreenshot(page, 'same_former');
  const state = await stateOf(page, START_MICROS + 1e6 * place + 1000), sameCamera = await cameraOf(page, 'front', size, state);
  const draw = (hidden, more = []) => serverPixels(file, sameCamera, size, [...PLAIN, hidden, ...more], place);
  const rest = `shadows,${MARKS}`;
  const withLoads = mask(await draw(rest), await draw(rest.replace('loads,', '')));
  const both = mask(await draw(rest, ghost), await draw(`body,${rest}`));
  const { share, either } = overlap(covered, both, grown(withLoads, size));
  assert.ok(either > 0.02 * covered.length, `${either} pixels`);
  assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels are covered by both`);
  await site.stop();
  await close();
});

test('a translucent body seen by the camera that the server was given covers the same pixels', async () => {
  const file = await record('lift', 1, []), camera = ['--camera', '1.2,2,1.6:0,0,0.9:0.2,0,1', '--fov', '45'];
  const body = ['--body_opacity', '0.6', '--style', 'clay'];  // a translucent black shoe cannot be told from the ground
  const site = await serve(file, ['--stop_at', '0.5', '--pictures', 'off', ...camera, ...body]);
  const { page, covered, size, close } = await whatCovers(site, 'own', SKIN, { 'status-word': 'Recording' });
  assert.deepEqual(await pressedCameras(page), ['own']);
  await saveScreenshot(page, 'same_own_camera');
  const rest = `shadows,${MARKS}`;
  const draw = (hidden) => serverPixels(file, camera, size, [...PLAIN, hidden, ...body], 0.5);
  const withLoads = mask(await draw(rest), await draw(rest.replace('loads,', '')));
  const { share, either } = overlap(covered, mask(await draw(rest), await draw(`body,${rest}`)), grown(withLoads, size));
  assert.ok(either > 0.01 * covered.length, `${either} pixels`);
  assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels are covered by both`);
  await close();
  await site.stop();
});

test('the page begins with the camera that the server was given, and comes back to it', async () => {
  const site = await serve(await record('lift', 1, []), ['--loop', '--pictures', 'off', '--camera', '1.5,2.5,2.4:0,0,0.8']);
  const { page, close } = await openPage(site.url);
  await page.locator('#cameras button[data-camera="own"][aria-pressed="true"]').waitFor(LONG);
  await page.click('#cameras [data-camera="front"]');
  assert.deepEqual(await pressedCameras(page), ['front']);
  await page.waitForFunction(() => location.href.includes('camera=front'), null, LONG);
  await page.click('#cameras [data-camera="own"]');
  assert.deepEqual(await pressedCameras(page), ['own']);
  await page.waitForFunction(() => !location.href.includes('camera='), null, LONG);
  await close();
  await site.stop();
});

const START_MICROS = 3600e6;  // of the clock of a server that stops at a moment
const SKIN = { route: '**/api/v1/skin/**', address: 'api/v1/skin' };
const POINTS = ['com', 'cop', 'support', 'forces', 'loads', 'hand_loads'];

/** Nothing moves: live and computed afterwards, with what comes later known, forces are the same. */
const still = (frame) => frame.replace(/(<(?:velocity|acceleration|angularVelocity|angularAcceleration)>)([^<]*)/g,
  (_, tag, values) => tag + values.replace(/[^ ]+/g, '0'));

/** Left, right, top and bottom of what is covered. */
function boxOf(covered, { width }) {
  const box = [Infinity, -Infinity, Infinity, -Infinity];
  covered.forEach((bit, i) => {
    if (!bit) return;
    const x = i % width, y = Math.floor(i / width);
    box.splice(0, 4, Math.min(box[0], x), Math.max(box[1], x), Math.min(box[2], y), Math.max(box[3], y));
  });
  return box;
}

test('each mark has the size that it has in the picture', async () => {
  const file = await record('lift', 1, [], still), person = ['--hand_load', 'both:10'];
  const site = await serve(file, ['--loop', ...person, '--pictures', 'off']);
  const hide = (shown) => ['body', 'shadows', ...POINTS].filter((each) => each !== shown).join();
  const open = async (shown) => {
    const visit = await openPage(`${site.url}?quality=steady&camera=three_quarter&hide=${hide(shown)}`,
      { colorScheme: 'dark', context: { reducedMotion: 'reduce' } });  // the camera does not follow slowly
    await visit.page.waitForFunction(() => document.getElementById('status-word').textContent.startsWith('Recording'), null, LONG);
    await onlyView(visit.page, true);
    return visit;
  };
  const bare = await open(''), empty = await settled(bare.page), size = { width: empty.width, height: empty.height };
  const sameCamera = await cameraOf(bare.page, 'three_quarter', size);
  await bare.close();
  const draw = (shown) => serverPixels(file, sameCamera, size, [...PLAIN, hide(shown), ...person]);
  const nothing = await draw('');
  for (const part of POINTS) {
    const visit = await open(part);
    const onPage = mask(await settled(visit.page), empty), inPicture = mask(await draw(part), nothing);
    await saveScreenshot(visit.page, `same_${part}`);
    for (const [one, other, of] of [[onPage, inPicture, 'page'], [inPicture, onPage, 'picture']]) {
      const { share, count } = found(one, other, NOTHING_LEFT_OUT(one), size);
      assert.ok(count > 40, `${part}: ${count} pixels on the ${of}`);
      assert.ok(share >= 0.99, `${part}: ${share.toFixed(4)} of the pixels of the ${of} are within a pixel of the other's`);
    }
    const [here, there] = [boxOf(onPage, size), boxOf(inPicture, size)];
    here.forEach((edge, i) => assert.ok(Math.abs(edge - there[i]) <= 2, `${part}: ${here} on the page, ${there} in the picture`));
    assert.deepEqual(visit.problems, []);
    await visit.close();
  }
  await site.stop();
});

const BESIDE = { route: /api\/v1\/(surroundings\.glb|skin\/1000000\/)/, address: 'api/v1/skin/1000000' };
const MARKERS = { route: '**/api/v1/surroundings.glb*', address: 'api/v1/surroundings.glb' };
const NOTHING_LEFT_OUT = (covered) => new Uint8Array(covered.length);

const ROBOT = `<robot name="arm"><link name="base"><visual><geometry><cylinder radius="0.12" length="0.5"/></geometry>
  <material name="m"><color rgba="0.2 0.5 0.7 1"/></material></visual></link>
  <link name="upper"><visual><origin xyz="0 0 0.3"/><geometry><box size="0.12 0.16 0.6"/></geometry></visual></link>
  <link name="hand"><visual><geometry><sphere radius="0.11"/></geometry></visual></link>
  <joint name="shoulder" type="fixed"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.25" rpy="0.5 0 0"/></joint>
  <joint name="wrist" type="fixed"><parent link="upper"/><child link="hand"/><origin xyz="0 0 0.7"/></joint></robot>`;

test('a robot and a reference pose cover the same pixels on the page and in the picture', async () => {
  const file = await record('lift', 1, []), robot = join(folder, 'arm.urdf');
  await writeFile(robot, ROBOT);
  const options = ['--robot', `${robot}@0.2,-0.6,40`, '--ghost', 'demo:overhead@1.5', '--ghost_opacity', '0.5'];
  const site = await serve(file, ['--loop', ...options, '--pictures', 'off']);
  const { page, covered, size, close } = await whatCovers(site, 'front', BESIDE, { 'status-word': 'Recording' });
  await saveScreenshot(page, 'same_beside');
  const sameCamera = await cameraOf(page, 'front', size), rest = `shadows,${MARKS}`;
  const draw = (hidden, more) => serverPixels(file, sameCamera, size, [...PLAIN, hidden, ...more]);
  const [all, alone, nothing] = [await draw(rest, options), await draw(rest, []), await draw(`body,${rest}`, [])];
  // In front of a person, a ghost of nearly the same grey cannot be told from it.
  const { share, either } = overlap(covered, mask(all, alone), mask(alone, nothing));
  assert.ok(either > 0.02 * covered.length, `${either} pixels`);
  assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels are covered by both`);
  await close();
  await site.stop();
});

/** A ROS master on a free port: the environment of nodes that use it. */
async function startMaster() {
  const probe = createServer().listen(0, '127.0.0.1');
  await once(probe, 'listening');
  const { port } = probe.address();
  probe.close();
  const env = { ROS_MASTER_URI: `http://127.0.0.1:${port}`, ROS_IP: '127.0.0.1', ROS_HOME: folder, ROS_LOG_DIR: folder };
  const master = spawn('rosmaster', ['--core', '-p', `${port}`], { stdio: 'ignore', env: { ...process.env, ...env } });
  endWithTests(master);
  for (;;) {
    const socket = connect(port, '127.0.0.1');
    const isThere = await once(socket, 'connect').then(() => true, () => false);
    socket.destroy();
    if (isThere) return { env, stop: () => master.kill('SIGINT') };
    assert.equal(master.exitCode, null, 'the master does not start');
  }
}

/** Until the URDF of a robot has been read from the parameter server. */
async function robotIsThere(url) {
  for (;;) {
    const { ros } = await (await fetch(`${url}api/v1/diagnostics`)).json();
    if (ros.inputs['robot /arm_description'].used > 0) return;
    await setTimeout(100);
  }
}

/** How many files of what is beside the people a page has loaded. */
const loaded = () => performance.getEntriesByType('resource').filter(({ name, responseEnd }) =>
  name.includes('surroundings.glb') && responseEnd > 0).length;

test('markers and a robot of other ROS nodes cover the same pixels on the page, later too, and in a snapshot', async () => {
  const { env, stop } = await startMaster();
  const publisher = spawn(process.env.KINESCOPE_MARKER_PUBLISHER, [], { stdio: ['pipe', 'pipe', 'ignore'], env: { ...process.env, ...env } });
  endWithTests(publisher);
  const file = await record('n_pose', 1, []);
  const live = ['--loop', '--picture_size', '64x64'];
  const marked = ['--ros', 'required', '--marker_topics', '/samples', '--robot', 'ros:/arm_description'];
  const site = await serve(file, [...live, ...marked], env);
  await once(createInterface({ input: publisher.stdout }), 'line');  // it has a subscriber
  await robotIsThere(site.url);
  const { page, problems, close } = await openPage(site.url);
  await page.waitForFunction(() => performance.getEntriesByType('resource').some(({ name, responseEnd }) =>
    name.includes('surroundings.glb') && responseEnd > 0), null, LONG);
  assert.deepEqual(problems, []);
  await close();
  const shown = await whatCovers(site, 'front', MARKERS, { 'status-word': 'Recording' });
  await saveScreenshot(shown.page, 'same_markers');
  const sameCamera = await cameraOf(shown.page, 'front', shown.size), { madeMicros } = await stateOf(shown.page);
  const before = await shown.page.evaluate(loaded);
  publisher.stdin.write('go\n');
  while (await shown.page.evaluate(loaded) === before) await setTimeout(50);
  await shown.close();
  const query = `&t=${(madeMicros / 1e6).toFixed(6)}`;
  const former = await whatCovers(site, 'front', { ...MARKERS, query }, { 'status-word': 'Recording' });
  await saveScreenshot(former.page, 'same_markers_of_a_former_moment');
  await former.close();
  await site.stop();
  publisher.stdin.write('come back\n');
  // The markers have gone since, and the robot has moved: those of now would be found nowhere.
  const everywhere = NOTHING_LEFT_OUT(shown.covered);
  for (const [one, other] of [[shown.covered, former.covered], [former.covered, shown.covered]]) {
    const { share } = found(one, other, everywhere, shown.size);
    assert.ok(share >= 0.99, `${share.toFixed(4)} of the pixels are where they were`);
  }
  const snapshot = async (options, itsEnv) => {
    const { url, stop: stopIt } = await serve(file, [...live, ...sameCamera, ...options], itsEnv);
    if (options.length > 0) await robotIsThere(url);
    const watcher = await openPage(url);
    await watcher.page.waitForFunction((wanted) => {
      const isRecording = document.getElementById('status-word').textContent.startsWith('Recording');
      return isRecording && performance.getEntriesByType('resource').some(({ name, responseEnd }) =>
        name.includes(wanted) && responseEnd > 0);
    }, options.length > 0 ? 'surroundings.glb' : 'api/v1/skin', LONG);
    await watcher.close();
    const { width, height } = shown.size;
    const png = await fetch(`${url}api/v1/snapshot.png?width=${width}&height=${height}`);
    const pixels = pixelsOfPng(Buffer.from(await png.arrayBuffer()));
    await stopIt();
    return pixels;
  };
  const inPicture = mask(await snapshot(marked, env), await snapshot([]));
  const legend = onlyMiddle(shown.size);
  const pairs = [['page', shown.covered, 'picture', inPicture], ['picture', inPicture, 'page', shown.covered]];
  for (const [name, one, otherName, other] of pairs) {
    const { share, count } = found(one, other, legend, shown.size);
    assert.ok(count > 0.01 * legend.length, `${count} pixels`);
    assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels on the ${name} are within a pixel of those of the ${otherName}`);
  }
  publisher.kill();
  stop();
});

test('a camera of another node is over a corner of the view, says when it is old, and is none of a former moment', async () => {
  const { env, stop } = await startMaster();
  const publisher = spawn(process.env.KINESCOPE_MARKER_PUBLISHER, [], { stdio: ['pipe', 'pipe', 'ignore'], env: { ...process.env, ...env } });
  endWithTests(publisher);
  const site = await serve('demo:walk', ['--ros', 'required', '--pictures', 'off', '--marker_topics', '/lab/image_raw'], env);
  const { page, problems, close } = await openPage(site.url);
  const image = page.getByRole('img', { name: 'Camera lab/image_raw' });
  await image.waitFor();
  await page.waitForFunction(() => document.querySelector('#camera-images img').naturalWidth === 160, null, LONG);
  const orange = await image.evaluate((shown) => {
    const canvas = document.createElement('canvas');
    canvas.width = shown.naturalWidth;
    canvas.height = shown.naturalHeight;
    const context = canvas.getContext('2d');
    context.drawImage(shown, 0, 0);
    return [...context.getImageData(20, 60, 1, 1).data];
  });
  assert.ok(orange[0] > 240 && Math.abs(orange[1] - 120) < 15 && orange[2] < 20, `${orange}`);
  await page.getByText('No new picture: lab/image_raw').waitFor();  // it was published once
  await saveScreenshot(page, 'camera_images');
  await page.getByRole('button', { name: 'One sample back' }).click();
  await image.waitFor({ state: 'hidden' });
  await page.getByRole('button', { name: 'Live', exact: true }).click();
  await image.waitFor();
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
  publisher.kill();
  stop();
});

test('the scene is over the image of a camera, as it sees it, alike on the page and in the picture', async () => {
  const { env, stop } = await startMaster();
  const publisher = spawn(process.env.KINESCOPE_MARKER_PUBLISHER, [], { stdio: ['pipe', 'pipe', 'ignore'], env: { ...process.env, ...env } });
  endWithTests(publisher);
  const site = await serve('demo:n_pose', ['--ros', 'required', '--marker_topics', '/lab/image_raw(scene=1)'], env);
  const { page, problems, close } = await openPage(site.url);
  const canvas = page.locator('#camera-images canvas');
  const covered = () => canvas.evaluate((shown) => {
    const { width, height } = shown;
    const { data } = shown.getContext('2d').getImageData(0, 0, width, height);
    return { width, height, pixels: Array.from({ length: width * height }, (_, i) => (data[4 * i + 3] > 127 ? 1 : 0)) };
  });
  await page.waitForFunction(() => document.querySelector('#camera-images canvas')?.width > 200, null, LONG);
  const enlarge = page.getByRole('button', { name: 'Enlarge camera lab/image_raw' });
  await enlarge.click();
  await page.mouse.move(0, 0);
  assert.equal(await enlarge.getAttribute('aria-pressed'), 'true');
  await page.waitForFunction(() => document.querySelector('#camera-images canvas').width > 400, null, LONG);
  await page.waitForFunction(() => performance.getEntriesByType('resource').some(({ name, responseEnd }) =>
    name.includes('api/v1/skin') && responseEnd > 0), null, LONG);
  await settled(page, '#camera-images figure');
  const seen = await covered();
  assert.ok(await page.locator('#camera-images figure').evaluate((figure) => {
    const image = figure.querySelector('img').getBoundingClientRect(), over = figure.querySelector('canvas').getBoundingClientRect();
    return Math.abs(image.width - over.width) < 2 && Math.abs(image.height - over.height) < 2 && Math.abs(image.top - over.top) < 2;
  }));
  await saveScreenshot(page, 'scene_over_image');

  // In the picture the image is at the right edge; its left half is orange, which gives its place.
  const { data, width } = pixelsOfPng(Buffer.from(await (await fetch(`${site.url}api/v1/snapshot.png?width=1280&height=720`)).arrayBuffer()));
  const colorAt = (x, y) => [0, 1, 2].map((i) => data[4 * (y * width + x) + i]);
  const isOf = (color, wanted) => color.every((value, i) => Math.abs(value - wanted[i]) < 12);
  const orange = [];
  for (let y = 0; y < 720; ++y) for (let x = 640; x < width; ++x) if (isOf(colorAt(x, y), [255, 120, 0])) orange.push([x, y]);
  const left = Math.min(...orange.map(([x]) => x)), top = Math.min(...orange.map(([, y]) => y));
  const pane = { width: 282, height: 211 };  // 22 % of the width of the picture
  const isOfScene = (x, y) => {
    const color = colorAt(left + Math.round(x * (pane.width - 1)), top + Math.round(y * (pane.height - 1)));
    return !isOf(color, [255, 120, 0]) && !isOf(color, [255, 255, 255]);
  };
  let same = 0, all = 0, ofScene = 0;
  for (let y = 0.01; y < 0.85; y += 0.01) {  // above the name
    for (let x = 0.01; x < 0.99; x += 0.01) {
      if (Math.abs(x - 0.5) < 0.01) continue;  // where orange meets white
      const onPage = seen.pixels[Math.floor(y * seen.height) * seen.width + Math.floor(x * seen.width)] === 1;
      const inPicture = isOfScene(x, y);
      all += 1;
      ofScene += inPicture ? 1 : 0;
      same += onPage === inPicture ? 1 : 0;
    }
  }
  assert.ok(ofScene > 0.05 * all, `${ofScene} of ${all}`);
  assert.ok(same > 0.97 * all, `${same} of ${all} places alike; ${ofScene} are of the scene`);
  assert.deepEqual(problems, []);
  await close();
  await site.stop();
  publisher.kill();
  stop();
});

/** The share of the pixels of `one` that `other` covers, or a pixel beside them: lines are not much wider than that. */
function found(one, other, leftOut, { width }) {
  const beside = [-1, 0, 1].flatMap((dy) => [-1, 0, 1].map((dx) => dy * width + dx));
  const pixels = [...one.keys()].filter((i) => one[i] && !leftOut[i]);
  return { share: pixels.filter((i) => beside.some((step) => other[i + step])).length / pixels.length, count: pixels.length };
}

/** What is left out: a snapshot has texts on its sides, and a legend in the lower left corner, which names the markers. */
const onlyMiddle = ({ width, height }) => new Uint8Array(width * height).map((_, i) => {
  const x = i % width, y = Math.floor(i / width);
  const isLegend = x < 0.4 * width && y > 0.4 * height;
  return isLegend || Math.abs(x - width / 2) > 0.25 * width || y < 0.1 * height ? 1 : 0;
});

/** Pixels of the fourth colour of trails, a pale blue that nothing else has; low loads are more green than blue. */
const paleBlue = ({ data }) => data.reduce((count, red, i) => {
  const green = data[i + 1], blue = data[i + 2];
  return count + (i % 4 === 0 && blue - red > 60 && blue - green > 20 && blue - green < 90 && green - red > 35 ? 1 : 0);
}, 0);

test('the path of a hand is drawn behind it, on the page and in a snapshot', async () => {
  const trails = ['--trail', 'pelvis,l5,l3,right_hand', '--trail_secs', '6'];
  const counts = [];
  for (const options of [[], trails]) {
    const site = await serve('demo:lift', [...options, '--picture_size', '64x64']);
    const { page, problems, close } = await openPage(site.url, { colorScheme: 'dark' });
    await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live', null, LONG);
    // The third time of a picture: the hand has moved.
    for (let seen = 0; options.length > 0 && seen < 3;) if (paleBlue(await pixelsOf(page, '#view')) > 60) seen += 1;
    const snapshot = await fetch(`${site.url}api/v1/snapshot.png?theme=dark`);
    const drawn = pixelsOfPng(Buffer.from(await snapshot.arrayBuffer()));
    counts.push([paleBlue(await pixelsOf(page, '#view')), paleBlue(drawn)]);
    await saveScreenshot(page, `same_trail_${options.length > 0}`);
    assert.deepEqual(problems, []);
    await close();
    await site.stop();
  }
  const [without, withTrails] = counts;
  withTrails.forEach((count, i) => assert.ok(count > without[i] + 60, `${counts}`));
});
