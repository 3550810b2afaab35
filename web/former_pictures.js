// Pictures of former moments, which the server draws for this viewer alone: one at a time, and after each the one that is
// wanted then.

const RETRY_MILLIS = 1000;  // after an error: others may have used up what the server draws in a second

/** @typedef {{state: number|null, camera: string, isDark: boolean, width: number, height: number}} Wanted  state: its number,
 *    null: the newest; camera: '' is the one of the live picture; width, height: px */

/** @param {Wanted} wanted
 *  @returns {string} the address of the picture */
export const addressOf = ({ state, camera, isDark, width, height }) => `api/v1/snapshot.png?${new URLSearchParams({
  ...(state === null ? {} : { state: String(state) }), ...(camera === '' ? {} : { camera }),
  theme: isDark ? 'dark' : 'light', width: String(width), height: String(height),
})}`;

export class FormerPictures {
  /** @type {Wanted|null} */ #wanted = null;
  #shown = '';  // its address
  #isAsking = false;
  #notBefore = -Infinity;  // browser's clock, ms

  /** @param {(address: string) => Promise<Blob>} ask
   *  @param {(picture: Blob, state: number|null) => void} show
   *  @param {(error: unknown) => void} failed */
  constructor(ask, show, failed) {
    this.ask = ask;
    this.show = show;
    this.failed = failed;
  }

  /** Call it several times a second.
   *  @param {Wanted|null} wanted  null: none
   *  @param {number} now  browser's clock, ms */
  want(wanted, now) {
    this.#wanted = wanted;
    if (wanted === null) this.#shown = '';
    this.#askIfDue(now);
  }

  /** @param {number} now */
  async #askIfDue(now) {
    const wanted = this.#wanted;
    if (wanted === null || this.#isAsking || now < this.#notBefore) return;
    const address = addressOf(wanted);
    if (address === this.#shown) return;
    this.#isAsking = true;
    try {
      const picture = await this.ask(address);
      // Of a viewer who plays, the moment has gone on: the picture is shown all the same.
      if (this.#wanted !== null) {
        this.#shown = address;
        this.show(picture, wanted.state);
      }
    } catch (error) {
      this.#notBefore = now + RETRY_MILLIS;
      if (this.#wanted !== null) this.failed(error);
    }
    this.#isAsking = false;
  }
}
