// Wires the page: connection -> scene, readings, load list, picture.
import { cameraLabel, centimetres, hexColor, kilonewtons, latency, rate, shortCameraLabel, timeCode }
  from './format.js';
import { RecentValues } from './clock.js';
import { Connection } from './connection.js';
import { mountDiagnostics, problemLines } from './diagnostics.js';
import { heldText, mountHandLoad } from './hand_load.js';
import { lampOf } from './lamp.js';
import { fillLegend, mountLoadList, rowsOf } from './load_list.js';
import { PicturePanel } from './picture_panel.js';
import { Scene } from './scene.js';
import { decodeState } from './state_codec.js';

const READINGS_MILLIS = 150;  // faster than that nobody reads
const NOTICE_MILLIS = 6000;
const MODEL_RETRY_MILLIS = 1000;
const DIAGNOSTICS_MILLIS = 3000;
const START_VIEW = 'three_quarter';

const element = (/** @type {string} */ id) => /** @type {any} */ (document.getElementById(id));

/** @type {import('./state_codec.js').State|null} */
let state = null;
/** @type {ArrayBuffer|null} */
let newest = null;  // not decoded yet: of several that come between two frames, only the last is
let stateChangedAt = 0;  // browser clock, when the number grew last
let details = { source: '', camera: '', has_pictures: true, people: /** @type {any[]} */ ([]),
  objects: /** @type {any[]} */ ([]) };
/** @type {any} */
let model = null;
let modelAskedAt = -Infinity;
let notice = { text: '', until: 0 };
const latencies = new RecentValues();

forgetTokenInAddress();
const scene = makeScene();
const showLoads = mountLoadList(element('loads'));
const showProblems = mountDiagnostics(element('diagnostics'), element('problems'));
const connection = new Connection({
  onState: (buffer) => { newest = buffer; },
  onPicture: (buffer) => picture.show(buffer),
  onDetails(told) {
    details = told;
    picture.setDetails(told);
    scene?.setObjectNames(told.objects);
  },
  onError: say,
  onOpen() {
    picture.ask();
    loadCameras();
  },
});
const picture = new PicturePanel({
  image: element('picture-image'), note: element('picture-note'), on: element('picture-on'),
  camera: element('picture-camera'), save: element('save-picture'),
}, (command) => connection.send(command), say);
mountHandLoad({ form: element('hand-load'), hand: element('hand'), mass: element('hand-kg') },
  () => details.people[0], say);
// Pictures cost the server drawing and a phone its data: there they are asked for by hand.
element('picture-on').checked = scene === null || matchMedia('(min-width: 900px)').matches;
requestAnimationFrame(onFrame);
setInterval(showReadings, READINGS_MILLIS);
setInterval(loadDiagnostics, DIAGNOSTICS_MILLIS);
loadDiagnostics();

/** The cookie is set; the token need not stay in history and bookmarks. */
function forgetTokenInAddress() {
  const url = new URL(location.href);
  if (!url.searchParams.has('token')) return;
  url.searchParams.delete('token');
  history.replaceState(null, '', url);
}

function makeScene() {
  try {
    return new Scene(element('view'), { onOrbit: () => markView('') });
  } catch {
    const note = document.createElement('p');
    note.className = 'no-webgl';
    note.textContent = 'This browser offers no WebGL. The server’s own picture shows the human instead.';
    element('view').append(note);
    return null;
  }
}

/** @param {string} text */
function say(text) {
  notice = { text, until: performance.now() + NOTICE_MILLIS };
}

/** @param {number} now */
function onFrame(now) {
  requestAnimationFrame(onFrame);
  const isNewSample = takeNewest(now);
  if (scene?.draw(now) !== true || !isNewSample || state === null) return;
  const serverNow = connection.clock.at(performance.now());
  if (state.arrivalMicros > 0 && serverNow !== null && state.liveness === 'live') {
    latencies.add(serverNow - state.arrivalMicros / 1000, performance.now());
  }
}

