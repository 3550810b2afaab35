// Which arrangement of the page is used: the one that the address names (?view=), else desk or phone by the width. The
// arrangements themselves are in layouts.css.

export const LAYOUTS = /** @type {const} */ (['desk', 'wall', 'phone', 'kiosk']);
/** @typedef {(typeof LAYOUTS)[number]} LayoutName */

/** Below this width, px, a desk does not fit, whatever the address says. */
export const LEAST_DESK_PX = 900;

/** @param {LayoutName|null} wanted  null: the address names none
 *  @param {boolean} isNarrow
 *  @returns {LayoutName} */
export const layoutOf = (wanted, isNarrow) =>
  (wanted === null || wanted === 'desk' ? (isNarrow ? 'phone' : 'desk') : wanted);

/** Wall and kiosk have no controls, no keys and no focus.
 *  @param {LayoutName} name */
export const hasControls = (name) => name === 'desk' || name === 'phone';

export class Layout {
  #narrow = matchMedia(`(max-width: ${LEAST_DESK_PX - 0.02}px)`);
  /** @type {((name: LayoutName) => void)[]} */ #followers = [];

  /** @param {LayoutName|null} wanted
   *  @param {HTMLElement} body  its data-view is the arrangement */
  constructor(wanted, body) {
    this.wanted = wanted;
    this.body = body;
    this.#narrow.addEventListener('change', () => this.#apply());
    this.#apply();
  }

  get name() {
    return layoutOf(this.wanted, this.#narrow.matches);
  }

  get hasControls() {
    return hasControls(this.name);
  }

  /** Calls it now and after each change.
   *  @param {(name: LayoutName) => void} act */
  follow(act) {
    this.#followers.push(act);
    act(this.name);
  }

  #apply() {
    this.body.dataset.view = this.name;
    for (const act of this.#followers) act(this.name);
  }
}
