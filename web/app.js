// Connects the parts of the page: connection -> scene, readings, load list, picture.
import { forgetToken, showInAddress, shownIn } from './address.js';
import { AlarmPanel } from './alarm_panel.js';
import { Alarms } from './alarms.js';
import { Announcer } from './announcer.js';
import { CameraBar } from './camera_bar.js';
import { CameraImages } from './camera_images.js';
import { Charts } from './charts.js';
import { ChosenPerson } from './chosen_person.js';
import { KinescopeClient } from './client.js';
import { RecentValues } from './clock.js';
import { Controls } from './controls.js';
import { mountDiagnostics, problemLines } from './diagnostics.js';
import { findElements } from './elements.js';
import { hexColor, limitPercent } from './format.js';
import { mountHandLoad } from './hand_load.js';
import { HeadNames } from './head_names.js';
import { mountKeyMap } from './key_map.js';
import { Keys } from './keys.js';
import { Layout } from './layout.js';
import { mountLinkButton } from './link_button.js';
import { leftOutText, statusOf } from './status.js';
import { LoadsChoice } from './loads_shown.js';
import { MarkPad } from './mark_pad.js';
import { Marks, symbolOf } from './marks.js';
import { asUnknown, fillLegend, mountLoadList, rowsOf } from './load_list.js';
import { readCameras, readDiagnostics, readModel } from './messages.js';
import { PersonCards } from './person_cards.js';
import { PicturePanel } from './picture_panel.js';
import { FIRST_JOINTS } from './plots.js';
import { mountRole } from './role.js';
import { meshesText, readingsOf, streamReadingsOf } from './readings.js';
import { Scene } from './scene.js';
import { ask, messageOf } from './server_api.js';
import { Shown } from './shown.js';
import { runs } from './state_codec.js';
import { StreamPanel } from './stream_panel.js';
import { Tabs } from './tabs.js';
import { theme } from './theme.js';
import { mountTransport } from './transport.js';
import { mountViewKeys } from './view_keys.js';

const READINGS_MILLIS = 150;  // faster changes cannot be read
const PAUSE_MILLIS = 700;  // readings that come as late: the page itself was busy, or asleep
const CATCH_UP_MILLIS = 2000;  // after that; the server sends newer states once it hears that those before were taken
const NOTICE_MILLIS = 6000;
const MODEL_RETRY_MILLIS = 1000;
const DIAGNOSTICS_MILLIS = 3000;
const ADDRESS_MILLIS = 500;  // browsers permit a few changes of the address per second
const SETTLED_MILLIS = 700;  // longer than any part of the page takes to show what has come

const elements = findElements(document);

let readingsAt = 0, drawnAt = 0, awakeSince = 0;  // browser clock
let stateChangedAt = 0;  // browser clock, last time its number grew
/** @type {import('./messages.js').Model|null} */
let model = null;
let modelAskedAt = -Infinity;
let classLimits = '';  // as they are shown
let hasDiagnostics = false;
/** @type {number|undefined} */
let serverStarted;  // µs since 1970
let unsettledAt = 0;  // browser clock, last time that something was still to come
let notice = { text: '', until: 0 };
const linked = shownIn(new URL(location.href));
theme?.choose(linked.theme);
const layout = new Layout(linked.view, document.body);
const keys = new Keys(document, () => layout.hasControls);
layout.follow(() => { elements['body-map'].tabIndex = layout.hasControls ? 0 : -1; });  // its page scrolls by keys
const person = new ChosenPerson();
person.choose(linked.person);
const shown = new Shown({
  send: (command) => connection.send(command), notice: showNotice, changed: onTimeChanged, arrived: updateScene,
}, linked);
if (linked.speed) shown.time.speed = linked.speed;
forgetToken();
const latencies = new RecentValues();

const scene = makeScene();
const cameras = new CameraBar(elements.cameras, scene, linked.camera, (camera) => connection.send({ camera }));
const headNames = new HeadNames(elements['head-names']);
const cards = new PersonCards(elements.people, layout.hasControls ? (character) => person.choose(character) : null,
  elements['class-shape'], layout.name === 'wall');
