// The role of this page's token. Controls that change what others see are in <fieldset data-needs="operator">: a viewer
// sees them disabled, with the reason. The server refuses anyway.
import { readSession } from './messages.js';
import { ask, messageOf } from './server_api.js';

/** @typedef {'viewer'|'operator'} Role */

/** Why a control is disabled. */
export const WHY_DISABLED = 'Only operators can change this: open the page with the operator’s token';

/** @param {Role} role
 *  @returns {string} */
export const roleText = (role) =>
  (role === 'operator' ? 'Role: operator' : 'Role: viewer. What is dashed needs the operator’s token');

/** Enables or disables all gates inside `page`.
 *  @param {Pick<Document, 'querySelectorAll'>} page
 *  @param {Role} role */
function setGates(page, role) {
  for (const gate of page.querySelectorAll('fieldset[data-needs="operator"]')) {
    if (!(gate instanceof HTMLFieldSetElement)) continue;
    gate.disabled = role !== 'operator';
    gate.title = gate.disabled ? WHY_DISABLED : '';
  }
}

/** @param {HTMLElement} text  shows the role
 *  @param {(notice: string) => void} showNotice
 *  @returns {() => Promise<number|undefined>} asks the server for the role; call it after each connection. It returns when
 *    the server was started; undefined: not known */
export function mountRole(text, showNotice) {
  return async () => {
    try {
      const session = await ask('api/v1/session', readSession);
      if (session === null) return undefined;
      text.textContent = roleText(session.role);
      text.dataset.role = session.role;
      setGates(document, session.role);
      return session.started_micros;
    } catch (error) {
      showNotice(`Could not load the role of this page: ${messageOf(error)}`);
      return undefined;
    }
  };
}
