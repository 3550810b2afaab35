// The keys of the whole page, in one list that the key map shows. They must not take those of fields and buttons. A
// switch turns those of one character off, which can be in the way of speech input.

/** Whether the key belongs to what has the focus: a field, a list, a button that Space presses.
 *  @param {KeyboardEvent} event */
export function isForOther({ target, key }) {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement && target.type === 'range') return false;
  if (target.matches('input:not([type=checkbox]), select, textarea, [contenteditable]')) return true;
  return (key === ' ' || key === 'Enter') && target.matches('button, input, summary, a[href]');
}

/** A key as the list has it: "Space", "Shift+ArrowLeft", "P", "Shift+5" (of the key with the digit, on any keyboard),
 *  "?"; '' for keys that are left to the browser.
 *  @param {Pick<KeyboardEvent, 'key'|'code'|'shiftKey'|'ctrlKey'|'altKey'|'metaKey'>} event */
export function keyName({ key, code, shiftKey, ctrlKey, altKey, metaKey }) {
  if (altKey || metaKey) return '';
  const digit = /^(?:Digit|Numpad)([0-9])$/.exec(code)?.[1];
  const isSign = digit === undefined && key.length === 1 && !/[\p{L} ]/u.test(key);  // Shift may be a part of it
  const name = digit ?? (key === ' ' ? 'Space' : key.length === 1 ? key.toUpperCase() : key);
  return `${ctrlKey ? 'Ctrl+' : ''}${shiftKey && !isSign ? 'Shift+' : ''}${name}`;
}

/** Whether it is a letter, digit or sign, with or without Shift.
 *  @param {string} name  see keyName() */
export const isCharacterKey = (name) => [...name.replace(/^Shift\+(?=.)/, '')].length === 1;

/** What the key map writes on a key.
 *  @param {string} name */
export const keyLabel = (name) => name.replace('ArrowLeft', '←').replace('ArrowRight', '→').replace('ArrowUp', '↑')
  .replace('ArrowDown', '↓').replace('Escape', 'Esc').replace('PageUp', 'Page up').replace('PageDown', 'Page down')
  .replaceAll('+', ' + ').replace(/^ \+ $/, '+');

/** @typedef {{group: string, keys: string[], what: string, act: ((event: KeyboardEvent) => void)|null, repeats: boolean}} Binding
 *    act: null: the key map shows it, but another part of the page acts */

export class Keys {
  /** @type {Binding[]} */ #bindings = [];
  /** Whether keys of one character do anything. */
  hasCharacters = true;

  /** @param {Pick<Document, 'addEventListener'|'querySelector'>} page
   *  @param {() => boolean} isOn  whether the page has keys at all */
  constructor(page, isOn) {
    page.addEventListener('keydown', (event) => {
      if (!isOn() || isForOther(event) || page.querySelector('dialog[open]')) return;
      this.press(event);
    });
  }

  /** Adds keys to the list; the first part that takes a key keeps it.
   *  @param {string} group  of the map; '': a line of another group stands for these keys
   *  @param {string|string[]} keys  see keyName()
   *  @param {string} what  they do
   *  @param {((event: KeyboardEvent) => void)|null} act
   *  @param {{repeats?: boolean}} [options]  repeats: also while the key is held down */
  add(group, keys, what, act, { repeats = false } = {}) {
    this.#bindings.push({ group, keys: [keys].flat(), what, act, repeats });
  }

  /** @returns {readonly Binding[]} */
  get list() {
    return this.#bindings;
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const name = keyName(event);
    if (name === '' || (isCharacterKey(name) && !this.hasCharacters)) return;
    const found = this.#find(name) ?? (/^Shift\+\p{L}$/u.test(name) ? this.#find(name.slice('Shift+'.length)) : undefined);
    if (!found?.act) return;
    event.preventDefault();
    if (!event.repeat || found.repeats) found.act(event);
  }

  /** @param {string} name */
  #find(name) {
    return this.#bindings.find(({ keys, act }) => act !== null && keys.includes(name));
  }
}
