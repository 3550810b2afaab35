// What a viewer sees: the newest state, or a former one that the server has kept, each with the texts of its moment.
import { showInAddress } from './address.js';
import { HeldRun } from './held_run.js';
import { LookBack } from './look_back.js';
import { readTextMessage } from './messages.js';
import { messageOf } from './server_api.js';
import { runs } from './state_codec.js';
import { placeIn } from './status.js';
import { ViewerTime } from './viewer_time.js';

const ADDRESS_MILLIS = 500;  // browsers permit a few changes of the address per second
/** Between two of the newest states that a viewer who looks back is sent; with some delay. */
const FEW_STATES_MILLIS = 300;
/** By which a sample is looked for beside the one of a moment: each goes most of the way. */
const MOST_TRIES = 8;
/** Less than samples are apart, and more than a place in an address is rounded: it is that of its sample. */
const SAME_SAMPLE_MICROS = 1500;

/** @typedef {import('./state_codec.js').State} State
 *  @typedef {import('./state_codec.js').FormerState} FormerState
 *  @typedef {import('./messages.js').Details} Details
 *  @typedef {import('./viewer_time.js').Kept} Kept
 *  @typedef {{send: (command: object) => void, notice: (text: string) => void, changed: () => void,
 *    arrived: () => void}} Page  changed: the viewer has gone to another time, or begun to follow it again; arrived:
 *    another former state is to be drawn */

/** Rounded up, so that the sample of the moment is not after it.
 *  @param {number} millis */
const microsOf = (millis) => Math.ceil(1000 * millis);

