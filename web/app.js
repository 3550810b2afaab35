// Connects the parts of the page: connection -> scene, readings, load list, picture.
import { forgetToken, showInAddress, shownIn } from './address.js';
import { RecentValues } from './clock.js';
import { Connection } from './connection.js';
import { mountDiagnostics, problemLines } from './diagnostics.js';
import { findElements } from './elements.js';
import { cameraLabel, hexColor, shortCameraLabel } from './format.js';
import { mountHandLoad } from './hand_load.js';
import { LookBack } from './look_back.js';
import { leftOutText, showsLive, statusOf } from './status.js';
import { mountLoadsShown } from './loads_shown.js';
import { asUnknown, fillLegend, mountLoadList, rowsOf } from './load_list.js';
import { readCameras, readDiagnostics, readModel, readTextMessage } from './messages.js';
import { PicturePanel } from './picture_panel.js';
import { mountRole } from './role.js';
import { meshesText, readingsOf, streamReadingsOf } from './readings.js';
import { Scene } from './scene.js';
import { ask, messageOf } from './server_api.js';
import { decodePast, decodeState } from './state_codec.js';
import { StreamPanel } from './stream_panel.js';
import { mountTransport } from './transport.js';
import { ViewerTime } from './viewer_time.js';

const READINGS_MILLIS = 150;  // faster changes cannot be read
const NOTICE_MILLIS = 6000;
const MODEL_RETRY_MILLIS = 1000;
const DIAGNOSTICS_MILLIS = 3000;
const ADDRESS_MILLIS = 500;  // browsers permit a few changes of the address per second
const START_VIEW = 'three_quarter';

const elements = findElements(document);

/** @type {import('./state_codec.js').State|null} */
let state = null;  // the live one
/** @type {ArrayBuffer|null} */
let newest = null;  // not decoded yet: of the states received between two frames, only the last one is decoded
let stateChangedAt = 0;  // browser clock, last time its number grew
/** @type {import('./messages.js').Details} */
let details = { source: '', camera: '', has_pictures: true, people: [], objects: [], left_out: [] };
/** @type {import('./messages.js').Model|null} */
let model = null;
let modelAskedAt = -Infinity;
let notice = { text: '', until: 0 };
const time = new ViewerTime();
// What a viewer who looks back sees; null: live.
/** @type {{state: import('./state_codec.js').State, details: import('./messages.js').Details}|null} */
let past = null;
let askedMicros = NaN;  // of the moment last asked for
let addressAt = 0;
let linkedMicros = shownIn(new URL(location.href)).micros;  // of the address with which the page was opened
forgetToken();
const lookBack = new LookBack((command) => connection.send(command));
const latencies = new RecentValues();

const scene = makeScene();
const showLoads = mountLoadList(elements.loads);
const loadRole = mountRole(elements.role, showNotice);
const stream = new StreamPanel({ details: elements.stream, line: elements['stream-line'], rows: elements['stream-rows'] });
const showProblems = mountDiagnostics(elements.diagnostics, elements.problems);
const connection = new Connection({
  onState: (buffer) => { newest = buffer; },
  onPicture: (buffer) => picture.show(buffer),
  onPast,
  onDetails(newDetails) {
    details = newDetails;
    picture.setDetails(details);
    scene?.setObjectNames(details.objects);
    handLoad.setPeople(details.people);
  },
  onStream: (health) => stream.set(health),
  onError: showNotice,
  onOpen() {
    picture.ask();
    loadRole();
    loadCameras();
  },
});
const picture = new PicturePanel({
  image: elements['picture-image'], note: elements['picture-note'], on: elements['picture-on'],
  camera: elements['picture-camera'], save: elements['save-picture'],
}, (command) => connection.send(command), showNotice);
const handLoad = mountHandLoad({
  form: elements['hand-load'], person: elements['hand-person'], hand: elements.hand, mass: elements['hand-kg'],
}, showNotice);
const showTransport = mountTransport({
  bar: elements.transport, play: elements.play, back: elements['step-back'], forward: elements['step-forward'],
  speed: elements.speed, slider: elements.moment, oldest: elements.oldest, live: elements['go-live'],
}, time, { kept, shown: () => millisOf(shown()), step: stepBy, changed: onTimeChanged });
elements.status.addEventListener('click', () => {
  time.goLive();
  onTimeChanged();
});
const loadsShown = mountLoadsShown(elements['loads-shown'], applyLook);
// Pictures cost the server rendering time and a phone its data volume. On a small screen the user switches them on.
elements['picture-on'].checked = scene === null || matchMedia('(min-width: 900px)').matches;
requestAnimationFrame(onFrame);
setInterval(showReadings, READINGS_MILLIS);
setInterval(loadDiagnostics, DIAGNOSTICS_MILLIS);
loadDiagnostics();