/** @param {number} now
 *  @returns {boolean} whether it shows another sample than before */
function takeNewest(now) {
  if (newest === null) return false;
  const buffer = newest;
  newest = null;
  const before = state?.number;
  try {
    state = decodeState(buffer);
  } catch (error) {
    say(/** @type {Error} */ (error).message);
    return false;
  }
  if (state.number !== before) stateChangedAt = now;
  scene?.update(state, lampNow().level === 'live');
  if (model === null || state.people.some((person) => scene && !scene.hasModelOf(person))) loadModel(now);
  return state.number !== before;
}

function lampNow() {
  const now = performance.now();
  const serverNow = connection.clock.at(now);
  let ageMillis = null;
  if (state && state.arrivalMicros > 0 && serverNow !== null) {
    ageMillis = serverNow - state.arrivalMicros / 1000;
  } else if (state && state.liveness === 'stale') {
    ageMillis = now - stateChangedAt;
  }
  return lampOf({
    connected: connection.connected,
    everConnected: connection.everConnected,
    silentMillis: connection.silentMillis(now),
    liveness: state?.liveness ?? null,
    ageMillis,
    source: details.source,
    reason: connection.refusal,
  });
}

/** @param {number} now */
async function loadModel(now) {
  if (now - modelAskedAt < MODEL_RETRY_MILLIS) return;
  modelAskedAt = now;
  try {
    const answer = await fetch('api/model');
    if (!answer.ok) throw new Error((await answer.json()).error);
    model = await answer.json();
    applyPalette(model.palette);
    fillLegend(element('legend'), model.class_limits);
    scene?.setModel(model);
    if (state) scene?.update(state, lampNow().level === 'live');
  } catch (error) {
    say(`The human’s model did not load: ${/** @type {Error} */ (error).message}`);
  }
}

/** Asked for seldom, and only while somebody looks. */
async function loadDiagnostics() {
  if (document.hidden) return;
  const answer = await fetch('api/diagnostics').catch(() => null);  // the lamp tells of a server that is gone
  if (!answer?.ok) return;
  showProblems(problemLines(await answer.json(), scene?.failedMeshes ?? []));
}

/** The class colours come from the server, so that page, picture and RViz cannot differ.
 *  @param {import('./human.js').Palette} palette */
function applyPalette(palette) {
  const style = document.documentElement.style;
  for (const { name, color } of palette.classes) style.setProperty(`--class-${name}`, hexColor(color));
  style.setProperty('--com', hexColor(palette.com));
  style.setProperty('--cop', hexColor(palette.cop));
  style.setProperty('--support', hexColor(palette.support));
}

async function loadCameras() {
  const answer = await fetch('api/cameras').catch(() => null);
  if (!answer?.ok) return;
  const { cameras, live } = await answer.json();
  picture.setCameras(cameras);
  element('picture-camera').value = live;
  if (element('cameras').childElementCount > 0) return;  // a reconnection keeps the viewer's camera
  element('cameras').replaceChildren(...cameras.map(cameraButton));
  const start = cameras.find((/** @type {any} */ { name }) => name === START_VIEW) ?? cameras[0];
  if (start) chooseView(start);
}

/** @param {import('./cameras.js').CameraView} view */
function cameraButton(view) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = shortCameraLabel(view.name);
  button.title = cameraLabel(view.name);
  button.ariaLabel = cameraLabel(view.name);
  button.dataset.camera = view.name;
  button.ariaPressed = 'false';
  button.addEventListener('click', () => chooseView(view));
  return button;
}

/** @param {import('./cameras.js').CameraView} view */
function chooseView(view) {
  scene?.setView(view);
  markView(view.name);
}

/** @param {string} name  "" when the user turned the view by hand */
function markView(name) {
  for (const button of element('cameras').children) {
    button.ariaPressed = String(button.dataset.camera === name);
  }
}

