// Where a viewer is in time: live, or behind at a moment of the server's history, paused or playing. Pure: times are
// arguments. Moments are in ms of the server's clock, `now` is the browser's clock, ms.

export const SPEEDS = /** @type {const} */ ([0.1, 0.25, 0.5, 1, 2, 4, 8]);
/** Nearer than this to the newest moment, a moment that plays as fast as time cannot come. */
const CAUGHT_UP_MILLIS = 50;
/** More than the oldest moments are apart that a page hears of: who goes to the oldest one stays there. */
const GONE_MILLIS = 1000;
/** Less than samples are apart: the last sample of a recording and the end of its history may differ by rounding, and by the
 *  time that its end took to be noticed. */
const AT_END_MILLIS = 1;

/** @typedef {{oldest: number, newest: number, hasEnded?: boolean}} Kept  moments that the server has; hasEnded: no newer
 *    ones will come, as after the end of a recording */

export class ViewerTime {
  /** @type {{moment: number, since: number, isPlaying: boolean}|null} */ #behind = null;  // null: live
  /** One of SPEEDS; kept while paused. */
  speed = 1;

  get isLive() {
    return this.#behind === null;
  }

  get isPlaying() {
    return this.#behind === null || this.#behind.isPlaying;
  }

  /** The moment that is to be shown. A moment that is no longer kept becomes the oldest; playing faster than time
   *  until the newest makes it live again. What has ended is not live: it is paused at its end.
   *  @param {number} now
   *  @param {Kept} kept */
  momentAt(now, kept) {
    const wanted = this.#wantedAt(now);
    if (kept.hasEnded && (wanted === null || (this.isPlaying && wanted >= kept.newest))) {
      this.#behind = { moment: kept.newest, since: now, isPlaying: false };
      return kept.newest;
    }
    if (wanted === null) return kept.newest;
    if (this.isPlaying && this.speed > 1 && wanted > kept.newest - CAUGHT_UP_MILLIS) {
      this.goLive();
      return kept.newest;
    }
    return clamp(wanted, kept);
  }

  /** Whether the moment is older than all that is kept.
   *  @param {number} now
   *  @param {Kept} kept */
  isGone(now, kept) {
    const wanted = this.#wantedAt(now);
    return wanted !== null && wanted < kept.oldest - GONE_MILLIS;
  }

  /** @param {number} now
   *  @returns {number|null} null: live */
  #wantedAt(now) {
    if (this.#behind === null) return null;
    const { moment, since, isPlaying } = this.#behind;
    return isPlaying ? moment + this.speed * (now - since) : moment;
  }

  /** @param {number} now
   *  @param {Kept} kept
   *  @param {number} [shown]  the moment on the screen, which stays there */
  pause(now, kept, shown) {
    this.#behind = { moment: clamp(shown ?? this.momentAt(now, kept), kept), since: now, isPlaying: false };
  }

  /** From where it is paused; from the oldest moment if that is the end. Live, nothing changes.
   *  @param {number} now
   *  @param {Kept} kept */
  play(now, kept) {
    if (this.#behind === null) return;
    const moment = this.momentAt(now, kept), isAtEnd = kept.hasEnded && moment > kept.newest - AT_END_MILLIS;
    this.#behind = { moment: isAtEnd ? kept.oldest : moment, since: now, isPlaying: true };
  }

  /** To a moment, paused there if it was live or paused.
   *  @param {number} moment
   *  @param {number} now
   *  @param {Kept} kept */
  seek(moment, now, kept) {
    const isPlaying = this.#behind?.isPlaying ?? false;
    this.#behind = { moment: clamp(moment, kept), since: now, isPlaying };
  }

  /** Below 1, a live view begins to fall behind.
   *  @param {number} speed
   *  @param {number} now
   *  @param {Kept} kept */
  setSpeed(speed, now, kept) {
    if (this.#behind !== null) this.#behind = { ...this.#behind, moment: this.momentAt(now, kept), since: now };
    else if (speed < 1) this.#behind = { moment: kept.newest, since: now, isPlaying: true };
    this.speed = speed;
  }

  goLive() {
    this.#behind = null;
    this.speed = 1;
  }
}

/** @param {number} moment
 *  @param {Kept} kept */
const clamp = (moment, { oldest, newest }) => Math.max(oldest, Math.min(newest, moment));