function makeScene() {
  try {
    return new Scene(elements.view, { onOrbit: () => markView('') });
  } catch {
    const note = document.createElement('p');
    note.className = 'no-webgl';
    note.textContent = 'WebGL is not available. Showing the picture rendered by the server.';
    elements.view.append(note);
    return null;
  }
}

/** @param {string} text */
function showNotice(text) {
  notice = { text, until: performance.now() + NOTICE_MILLIS };
}

/** @param {number} now */
function onFrame(now) {
  requestAnimationFrame(onFrame);
  const isNewSample = takeNewest(now);
  askForMoment(now);
  if (scene?.draw(now) !== true || !isNewSample || state === null || past !== null) return;
  const serverNow = connection.clock.at(performance.now());
  if (state.arrivalMicros > 0 && serverNow !== null && state.liveness === 'live') {
    latencies.add(serverNow - state.arrivalMicros / 1000, performance.now());
  }
}

/** @param {number} now
 *  @returns {boolean} whether the state has another sample than before */
function takeNewest(now) {
  if (newest === null) return false;
  const buffer = newest;
  newest = null;
  const before = state?.stateNumber;
  try {
    state = decodeState(buffer);
  } catch (error) {
    showNotice(messageOf(error));
    return false;
  }
  if (state.stateNumber !== before) stateChangedAt = now;
  if (linkedMicros !== null) goToLinkedMoment();
  if (past === null) updateScene();
  if (model === null || state.people.some((person) => scene && !scene.hasModelOf(person))) loadModel(now);
  return state.stateNumber !== before;
}

/** What the viewer sees: the live state, or a former one. */
const shown = () => past?.state ?? state;

/** @param {import('./state_codec.js').State|null} of
 *  @returns {number|null} its moment in the server's history */
const millisOf = (of) => (of ? of.madeMicros / 1000 : null);

/** @returns {import('./viewer_time.js').Kept|null} null: the server keeps none */
function kept() {
  if (state === null || state.oldestMicros === 0) return null;
  return { oldest: state.oldestMicros / 1000, newest: state.madeMicros / 1000 };
}

/** Whether what is shown was live at its moment. */
const wasLive = () => (past ? past.state.liveness === 'live' : showsLive(statusNow().level));

function updateScene() {
  const now = shown();
  if (now) scene?.update(now, wasLive());
}

function onTimeChanged() {
  const isLive = time.isLive;
  if (isLive && past === null) return;
  document.body.dataset.time = isLive ? 'live' : 'behind';
  picture.setLive(isLive);
  if (isLive) {
    showInAddress({ micros: null });
    past = null;
    askedMicros = NaN;
    lookBack.stop();
  } else if (past === null && state) {
    past = { state, details };  // stays on the screen until the server has answered
    latencies.clear();
  }
  updateScene();
  showReadings();
}

/** The address was copied from that of another viewer. */
function goToLinkedMoment() {
  const range = kept(), moment = (linkedMicros ?? 0) / 1000;
  linkedMicros = null;
  if (range === null) return showNotice('This server keeps no former moments: this is live');
  if (moment > range.newest) return showNotice('The moment of this link is not on this server: this is live');
  if (moment < range.oldest) showNotice('The moment of this link is no longer kept: this is the oldest one');
  time.seek(moment, performance.now(), range);
  onTimeChanged();
}

/** @param {number} now */
function askForMoment(now) {
  const range = kept();
  if (time.isLive || range === null) return;
  const micros = Math.round(1000 * time.momentAt(now, range));
  if (time.isLive) return onTimeChanged();  // it has caught up
  if (micros === askedMicros) return;
  askedMicros = micros;
  lookBack.ask({ micros }, now);
}