export class Shown {
  time = new ViewerTime();
  /** @type {State|null} */ #newest = null;
  /** @type {Details} */ #newestDetails = {
    source: '', camera: '', has_pictures: true, people: [], objects: [], left_out: [], images: [], recording: null,
    marks_revision: null, surroundings: null, class_limits: [0.3, 0.6], class_falls_below: [0.25, 0.55],
  };
  #newestAt = 0;  // browser's clock, ms
  /** @type {{state: State, details: Details}|null} */ #past = null;
  /** @type {{text: string, details: Details}|null} */ #pastDetails = null;  // as they were last read
  #run = new HeldRun();  // while it plays
  #wantsFew = false;     // as the server was told
  #askedMicros = NaN;  // of the moment last asked for
  /** @type {{by: number, from: State}|null} */ #step = null;  // under way
  /** @type {{stampMicros: number, tries: number}|null} */ #sought = null;
  #addressAt = 0;
  /** @type {{micros: number|null, place: number|null}} */ #linked;
  /** @type {Page} */ #page;
  /** @type {LookBack} */ #lookBack;

  /** @param {Page} page
   *  @param {{micros: number|null, place: number|null}} linked  the moment of the address with which the page was opened, of
   *    the server's clock or in a recording, s; null: none */
  constructor(page, { micros, place }) {
    this.#page = page;
    this.#linked = { micros, place };
    this.#lookBack = new LookBack(page.send);
  }

  /** @param {State} state  the newest one */
  setNewest(state) {
    this.#newest = state;
    this.#newestAt = performance.now();
    this.#followLink();
  }

  /** @param {Details} details  of the newest state */
  setNewestDetails(details) {
    this.#newestDetails = details;
    this.#followLink();
  }

  get newest() { return this.#newest; }

  get newestDetails() { return this.#newestDetails; }

  get state() { return this.#past?.state ?? this.#newest; }

  get details() { return this.#past?.details ?? this.#newestDetails; }

  get isNewest() { return this.#past === null; }

  /** @returns {number|null} the moment of what is shown, ms of the server's clock */
  get millis() {
    return this.state ? this.state.madeMicros / 1000 : null;
  }

  /** @returns {Kept|null} null: the server keeps none */
  kept() {
    const newest = this.#newest, ended = this.#newestDetails.recording?.ended_micros ?? null;
    if (newest === null || newest.oldestMicros === 0) return null;
    const oldest = newest.oldestMicros / 1000;
    if (ended !== null) return { oldest, newest: ended / 1000, hasEnded: true };
    return { oldest, newest: newest.madeMicros / 1000 + this.#sinceNewest(newest), hasEnded: false };
  }

  /** Of a viewer who is sent few of the newest states: how long the stream has gone on since the last one, ms.
   *  @param {State} newest */
  #sinceNewest(newest) {
    if (!this.#wantsFew || !runs(newest)) return 0;
    return Math.max(0, Math.min(FEW_STATES_MILLIS, performance.now() - this.#newestAt));
  }

  /** Call it after each connection to the server, which may be another one. */
  onConnected() {
    this.#lookBack.onConnected();
    this.#run = new HeldRun();
    this.#askedMicros = NaN;
    this.#wantsFew = false;
    this.#tellWhetherFew();
  }

  /** The header of the page needs the newest state a few times a second, the scene of a live viewer each one. */
  #tellWhetherFew() {
    if (this.#wantsFew === !this.time.isLive) return;
    this.#wantsFew = !this.time.isLive;
    this.#page.send({ few_states: this.#wantsFew });
  }

  /** @param {number} millis  a moment of the server's clock */
  seek(millis) {
    const range = this.kept();
    if (range === null) return;
    this.time.seek(millis, performance.now(), range);
    this.onTimeChanged();
  }

  /** As seek(), and stays there.
   *  @param {number} millis
   *  @param {number|null} stampMicros  of the sample that is meant, where the moment is not certain: a busy server makes states
   *    later than usual */
  pauseAt(millis, stampMicros = null) {
    const range = this.kept();
    if (range === null) return;
    this.time.pause(performance.now(), range, millis);
    this.onTimeChanged();
    if (stampMicros !== null) this.#sought = { stampMicros, tries: MOST_TRIES };
  }

  /** Call it after every change of `time`. */
  onTimeChanged() {
    this.#sought = null;
    const range = this.kept();
    if (range?.hasEnded) this.time.momentAt(performance.now(), range);  // which is not live
    this.#tellWhetherFew();
    if (this.time.isLive) {
      if (this.#past === null) return;
      showInAddress({ micros: null, place: null });
      this.#past = null;
      this.#askedMicros = NaN;
      this.#lookBack.stop();
    } else if (this.#past === null && this.#newest) {
      // Stays on the screen until the server has answered.
      this.#past = { state: this.#newest, details: this.#newestDetails };
    }
    this.#page.changed();
  }

  /** Shows the state of the viewer's moment, or asks the server for it; call it for every drawing.
   *  @param {number} now */
  ask(now) {
    const range = this.kept();
    if (range === null || (this.time.isLive && !range.hasEnded)) return;
    const micros = microsOf(this.time.momentAt(now, range));
    if (this.time.isLive !== this.isNewest) this.onTimeChanged();  // it has caught up, or the recording has ended
    if (this.time.isLive) return;
    if (this.time.isPlaying) return this.#play(micros, now);
    if (micros === this.#askedMicros) return;
    this.#askedMicros = micros;
    this.#lookBack.ask({ micros }, now);
  }

  /** @param {number} micros
   *  @param {number} now */
  #play(micros, now) {
    const { speed } = this.time;
    this.#askedMicros = NaN;  // where it stops is asked for, also if it was there before
    const former = this.#run.at(micros, speed);
    try {
      if (former !== null) this.#show(former);
    } catch (error) {  // it is not as described
      this.#page.notice(messageOf(error));
    }
    const wanted = this.#run.next(micros, speed);
    if (wanted === null) return;
    if ('until_micros' in wanted) this.#lookBack.askRun(wanted, now);
    else this.#lookBack.ask(wanted, now);
  }

  /** @param {1|-1} by  sample */
  stepBy(by) {
    const from = this.state, range = this.kept();
    if (from === null || range === null) return;
    const now = performance.now();
    this.#askedMicros = microsOf(this.time.momentAt(now, range));  // the answer says where the step leads
    this.#step = { by, from };
    this.#sought = null;
    this.#askNextTo(from, now);
  }

  /** @param {State} state
   *  @param {number} now */
  #askNextTo(state, now) {
    this.#lookBack.ask({ number: Math.max(0, state.stateNumber + (this.#step?.by ?? 0)) }, now);
  }

  /** @param {ReturnType<typeof import('./state_codec.js').decodePast>} answer  of the server */
  onPast(answer) {
    const now = performance.now(), answered = this.#lookBack.onAnswer(answer.id, now), range = this.kept();
    if (answered === null || this.#past === null || range === null) return;
    const { formers } = answer, last = formers[formers.length - 1];
    if (this.time.isPlaying) {  // the next drawing shows it
      const { wanted } = answered;
      this.#step = null;
      if ('until_micros' in wanted) this.#run.setPace(answered.tookMillis - answered.leastMillis);
      return this.#run.add(formers, 'micros' in wanted ? wanted.micros : last.madeMicros, answer.untilMicros);
    }
    if ('until_micros' in answered.wanted) return;  // it was paused meanwhile
    const number = this.#numberOfSought(last.state);
    if (number !== null) return this.#lookBack.ask({ number }, now);
    if (this.#isStillThere(last.state)) return this.#askNextTo(last.state, now);
    // To the sample itself, so that a step leads to another one.
    if (!this.time.isGone(now, range)) this.time.pause(now, range, last.madeMicros / 1000);
    this.#askedMicros = microsOf(last.madeMicros / 1000);
    this.#show(last);
  }

  /** @param {State} state  that has come
   *  @returns {number|null} of the state to ask for in its place; null: it is the one that is sought, or none is */
  #numberOfSought({ stampMicros, stateNumber, rateHz }) {
    const away = (this.#sought?.stampMicros ?? stampMicros) - stampMicros;
    if (Math.abs(away) <= SAME_SAMPLE_MICROS || this.#sought === null || this.#sought.tries-- === 0) {
      this.#sought = null;
      return null;
    }
    return Math.max(0, stateNumber + (Math.round(away * rateHz / 1e6) || Math.sign(away)));
  }

  /** @param {FormerState} former */
  #show(former) {
    if (former.state === this.#past?.state) return;
    this.#past = { state: former.state, details: this.#read(former.details) };
    this.#page.arrived();
  }

  /** @param {string} text  a message with details; many states have the same
   *  @returns {Details} */
  #read(text) {
    if (this.#pastDetails?.text !== text) {
      const message = readTextMessage(text);
      if (message === null || !('details' in message)) return this.#newestDetails;
      this.#pastDetails = { text, details: message.details };
    }
    return this.#pastDetails.details;
  }

  /** Whether the state has the sample that the step began at: a sample may have several states, such as one more when
   *  the stream stopped.
   *  @param {State} state */
  #isStillThere(state) {
    const step = this.#step;
    const isThere = step !== null && state.stampMicros === step.from.stampMicros && state.counter === step.from.counter
      && Math.sign(state.stateNumber - step.from.stateNumber) === step.by;
    if (isThere) this.#step = { by: step.by, from: state };
    else this.#step = null;
    return isThere;
  }

  /** @param {number} now
   *  @returns {number|null} by which the viewer looks back, ms; null: not */
  behindMillis(now) {
    const range = this.kept();
    return this.time.isLive || range === null ? null : range.newest - this.time.momentAt(now, range);
  }

  /** Whether the moment that the viewer wants to see is no longer kept.
   *  @param {number} now */
  isGone(now) {
    const range = this.kept();
    return range !== null && this.time.isGone(now, range);
  }

  /** Puts the moment of a paused viewer into the address.
   *  @param {number} now */
  keepAddress(now) {
    if (this.#past === null || this.time.isPlaying || now - this.#addressAt < ADDRESS_MILLIS) return;
    this.#addressAt = now;
    showInAddress(this.link);
  }

  /** The moment of what is shown, for an address: in a recording it means the same after the server was started again.
   *  @returns {{micros: number|null, place: number|null}} */
  get link() {
    const { state } = this, { recording } = this.#newestDetails;
    if (state === null) return { micros: null, place: null };
    return recording === null ? { micros: state.madeMicros, place: null } : { micros: null, place: placeIn(recording, state.stampMicros) };
  }

  /** Whether what is shown stays: the viewer is paused, and the state of the moment has come. */
  get isAtRest() {
    const range = this.kept();
    if (range === null || this.#past === null || this.time.isPlaying || !this.#lookBack.isIdle) return false;
    return this.#linked.place === null && this.#askedMicros === microsOf(this.time.momentAt(performance.now(), range));
  }

  /** The address was copied from that of another viewer, or written by a program. */
  #followLink() {
    const { micros, place } = this.#linked;
    if (this.#newest === null) return;
    if (micros !== null) this.#goToLinkedMoment(micros);
    else if (place !== null) this.#goToLinkedPlace(place);
  }

  /** @param {number} micros */
  #goToLinkedMoment(micros) {
    this.#linked = { micros: null, place: null };
    const range = this.kept(), moment = micros / 1000, { notice } = this.#page;
    if (range === null) return notice('This server keeps no former moments: you see the newest one');
    if (moment > range.newest) return notice('The moment of this link is not on this server: you see the newest one');
    if (moment < range.oldest) notice('The moment of this link is no longer kept: you see the oldest one');
    this.seek(moment);
  }

  /** Waits until it has been played.
   *  @param {number} seconds  from the beginning of the recording */
  #goToLinkedPlace(seconds) {
    const newest = this.#newest, { recording } = this.#newestDetails, { notice } = this.#page;
    if (newest === null || recording === null) return;
    const reached = placeIn(recording, newest.stampMicros), secondsAfter = seconds - reached, range = this.kept();
    const isToCome = secondsAfter > 1e-6 * SAME_SAMPLE_MICROS && recording.round_secs === null;
    if (isToCome && recording.ended_micros === null) return;
    this.#linked = { micros: null, place: null };
    if (range === null) return notice('This server keeps no former moments: you see the newest one');
    const from = (recording.ended_micros ?? newest.madeMicros) + SAME_SAMPLE_MICROS;
    const roundBefore = secondsAfter > 0 ? recording.round_secs ?? 0 : 0;
    const away = 1e6 * (secondsAfter - roundBefore), millis = (from + away) / 1000, isKept = !isToCome && millis >= range.oldest;
    if (isToCome) notice('The recording ends before the moment of this link: you see its end');
    else if (millis < range.oldest) notice('The moment of this link is no longer kept: you see the oldest one');
    this.pauseAt(millis, isKept ? newest.stampMicros + away : null);
  }
}