const announcer = new Announcer(elements.announcer);
const showLoads = mountLoadList(elements.loads);
const loadRole = mountRole(elements.role, showNotice);
const stream = new StreamPanel({ details: elements.stream, line: elements['stream-line'], rows: elements['stream-rows'] });
const showProblems = mountDiagnostics(elements.diagnostics, elements.problems);
const connection = new KinescopeClient({  // without onState: of the states between two frames, only the last one is decoded
  onPicture: (live) => picture.show(live),
  onPast: (past) => shown.onPast(past),
  onDetails(details) {
    shown.setNewestDetails(details);
    picture.setDetails(details);
    if (scene === null) cameras.mark(details.camera);
    scene?.setObjectNames(details.objects);
    handLoad.setPeople(details.people);
  },
  onStream: (health) => stream.set(health),
  onControls: (message) => controls.onMessage(message),
  onAlarms: (state) => alarms.set(state),
  onError: showNotice,
  onOpen() {
    shown.onConnected();
    picture.ask();
    controls.forget();
    loadRole().then((started) => {
      controls.setViewer(elements.role.dataset.role === 'viewer');
      meetServer(started);
    });
    loadCameras();
  },
});
const cameraImages = new CameraImages(elements['camera-images']);
const picture = new PicturePanel({
  image: elements['picture-image'], note: elements['picture-note'], on: elements['picture-on'],
  camera: elements['picture-camera'], save: elements['save-picture'],
}, (command) => connection.send(command), showNotice);
const handLoad = mountHandLoad({
  form: elements['hand-load'], person: elements['hand-person'], hand: elements.hand, mass: elements['hand-kg'],
}, showNotice);
const charts = new Charts(elements, shown, {
  model: () => model, failed: showNotice, person, serverMillis: () => connection.clock.at(performance.now()), canPress: layout.hasControls,
});
if (linked.joints) charts.plots.choose(linked.joints);
if (linked.window) charts.plots.chooseWindow(linked.window);
const showTransport = mountTransport({
  bar: elements.transport, play: elements.play, back: elements['step-back'], forward: elements['step-forward'],
  speed: elements.speed, slider: elements.moment, oldest: elements.oldest, live: elements['go-live'],
}, shown, (moment) => charts.wordsAt(moment), keys);
const marks = new Marks(() => {
  const flags = flagsOf(marks);
  charts.strip.setMarks(flags);
  charts.plots.setFlags(flags);
}, sessionStorage);
const markPad = new MarkPad({
  pad: elements['mark-pad'], buttons: elements['mark-buttons'], form: elements['mark-form'], text: elements['mark-text'],
  said: elements['mark-said'], undo: elements['mark-undo'], list: elements['mark-list'], earlier: elements['mark-earlier'],
}, marks, shown, {
  notice: showNotice, isViewer: () => elements.role.dataset.role === 'viewer', stateInView: () => (scene === null ? picture.state : null),
}, keys);
const controls = new Controls(elements, shown, showNotice);
const alarms = new Alarms();
const alarmPanel = new AlarmPanel({
  area: elements.alarm, stars: elements['alarm-stars'], head: elements['alarm-head'], detail: elements['alarm-detail'],
  told: elements['alarm-told'], acknowledge: elements.acknowledge, sound: elements['alarm-sound'],
  show: elements['alarm-show'], tab: elements['tab-alarms'], list: elements['alarm-list'], rate: elements['alarm-rate'],
  test: elements['alarm-test'],
}, alarms, shown, {
  notice: showNotice, jointLabel: (name) => model?.joints.find((joint) => joint.name === name)?.label ?? name,
  wallMillis: (micros) => charts.wallMillis(micros), newestMicros: () => shown.newest?.madeMicros ?? 0, canPress: layout.hasControls,
}, keys);
elements.status.addEventListener('click', () => {
  shown.time.goLive();
  shown.onTimeChanged();
});
const loadsShown = new LoadsChoice(elements['loads-shown'], linked.loads, applyLook);
const tabs = new Tabs(elements.tabs, [elements.side, document.body]);
layout.follow((name) => {
  placeTools(name === 'phone');
  tabs.settle();
});
addEventListener('resize', () => tabs.settle());  // a wide page has the plots beside the others, without a tab
if (linked.tab) tabs.choose(linked.tab);
scene?.setControls(layout.hasControls);
const copyLink = mountLinkButton(elements['copy-link'], () => ({ ...addressNow(), ...shown.link }), showNotice);
addKeys();
const lists = [elements['hand-person'], elements['control-person']];
person.follow(() => {
  for (const list of lists) {
    if ([...list.options].some(({ value }) => value === String(person.wanted))) list.value = String(person.wanted);
  }
  controls.refresh();
  showReadings();
});
for (const list of lists) list.addEventListener('change', () => { if (list.value !== '') person.choose(Number(list.value)); });
setInterval(() => showInAddress(addressNow()), ADDRESS_MILLIS);
requestAnimationFrame(onFrame);
setInterval(showReadings, READINGS_MILLIS);
setInterval(loadDiagnostics, DIAGNOSTICS_MILLIS);
loadDiagnostics();

