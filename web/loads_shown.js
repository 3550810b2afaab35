// The control for where joint loads are shown in the 3-D view. Until the viewer chooses, the server's option decides.
import { LOADS_SHOWN } from './messages.js';

/** @typedef {(typeof LOADS_SHOWN)[number]} LoadsShown */

export class LoadsChoice {
  /** @param {HTMLSelectElement} select  with these values
   *  @param {LoadsShown|null} chosen  by the address
   *  @param {() => void} onChoice */
  constructor(select, chosen, onChoice) {
    this.select = select;
    this.chosen = chosen;
    select.addEventListener('change', () => {
      this.chosen = LOADS_SHOWN.find((value) => value === select.value) ?? null;
      onChoice();
    });
  }

  /** Shows and returns the value to use.
   *  @param {LoadsShown} byServer */
  of(byServer) {
    const used = this.chosen ?? byServer;
    this.select.value = used;
    return used;
  }
}
