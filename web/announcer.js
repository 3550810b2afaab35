// What screen readers are told without being asked: a change of the lamp, a notice, and changes of load classes. Those are
// collected: a class counts when it has stayed for a moment, and is said with all others that have changed since the last
// time, not more often than every few seconds.
import { percent } from './format.js';

const SETTLED_MILLIS = 600, PAUSE_MILLIS = 5000, MOST_SAID = 3;
const RANK = { high: 0, medium: 1, low: 2, unknown: 3 };

/** @typedef {{key: string, label: string, loadClass: import('./messages.js').LoadClass, ratio: number}} Joint */

/** Finds out which changes of classes are to be said. Pure: times are arguments, ms. */
export class ClassChanges {
  /** @type {Map<string, {said: string, is: string, since: number}>} */ #joints = new Map();
  #saidAt = -Infinity;

  /** What is known is forgotten, and what comes next is not said: it is no change. */
  reset() {
    this.#joints.clear();
  }

  /** @param {Joint[]} joints  of all people
   *  @param {number} now
   *  @returns {string}  "" for nothing */
  update(joints, now) {
    for (const key of this.#joints.keys()) if (!joints.some((joint) => joint.key === key)) this.#joints.delete(key);
    for (const { key, loadClass } of joints) {
      const known = this.#joints.get(key);
      if (known === undefined) this.#joints.set(key, { said: loadClass, is: loadClass, since: now });
      else if (known.is !== loadClass) this.#joints.set(key, { said: known.said, is: loadClass, since: now });
    }
    if (now - this.#saidAt < PAUSE_MILLIS) return '';
    const changed = joints.filter(({ key }) => {
      const known = this.#joints.get(key);
      return known !== undefined && known.said !== known.is && now - known.since >= SETTLED_MILLIS;
    }).sort((a, b) => RANK[a.loadClass] - RANK[b.loadClass] || b.ratio - a.ratio);
    if (changed.length === 0) return '';
    this.#saidAt = now;
    for (const { key, loadClass } of changed) this.#joints.set(key, { said: loadClass, is: loadClass, since: now });
    const said = changed.slice(0, MOST_SAID).map(({ label, loadClass, ratio }) =>
      `${label} ${loadClass}${Number.isFinite(ratio) ? `, ${percent(ratio)}` : ''}`);
    if (changed.length > MOST_SAID) said.push(`and ${changed.length - MOST_SAID} more`);
    return said.join('; ');
  }
}

export class Announcer {
  #classes = new ClassChanges();
  #level = '';
  #notice = '';

  /** @param {HTMLElement} region  with aria-live */
  constructor(region) {
    this.region = region;
  }

  /** @param {string} text */
  say(text) {
    this.region.textContent = text;
  }

  /** @param {import('./status.js').Status} status  of the lamp
   *  @param {string} banner  that is in sight */
  showStatus(status, banner) {
    const hasChanged = status.level !== this.#level, isFirst = this.#level === '';
    this.#level = status.level;
    const notice = banner.replace(/\d+(\.\d+)? (s|min|h)\b/, '');  // an age is no news
    if (hasChanged && !isFirst) this.say([status.word, banner].filter(Boolean).join('. '));
    else if (notice !== this.#notice && notice !== '') this.say(banner);
    this.#notice = notice;
  }

  /** @param {Joint[]} joints
   *  @param {boolean} isLive  else a viewer goes to and fro in time, or there is no stream
   *  @param {number} now */
  showClasses(joints, isLive, now) {
    if (!isLive) return this.#classes.reset();
    const text = this.#classes.update(joints, now);
    if (text !== '') this.say(text);
  }
}