/** @param {number} samples */
function stepBy(samples) {
  const from = shown(), range = kept();
  if (from === null || range === null) return;
  askedMicros = Math.round(1000 * time.momentAt(performance.now(), range));  // the answer says where the step leads
  lookBack.ask({ number: Math.max(0, from.stateNumber + samples) }, performance.now());
}

/** @param {ArrayBuffer} buffer */
function onPast(buffer) {
  const now = performance.now();
  const answer = decodePast(buffer);
  if (!lookBack.onAnswer(answer.id, now) || past === null) return;
  const message = readTextMessage(answer.details);
  past = { state: answer.state, details: message && 'details' in message ? message.details : details };
  const range = kept();
  if (!time.isPlaying && range) {
    // To the sample itself, so that a step leads to another one.
    if (!time.isGone(now, range)) time.pause(now, range, answer.state.madeMicros / 1000);
    askedMicros = Math.round(answer.state.madeMicros);
  }
  updateScene();
}

/** @param {number} now
 *  @returns {number|null} of the newest sample; null: not known */
function ageMillisAt(now) {
  const serverNow = connection.clock.at(now);
  if (state && state.arrivalMicros > 0 && serverNow !== null) return serverNow - state.arrivalMicros / 1000;
  return state && state.liveness === 'stale' ? now - stateChangedAt : null;
}

function statusNow() {
  const now = performance.now();
  return statusOf({
    connected: connection.connected,
    everConnected: connection.everConnected,
    silentMillis: connection.silentMillis(now),
    liveness: state?.liveness ?? null,
    ageMillis: ageMillisAt(now),
    ...stream.lossAt(now),
    waitedMillis: state?.waitedMillis ?? 0,
    source: details.source,
    reason: connection.rejection,
    behindMillis: behindMillis(now),
    isGone: isGone(now),
  });
}

/** @param {number} now
 *  @returns {number|null} by which the viewer looks back; null: not */
function behindMillis(now) {
  const range = kept();
  return time.isLive || range === null ? null : range.newest - time.momentAt(now, range);
}

/** @param {number} now */
function isGone(now) {
  const range = kept();
  return range !== null && time.isGone(now, range);
}

/** @param {number} now */
async function loadModel(now) {
  if (now - modelAskedAt < MODEL_RETRY_MILLIS) return;
  modelAskedAt = now;
  try {
    const newModel = await ask('api/model', readModel);
    if (newModel === null) return;
    model = newModel;
    applyPalette(model.palette);
    applyClassLimits(model.class_limits);
    scene?.setModel(model);
    applyLook();
  } catch (error) {
    showNotice(`Could not load the body model: ${messageOf(error)}`);
  }
}

function applyLook() {
  if (model === null) return;
  scene?.setLook({ ...model.look, loads: loadsShown(model.look.loads) });
  updateScene();
}

/** Requested at long intervals, and only while the page is visible. */
async function loadDiagnostics() {
  if (document.hidden) return;
  try {
    const diagnostics = await ask('api/diagnostics', readDiagnostics);
    if (diagnostics) showProblems(problemLines(diagnostics, scene?.failedMeshes ?? []));
  } catch (error) {
    showProblems([`Could not load the diagnostics: ${messageOf(error)}`]);
  }
}

/** The class colours come from the server, so that they are the same in page, picture and RViz.
 *  @param {import('./messages.js').Palette} palette */
function applyPalette(palette) {
  const style = document.documentElement.style;
  for (const { name, color } of palette.classes) style.setProperty(`--class-${name}`, hexColor(color));
  style.setProperty('--com', hexColor(palette.com));
  style.setProperty('--cop', hexColor(palette.cop));
  style.setProperty('--support', hexColor(palette.support));
}

/** @param {number[]} limits  the load ratios at which a load becomes medium and high */
function applyClassLimits([mediumFrom, highFrom]) {
  const style = document.documentElement.style;
  style.setProperty('--medium-from', String(mediumFrom));
  style.setProperty('--high-from', String(highFrom));
  fillLegend(elements.legend, [mediumFrom, highFrom]);
}