function makeScene() {
  try {
    const { cameras: toolbar, points, 'loads-shown': loadsShown, 'camera-images': images, banner } = elements;
    return new Scene(elements.view, [toolbar, points, loadsShown, images, banner], { onOrbit: () => cameras.mark('') });
  } catch {
    const note = document.createElement('p');
    note.className = 'no-webgl';
    note.textContent = 'WebGL is not available. Showing the picture rendered by the server.';
    elements.view.append(elements['picture-frame'], note);
    elements.picture.classList.add('in-stage');
    return null;
  }
}

/** A server that was started again has other moments, and other bodies, marks and alarms under the same numbers.
 *  @param {number|undefined} started  µs since 1970; undefined: not known */
function meetServer(started) {
  const isOther = serverStarted !== undefined && started !== undefined && started !== serverStarted;
  serverStarted = started ?? serverStarted;
  if (!isOther) return;
  showNotice(`The server restarted${shown.time.isLive ? '' : ': the moment that you looked at is gone'}`);
  model = null;
  picture.forget();
  scene?.forget();
  elements.points.hidden = true;
  charts.forget();
  marks.forgetRevision();
  alarms.forget();
  latencies.clear();
  shown.time.goLive();
  shown.onTimeChanged();
}

/** On a phone, what the header has no room for is a panel, in reach of a thumb.
 *  @param {boolean} isPhone */
function placeTools(isPhone) {
  if (isPhone) elements.more.append(elements.about, elements.tools);
  else document.querySelector('.topbar')?.append(elements.about, elements.tools);
}

/** What the address says of this page; null: as the page has it by itself. */
function addressNow() {
  const joints = charts.plots.chosen;
  return {
    person: person.wanted, camera: cameras.text, window: charts.plots.window.isFirst ? null : charts.plots.window.secs,
    joints: joints.join() === FIRST_JOINTS.join() ? null : [...joints],
    loads: loadsShown.chosen, speed: shown.time.speed === 1 ? null : shown.time.speed,
    tab: tabs.isFirst ? null : tabs.name, view: linked.view, theme: theme?.wanted ?? null,
  };
}

