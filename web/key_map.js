// The map of all keys, as a dialog, with the switch for keys of one character. The choice is kept by the browser.
import { keyLabel } from './keys.js';

const STORED = 'kinescope.character_keys';

/** @typedef {{dialog: HTMLDialogElement, list: HTMLElement, open: HTMLButtonElement, close: HTMLButtonElement,
 *    characters: HTMLInputElement}} Parts */

/** @param {Parts} parts
 *  @param {import('./keys.js').Keys} keys  all that are added before the map is opened are in it */
export function mountKeyMap({ dialog, list, open, close, characters }, keys) {
  const show = () => {
    list.replaceChildren(...groupsOf(keys.list).map(([group, bindings]) => groupElement(group, bindings)));
    dialog.showModal();
  };
  keys.add('Page', '?', 'This map', show);
  open.addEventListener('click', show);
  close.addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  keys.hasCharacters = stored() !== 'off';
  characters.checked = keys.hasCharacters;
  characters.addEventListener('change', () => {
    keys.hasCharacters = characters.checked;
    store(characters.checked ? 'on' : 'off');
  });
}

/** @param {readonly import('./keys.js').Binding[]} bindings
 *  @returns {[string, import('./keys.js').Binding[]][]} */
function groupsOf(bindings) {
  const names = [...new Set(bindings.map(({ group }) => group))].filter(Boolean);  // without: shown as one line of another group
  return names.map((name) => [name, bindings.filter(({ group }) => group === name)]);
}

/** @param {string} group
 *  @param {import('./keys.js').Binding[]} bindings */
function groupElement(group, bindings) {
  const section = document.createElement('section'), title = document.createElement('h3'), rows = document.createElement('dl');
  title.textContent = group;
  for (const { keys, what } of bindings) {
    const row = document.createElement('div'), names = document.createElement('dt'), text = document.createElement('dd');
    for (const key of keys) {
      const cap = document.createElement('kbd');
      cap.textContent = keyLabel(key);
      names.append(cap, ' ');
    }
    text.textContent = what;
    row.append(names, text);
    rows.append(row);
  }
  section.append(title, rows);
  return section;
}

// A browser may forbid a page to store anything.
function stored() {
  try {
    return localStorage.getItem(STORED);
  } catch {
    return null;
  }
}

/** @param {string} value */
function store(value) {
  try {
    localStorage.setItem(STORED, value);
  } catch {
    // The switch holds for this page only.
  }
}