async function loadCameras() {
  try {
    const answer = await ask('api/cameras', readCameras);
    if (answer) showCameras(answer);
  } catch (error) {
    showNotice(`Could not load the cameras: ${messageOf(error)}`);
  }
}

/** @param {import('./messages.js').Cameras} answer */
function showCameras({ cameras, framing, live }) {
  picture.setCameras(cameras);
  elements['picture-camera'].value = live;
  if (elements.cameras.childElementCount > 0) return;  // a reconnection keeps the camera that the viewer selected
  elements.cameras.replaceChildren(...cameras.map((view) => cameraButton(view, framing)));
  const start = cameras.find(({ name }) => name === START_VIEW) ?? cameras[0];
  if (start) chooseView(start, framing);
}

/** @param {import('./messages.js').CameraView} view
 *  @param {import('./messages.js').Framing} framing */
function cameraButton(view, framing) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = shortCameraLabel(view.name);
  button.title = cameraLabel(view.name);
  button.ariaLabel = cameraLabel(view.name);
  button.dataset.camera = view.name;
  button.ariaPressed = 'false';
  button.addEventListener('click', () => chooseView(view, framing));
  return button;
}

/** @param {import('./messages.js').CameraView} view
 *  @param {import('./messages.js').Framing} framing */
function chooseView(view, framing) {
  scene?.setView(view, framing);
  markView(view.name);
}

/** @param {string} name  "" after the user rotated the view by hand */
function markView(name) {
  for (const button of elements.cameras.children) {
    button.ariaPressed = String(button.getAttribute('data-camera') === name);
  }
}

function showReadings() {
  const now = performance.now();
  if (document.hidden) takeNewest(now);  // a hidden page has no animation frames, but its title still shows the status
  const status = statusNow();
  const isLive = showsLive(status.level);
  if (elements.status.dataset.level !== status.level) updateScene();
  showStatus(status, now);
  showTransport(now);
  stream.show(now, ageMillisAt(now), connection.clock.at(now));
  if (past !== null && !time.isPlaying && now - addressAt > ADDRESS_MILLIS) {
    addressAt = now;
    showInAddress({ micros: past.state.madeMicros });
  }
  if (!isLive) latencies.clear();
  const readings = streamReadingsOf(shown(), latencies.summary(now), isLive || past !== null);
  setText('rate', readings.rate);
  setText('latency', readings.latency);
  setText('latency-p95', readings.latencyP95);
  setText('sample', readings.sample);
  setText('time-code', readings.timeCode);
  setText('viewers', readings.viewers);
  setText('source', details.source);
  elements['loads-shown'].hidden = !scene?.hasSkins;  // without a skin there is nothing to choose
  showPeople(wasLive());
}

/** @param {import('./status.js').Status} status
 *  @param {number} now */
function showStatus(status, now) {
  const banner = (now < notice.until && notice.text) || status.banner || leftOutText(details.left_out)
    || meshesText(scene?.failedMeshes.length ?? 0);
  elements.status.dataset.level = status.level;
  setText('status-word', status.word);
  setText('status-note', status.note);
  document.title = `${status.word} · Kinescope`;
  setText('banner', banner);
  elements.banner.hidden = banner === '';
  elements.banner.dataset.level = status.level;
}

/** @param {boolean} isLive  whether what is shown is, or was */
function showPeople(isLive) {
  const now = shown(), texts = past?.details ?? details;
  if (now === null || model === null) return;
  const rows = rowsOf(now, model.joints, texts);
  showLoads(isLive ? rows : rows.map(asUnknown));
  const selected = handLoad.selected();
  const person = now.people.find(({ character }) => character === selected?.character) ?? now.people[0];
  const readings = readingsOf(person, texts.people.find(({ character }) => character === person?.character), isLive);
  setText('loads-hint', readings.hint);
  elements['loads-hint'].title = readings.hint;
  elements['loads-hint'].classList.toggle('warn', readings.isDoubtful);
  setText('com', readings.com);
  setText('cop', readings.cop);
  setText('support', readings.support);
  setText('compression', readings.compression);
  elements['compression-row'].hidden = readings.compression === '';
}

/** @param {keyof import('./elements.js').Elements} id
 *  @param {string} text */
function setText(id, text) {
  const part = elements[id];
  if (part.textContent !== text) part.textContent = text;
}
