// Keys of the whole page, which must not take those of fields and buttons.

/** Whether the key belongs to what has the focus: a field, a list, a button that Space presses.
 *  @param {KeyboardEvent} event */
export function isForOther({ target, key }) {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement && target.type === 'range') return false;
  if (target.matches('input:not([type=checkbox]), select, textarea, [contenteditable]')) return true;
  return key === ' ' && target.matches('button, input, summary, a[href]');
}