function addKeys() {
  const people = () => shown.state?.people ?? [];
  const toggleDark = () => theme?.choose(theme.name === 'dark' ? 'light' : 'dark');
  const showDark = () => {
    const isDark = theme?.name === 'dark';
    elements.dark.ariaPressed = String(isDark);
    picture.setDark(isDark);
  };
  cameras.addKeys(keys);
  keys.add('View', 'P', 'The next person', () => person.step(people(), 1));
  keys.add('View', 'Shift+P', 'The previous person', () => person.step(people(), -1));
  keys.add('Page', 'D', 'Dark page, light page', toggleDark);
  keys.add('Page', 'C', 'Copy a link to this moment', () => { copyLink(); });
  if (scene) mountViewKeys(scene, keys);
  mountKeyMap({ dialog: elements['key-map'], list: elements['key-list'], open: elements['show-keys'], close: elements['close-keys'],
    characters: elements['character-keys'] }, keys);
  elements.dark.addEventListener('click', toggleDark);
  theme?.follow(showDark);
  showDark();
}

/** @param {string} text */
function showNotice(text) {
  notice = { text, until: performance.now() + NOTICE_MILLIS };
}

/** @param {number} now */
function onFrame(now) {
  requestAnimationFrame(onFrame);
  drawnAt = now;
  const isNewSample = takeNewest(now);
  shown.ask(now);
  const { newest } = shown;
  const isDrawn = scene?.draw(now) === true;
  if (scene && isDrawn) headNames.show(scene.heads(), shown.details.people);
  if (!isDrawn || !isNewSample || newest === null || !shown.isNewest) return;
  const serverNow = connection.clock.at(performance.now());
  if (newest.arrivalMicros > 0 && serverNow !== null && runs(newest)) {
    latencies.add(serverNow - newest.arrivalMicros / 1000, performance.now());
  }
}

/** @param {number} now
 *  @returns {boolean} whether the state has another sample than before */
function takeNewest(now) {
  const before = shown.newest?.stateNumber;
  try {
    const newest = connection.takeState();
    if (newest === null) return false;
    shown.setNewest(newest);
  } catch (error) {
    showNotice(messageOf(error));
    return false;
  }
  const state = shown.newest, isNew = state?.stateNumber !== before;
  if (isNew) stateChangedAt = now;
  if (shown.isNewest) updateScene();
  if (lacksModelOf(state)) loadModel(now);
  return isNew;
}

/** @param {import('./state_codec.js').State|null} state */
function lacksModelOf(state) {
  const bodies = state ? [...state.people, ...state.ghosts] : [];
  return model === null || bodies.some((person) => scene && !scene.hasModelOf(person));
}

/** Whether what is shown is of now, or was when it was the newest. */
const wasFresh = () => (shown.isNewest ? statusNow().isFresh : runs(shown.state));

function updateScene() {
  if (shown.state) scene?.update(shown.state, wasFresh());
}

/** What the server's picture shows of a viewer who looks back. */
const formerNow = () => (shown.isNewest || shown.state === null ? null
  : { state: shown.state.stateNumber, isPlaying: shown.time.isPlaying });

function onTimeChanged() {
  picture.setMoment(formerNow(), performance.now());
  if (!shown.isNewest) latencies.clear();
  updateScene();
  showReadings();
}

/** @param {number} now
 *  @returns {number|null} of the newest sample; null: not known */
function ageMillisAt(now) {
  const state = shown.newest, serverNow = connection.clock.at(now);
  if (now - awakeSince < CATCH_UP_MILLIS) return null;
  if (state && state.arrivalMicros > 0 && serverNow !== null) return serverNow - state.arrivalMicros / 1000;
  return state && state.liveness === 'stale' ? now - stateChangedAt : null;
}

function statusNow() {
  const now = performance.now(), state = shown.newest;
  return statusOf({
    connected: connection.connected,
    everConnected: connection.everConnected,
    silentMillis: Math.min(connection.silentMillis(now), now - awakeSince),  // not while the page could not hear
    liveness: state?.liveness ?? null,
    ageMillis: ageMillisAt(now),
    ...stream.lossAt(now),
    waitedMillis: state?.waitedMillis ?? 0,
    source: shown.newestDetails.source,
    reason: connection.rejection,
    behindMillis: shown.behindMillis(now),
    isGone: shown.isGone(now),
    recording: shown.newestDetails.recording,
    stampMicros: shown.state?.stampMicros,
  });
}

