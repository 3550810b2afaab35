// The address of the page holds what it shows, so that a link shows another person the same. Pure but for what is at the
// end.
import { LAYOUTS } from './layout.js';
import { LOADS_SHOWN } from './messages.js';
import { partsIn } from './scene_parts.js';
import { THEMES } from './theme.js';
import { SPEEDS } from './viewer_time.js';

/** @typedef {{micros: number|null, place: number|null, person: number|null, joints: string[]|null, camera: string|null, tab: string|null,
 *    window: number|null, loads: import('./loads_shown.js').LoadsShown|null, speed: number|null,
 *    hidden: import('./scene_parts.js').ScenePart[],
 *    view: import('./layout.js').LayoutName|null, theme: import('./theme.js').ThemeName|null}} Shown
 *    micros: the moment of a viewer who looks back, null: live; place: that in a recording, s from its beginning;
 *    person: character; joints: that are plotted; camera: name, or place (orbit.js); window: time that the plots show,
 *    s; loads: where joint loads are shown; speed: of looking back; hidden: parts of the
 *    scene. Null otherwise: as the page has it by itself */

const JOINT = /^[a-z0-9_]{1,40}$/, NAME = /^[a-z_]{1,40}$/, MOST_JOINTS = 15;

/** @param {string|null} text
 *  @returns {number|null} */
const numberOf = (text) => (text === null || text.trim() === '' || !Number.isFinite(Number(text)) ? null : Number(text));

/** Values that are none are ignored: the address may come from anywhere.
 *  @param {URL} url
 *  @returns {Shown} */
export function shownIn(url) {
  const of = (/** @type {string} */ name) => url.searchParams.get(name);
  const seconds = numberOf(of('t')), place = numberOf(of('at')), person = numberOf(of('person')), window = numberOf(of('window'));
  const joints = (of('joint') ?? '').split(',').filter((name) => JOINT.test(name)).slice(0, MOST_JOINTS);
  const camera = of('camera') ?? '', tab = of('tab') ?? '';
  return {
    micros: seconds !== null && seconds >= 0 ? 1e6 * seconds : null,
    place: place !== null && place >= 0 ? place : null,
    person: person !== null && Number.isInteger(person) ? person : null,
    joints: joints.length > 0 ? joints : null,
    camera: NAME.test(camera) || /^[-\d.,]{1,120}$/.test(camera) ? camera : null,
    tab: NAME.test(tab) ? tab : null,
    window: window !== null && window > 0 ? window : null,
    loads: LOADS_SHOWN.find((name) => name === of('loads')) ?? null,
    hidden: partsIn(of('hide')),
    speed: SPEEDS.find((speed) => speed === numberOf(of('speed'))) ?? null,
    view: LAYOUTS.find((name) => name === of('view')) ?? null,
    theme: THEMES.find((name) => name === of('theme')) ?? null,
  };
}

/** Moments are rounded up, those of recordings to milliseconds, so that the sample that is shown is not after them. What `changes` does not
 *  name stays.
 *  @param {URL} url
 *  @param {Partial<Shown>} changes
 *  @returns {URL} */
export function withShown(url, changes) {
  const next = new URL(url);
  const { micros, place, joints } = changes;
  /** @type {Record<string, string|number|null|undefined>} */
  const texts = {
    t: micros === undefined || micros === null ? micros : (Math.ceil(micros) / 1e6).toFixed(6),
    at: place === undefined || place === null ? place : String(Math.ceil(1000 * place - 1e-6) / 1000),
    person: changes.person, joint: joints === undefined || joints === null ? joints : joints.join(), camera: changes.camera,
    tab: changes.tab, window: changes.window, loads: changes.loads, speed: changes.speed, view: changes.view, theme: changes.theme,
  };
  for (const [name, value] of Object.entries(texts)) {
    if (value === null) next.searchParams.delete(name);
    else if (value !== undefined) next.searchParams.set(name, String(value));
  }
  next.search = next.search.replaceAll('%2C', ',');  // lists that a person can read
  return next;
}

/** The cookie has been set, so the token is not needed in history and bookmarks. */
export function forgetToken() {
  const url = new URL(location.href);
  if (!url.searchParams.has('token')) return;
  url.searchParams.delete('token');
  history.replaceState(null, '', url);
}

/** @param {Partial<Shown>} changes */
export function showInAddress(changes) {
  const url = withShown(new URL(location.href), changes);
  if (url.href !== location.href) history.replaceState(null, '', url);
}