function showReadings() {
  const now = performance.now();
  if (document.hidden) takeNewest(now);  // no frames there, but the title still tells how it stands
  const lamp = lampNow();
  const isLive = lamp.level === 'live';
  if (element('lamp').dataset.level !== lamp.level && state) scene?.update(state, isLive);
  element('lamp').dataset.level = lamp.level;
  setText('lamp-word', lamp.word);
  document.title = `${lamp.word} · Kinescope`;
  const meshes = scene?.failedMeshes.length ?? 0;
  const banner = (now < notice.until && notice.text) || lamp.banner
    || (meshes > 0 ? `${meshes} of the human’s meshes could not be loaded` : '');
  setText('banner', banner);
  element('banner').hidden = banner === '';
  element('banner').dataset.level = lamp.level;
  if (!isLive) latencies.clear();
  const summary = latencies.summary(now);
  setText('rate', isLive && state ? rate(state.rateHz) : '–');
  setText('latency', latency(summary?.median ?? null));
  setText('latency-p95', summary ? `p95 ${latency(summary.p95)}` : '');
  setText('sample', state && state.liveness !== 'no data' ? String(state.counter) : '–');
  setText('time-code', state && state.liveness !== 'no data' ? timeCode(state.timeCodeMillis) : '–');
  setText('source', details.source);
  setText('viewers', state ? `${state.viewers} ${state.viewers === 1 ? 'viewer' : 'viewers'}` : '');
  showPeople(isLive);
}

/** @param {boolean} isLive */
function showPeople(isLive) {
  if (state === null || model === null) return;
  const rows = rowsOf(state, model.joints, details);
  showLoads(isLive ? rows : rows.map(asUnknown));
  const person = state.people[0];
  const told = details.people.find(({ character }) => character === person?.character);
  const hint = person ? loadsHint(person, told) : '';
  setText('loads-hint', hint);
  element('loads-hint').title = hint;
  element('loads-hint').classList.toggle('warn', told?.mass_is_assumed === true || person?.comDisagrees === true);
  setText('com', person ? comText(person) : 'Centre of mass');
  setText('cop', person ? copText(person, told) : 'Centre of pressure');
  setText('support', isLive && person && Number.isFinite(person.margin)
    ? `Margin of stability ${centimetres(person.margin)}` : 'Support of the feet');
  const compression = isLive && person ? person.compression : NaN;
  element('compression-row').hidden = !Number.isFinite(compression);
  setText('compression', Number.isFinite(compression) ? `L5/S1 compression ${kilonewtons(compression)}` : '');
}

/** What the numbers are, and what they stand on.
 *  @param {import('./state_codec.js').Person} person
 *  @param {any} told */
function loadsHint(person, told) {
  const motion = person.metric === 'external' ? '' : person.isDynamic ? ', dynamic' : ', static';
  return [
    `${person.metric}${motion}`,
    told?.mass_is_assumed ? `mass assumed ${told.mass_kg} kg` : '',
    heldText(told?.hand_load),
    person.comDisagrees ? `centre of mass ${centimetres(person.comDifference)} from MVN’s` : '',
    told?.why_other_metric ?? '',
  ].filter(Boolean).join(' · ');
}

/** @param {import('./state_codec.js').Person} person */
const comText = (person) => (person.comIsOurs ? 'Centre of mass (body model)' : 'Centre of mass');

/** @param {import('./state_codec.js').Person} person
 *  @param {any} told */
function copText(person, told) {
  if (person.cop) return person.groundIsMeasured ? 'Centre of pressure (measured)' : 'Centre of pressure';
  return `Centre of pressure: ${told?.why_no_ground || 'unknown'}`;
}

/** What is not live has no load that could be trusted.
 *  @param {import('./load_list.js').Row} row
 *  @returns {import('./load_list.js').Row} */
const asUnknown = (row) =>
  ({ ...row, loadClass: 'unknown', ratio: NaN, moment: NaN, reason: row.reason || 'no live data' });

/** @param {string} id
 *  @param {string} text */
function setText(id, text) {
  const part = element(id);
  if (part.textContent !== text) part.textContent = text;
}
