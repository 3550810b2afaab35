// The strip of time and the plots: gives them what is on the screen, and loads what they lack.
import { BodyMap } from './body_map.js';
import { personLabel } from './format.js';
import { colorNumber } from './person_cards.js';
import { Plots } from './plots.js';
import { Feed } from './series.js';
import { Strip } from './strip.js';
import { WallClock } from './wall_clock.js';

/** @typedef {import('./state_codec.js').State} State
 *  @typedef {{model: () => import('./messages.js').Model|null, failed: (text: string) => void,
 *    person: import('./chosen_person.js').ChosenPerson, serverMillis: () => number|null, canPress: boolean}} Page
 *    failed: shows why something did not work; serverMillis: now, by the server's clock, null before its first answer;
 *    canPress: whether the joints of the map can be pressed */

export class Charts {
  #feed = new Feed();
  #clock = new WallClock();
  /** @type {import('./strip.js').StripPerson[]} */ #people = [];  // all who were in the stream since the page was opened

  /** @param {import('./elements.js').Elements} elements
   *  @param {import('./shown.js').Shown} shown
   *  @param {Page} page */
  constructor(elements, shown, page) {
    this.shown = shown;
    this.page = page;
    this.strip = new Strip({ canvas: elements['strip-rows'], slider: elements.moment });
    this.plots = new Plots({
      panel: elements.plots, windows: elements['plot-window'],
      joints: elements['plot-joints'], chosen: elements['plot-chosen'], list: elements['plot-list'],
      plan: elements['floor-plan'], dash: elements['dash-sample'], csv: elements['plot-csv'], png: elements['plot-png'],
    }, { seek: (micros) => shown.seek(micros / 1000), source: () => shown.newestDetails.source, failed: page.failed,
      person: page.person });
    this.body = new BodyMap({
      panel: elements['body-map'], mark: elements['body-mark'],
      middle: elements['body-middle'], right: elements['body-right'], left: elements['body-left'],
    }, page.canPress ? (name) => this.plots.toggle(name) : null);
  }

  /** The moments of another server are others. */
  forget() {
    this.strip.forget();
    this.plots.forget();
    this.#people = [];
    this.#clock = new WallClock();
  }

  /** Whether strip and plots show all that there is. */
  get isComplete() {
    return this.#feed.isComplete;
  }

  /** The worst classes at a moment in words.
   *  @param {number} millis */
  wordsAt(millis) {
    return this.strip.wordsAt(this.#people, 1000 * millis);
  }

  /** @param {number} micros  a moment of the server's clock
   *  @returns {number}  its time of day, ms, as Date has it; NaN: not known yet */
  wallMillis(micros) {
    return this.#clock.at(micros);
  }

  /** Call it several times a second.
   *  @param {number} now  browser's clock, ms
   *  @param {boolean} isFresh  whether what is shown is of now, or was when it was the newest */
  update(now, isFresh) {
    const kept = this.shown.kept(), model = this.page.model(), live = this.shown.newest, { time } = this.shown;
    this.#clock.update({
      newest: live, recording: this.shown.newestDetails.recording, serverMillis: this.page.serverMillis(), wallMillis: Date.now(),
    });
    if (kept === null || live === null || document.hidden) return;
    this.#meet(live);
    const when = {
      oldest: 1000 * kept.oldest, newest: 1000 * kept.newest, moment: 1000 * time.momentAt(now, kept),
      isLive: time.isLive, wallMillis: (/** @type {number} */ micros) => this.#clock.at(micros),
    };
    if (model !== null) this.#showPlots(when, model, live, isFresh);
    this.strip.draw(this.#people, when);
    this.#feed.update([...this.plots.wanted(when), ...this.strip.wanted(this.#people, when)], when.newest, now)
      .then((reason) => { if (reason) this.page.failed(reason); });
  }

  /** Keeps those who are in the stream, and those who left while the strip still shows them.
   *  @param {State} live */
  #meet(live) {
    const names = this.shown.newestDetails.people;
    for (const { character } of live.people) {
      const label = personLabel({ character, name: names.find((each) => each.character === character)?.name ?? '' });
      const known = this.#people.find((each) => each.character === character);
      if (known) known.label = label;
      else this.#people = [...this.#people, { character, label, color: colorNumber(character) }].sort((a, b) => a.character - b.character);
    }
    this.#people = this.#people.filter(({ character }) =>
      live.people.some((each) => each.character === character) || this.strip.hasSamplesOf(character));
  }

  /** @param {import('./plots.js').When} when
   *  @param {import('./messages.js').Model} model
   *  @param {State} live
   *  @param {boolean} isFresh */
  #showPlots(when, model, live, isFresh) {
    const first = live.people[0] ?? this.shown.state?.people[0];
    const { class_limits: limits } = this.shown.details;
    if (first) this.plots.setJoints(first.loads.map(({ joint }) => model.joints[joint]), limits, model.compression_limits_n);
    this.plots.setPeople(this.shown.newestDetails.people);
    this.#showBody(model, isFresh);
    const shown = this.shown.state;
    const person = isFresh ? shown?.people.find(({ character }) => character === this.plots.character) : undefined;
    this.plots.draw(when, {
      com: person?.com ?? null, cop: person?.cop ?? null, support: person?.support ?? [], heading: shown?.viewHeading ?? 0,
    });
  }

  /** @param {import('./messages.js').Model} model
   *  @param {boolean} isFresh */
  #showBody(model, isFresh) {
    const shown = this.shown.state, { people } = this.shown.details;
    const person = this.page.person.of(shown?.people ?? []);
    if (!shown || !person) return;
    const words = people.find(({ character }) => character === person.character);
    this.body.show(shown.madeMicros, person.loads.map((load) => ({
      ...model.joints[load.joint], loadClass: isFresh ? load.loadClass : 'unknown', ratio: isFresh ? load.ratio : NaN,
      secs: words?.loads.find(({ joint }) => joint === load.joint)?.secs_in_band,
    })), this.plots.chosen);
  }
}
