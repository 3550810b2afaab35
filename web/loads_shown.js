// The control for where joint loads are shown in the 3-D view. Until the viewer chooses, the server's option decides.
import { LOADS_SHOWN } from './messages.js';

/** @typedef {(typeof LOADS_SHOWN)[number]} LoadsShown */

/** @param {HTMLSelectElement} select  with these values
 *  @param {() => void} onChoice
 *  @returns {(byServer: LoadsShown) => LoadsShown} function that shows and returns the value to use */
export function mountLoadsShown(select, onChoice) {
  let chosen = /** @type {LoadsShown|undefined} */ (undefined);
  select.addEventListener('change', () => {
    chosen = LOADS_SHOWN.find((value) => value === select.value);
    onChoice();
  });
  return (byServer) => {
    const used = chosen ?? byServer;
    select.value = used;
    return used;
  };
}