/** @param {number} now */
async function loadModel(now) {
  if (now - modelAskedAt < MODEL_RETRY_MILLIS) return;
  modelAskedAt = now;
  try {
    const newModel = await ask('api/v1/model', readModel);
    if (newModel === null) return;
    model = newModel;
    applyPalette(model.palette);
    scene?.setModel(model);
    applyLook();
  } catch (error) {
    showNotice(`Could not load the body model: ${messageOf(error)}`);
  }
}

/** @param {number} now */
async function loadMarks(now) {
  const revision = shown.newestDetails.marks_revision;
  elements['mark-pad'].hidden = revision === null;
  if (revision === null) return;
  marks.setPlayed(shown.newestDetails.recording, shown.newest);
  try {
    await markPad.sendWaiting(now);
    await marks.update(revision, now);
  } catch (error) {
    showNotice(`Could not load the marks: ${messageOf(error)}`);
  }
}

/** @param {number} now */
async function loadAlarms(now) {
  try {
    await alarms.update(now);
    charts.strip.setAlarms(alarms.log());
  } catch (error) {
    showNotice(`Could not load the alarms: ${messageOf(error)}`);
  }
}

/** What the strip shows of the marks whose moments it may have.
 *  @param {Marks} of */
const flagsOf = (of) => of.list().filter((mark) => of.hasMoment(mark)).map((mark) => ({
  micros: mark.at.micros, endMicros: mark.end?.micros ?? null, label: symbolOf(mark), text: mark.text, isTrial: mark.kind === 'trial',
}));

function applyLook() {
  if (model === null) return;
  scene?.setLook({ ...model.look, loads: loadsShown.of(model.look.loads), hidden: linked.hidden });
  updateScene();
}

/** Requested at long intervals, and only while the page is visible. */
async function loadDiagnostics() {
  if (document.hidden) return;
  try {
    const diagnostics = await ask('api/v1/diagnostics', readDiagnostics);
    hasDiagnostics = diagnostics !== null;
    stream.setFrame(diagnostics?.ros?.frame ?? '');
    if (diagnostics) showProblems(problemLines(diagnostics, scene?.failedMeshes ?? [], scene?.problems));
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
function applyClassLimits(limits) {
  const now = limits.join();
  if (now === classLimits) return;
  classLimits = now;
  const [mediumFrom, highFrom] = limits;
  const style = document.documentElement.style;
  style.setProperty('--medium-from', String(mediumFrom));
  style.setProperty('--high-from', String(highFrom));
  fillLegend(elements.legend, [mediumFrom, highFrom]);
  setText('kiosk-line', 'Percent of what a joint of a person of this size and sex can do: '
    + `from ${limitPercent(mediumFrom)} on the load is medium, from ${limitPercent(highFrom)} on it is high.`);
}

async function loadCameras() {
  try {
    const answer = await ask('api/v1/cameras', readCameras);
    if (answer) showCameras(answer);
  } catch (error) {
    showNotice(`Could not load the cameras: ${messageOf(error)}`);
  }
}

/** @param {import('./messages.js').Cameras} answer */
function showCameras(answer) {
  picture.setCameras(answer.cameras);
  elements['picture-camera'].value = answer.live;
  cameras.setCameras(answer);
}

function showReadings() {
  const now = performance.now();
  if (!document.hidden && now - readingsAt > PAUSE_MILLIS) awakeSince = now;  // a hidden page hears, and reads seldom
  readingsAt = now;
  // A hidden page has no animation frames, but its title still shows the status.
  if (document.hidden || now - drawnAt > PAUSE_MILLIS) takeNewest(now);
  const status = statusNow();
  if (elements.status.dataset.level !== status.level) updateScene();
  showStatus(status, now);
  showTransport(now);
  stream.show(now, ageMillisAt(now), connection.clock.at(now));
  charts.update(now, wasFresh());
  picture.setSeen(elements['picture-frame'].clientWidth > 0);
  picture.setMoment(formerNow(), now);
  picture.setLost(status.level === 'disconnected' ? 'The server does not answer' : '');
  loadMarks(now);
  markPad.update(now);
  loadAlarms(now);
  alarms.setConnected(status.level !== 'disconnected', now, shown.newest?.madeMicros ?? 0);
  alarmPanel.update(now);
  scene?.updateSurroundings(shown.details.surroundings, formerNow()?.state ?? null, now);
  const imageViews = cameraImages.update(shown.isNewest ? shown.details.images : [], now);
  scene?.setImageViews(imageViews);
  shown.keepAddress(now);
  document.body.dataset.time = status.level === 'recording' ? 'recording' : shown.isNewest ? 'live' : 'behind';
  if (!status.isFresh || !shown.isNewest) latencies.clear();
  const readings = streamReadingsOf(shown.state, latencies.summary(now), wasFresh());
  setText('rate', readings.rate);
  setText('latency', readings.latency);
  setText('latency-p95', readings.latencyP95);
  setText('sample', readings.sample);
  setText('time-code', readings.timeCode);
  setText('viewers', readings.viewers);
  setText('source', shown.details.source);
  elements['loads-shown'].hidden = !scene?.hasSkins;  // without a skin there is nothing to choose
  showPeople(wasFresh());
  showSettled(now);
}

/** Programs that take a picture of the page wait for this attribute: the page shows a moment of the past, and all of it.
 *  @param {number} now */
function showSettled(now) {
  const { marks_revision: marksRevision } = shown.newestDetails, { surroundings } = shown.details;
  const isAtRest = connection.connected && now >= notice.until && shown.isAtRest && !lacksModelOf(shown.state) && cameras.isKnown
    && scene?.isAtRest(surroundings) !== false && picture.isAt(shown.state?.stateNumber) && charts.isComplete
    && marks.isAt(marksRevision) && alarms.isComplete && controls.isComplete && stream.isKnown && hasDiagnostics
    && elements.role.dataset.role !== undefined;
  if (!isAtRest) unsettledAt = now;
  document.body.toggleAttribute('data-settled', now - unsettledAt >= SETTLED_MILLIS);
}

/** @param {import('./status.js').Status} status
 *  @param {number} now */
function showStatus(status, now) {
  const banner = (now < notice.until && notice.text) || status.banner || stream.clockStepsText || leftOutText(shown.newestDetails.left_out)
    || meshesText(scene?.failedMeshes.length ?? 0);
  elements.status.dataset.level = status.level;
  setText('status-word', status.word);
  setText('status-note', status.note);
  document.title = `${status.word} · Kinescope`;
  setText('clock', shown.isNewest ? new Date().toTimeString().slice(0, 8) : '');
  announcer.showStatus(status, banner);
  setText('banner', banner);
  elements.banner.hidden = banner === '';
  elements.banner.dataset.level = status.level;
}

/** @param {boolean} isFresh  whether what is shown is, or was */
function showPeople(isFresh) {
  const now = shown.state, texts = shown.details;
  if (now === null || model === null) return;
  applyClassLimits(texts.class_limits);
  const rows = rowsOf(now, model.joints, texts);
  const fresh = isFresh ? rows : rows.map(asUnknown);
  showLoads(fresh);
  const one = person.of(now.people);
  if (one) elements.points.hidden = false;  // its symbols are those of people: robots alone have none
  const isWritten = cards.show(now, texts.people, fresh, one?.character, performance.now());
  announcer.showClasses(fresh, isFresh && shown.isNewest, performance.now());
  const readings = readingsOf(one, texts.people.find(({ character }) => character === one?.character), isFresh);
  setText('loads-hint', readings.hint);
  elements['loads-hint'].title = readings.hint;
  elements['loads-hint'].classList.toggle('warn', readings.isDoubtful);
  setText('com', readings.com);
  setText('cop', readings.cop);
  if (!isWritten) return;  // with the same numbers of the card
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
