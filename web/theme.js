// Light or dark: as the address says (?theme=), else as the system does. dark.css has the colours of the dark page; who
// draws on a canvas follows here.

export const THEMES = /** @type {const} */ (['light', 'dark']);
/** @typedef {(typeof THEMES)[number]} ThemeName */

const MEDIA = { light: 'not all', dark: 'all' };

export class Theme {
  #system = matchMedia('(prefers-color-scheme: dark)');
  /** @type {ThemeName|null} */ #wanted = null;
  /** @type {(() => void)[]} */ #followers = [];

  /** @param {HTMLLinkElement|null} sheet  the colours of the dark page
   *  @param {HTMLMetaElement|null} meta  says which schemes the browser's own controls have */
  constructor(sheet, meta) {
    this.sheet = sheet;
    this.meta = meta;
    this.system = sheet?.media ?? '';
    this.#system.addEventListener('change', () => this.#tell());
    sheet?.addEventListener('load', () => this.#tell());
  }

  /** @returns {ThemeName|null}  null: as the system */
  get wanted() {
    return this.#wanted;
  }

  /** @returns {ThemeName} */
  get name() {
    return this.#wanted ?? (this.#system.matches ? 'dark' : 'light');
  }

  /** @param {ThemeName|null} wanted  null: as the system */
  choose(wanted) {
    this.#wanted = wanted;
    if (this.sheet) this.sheet.media = wanted === null ? this.system : MEDIA[wanted];
    if (this.meta) this.meta.content = wanted ?? 'light dark';
    this.#tell();
  }

  /** @param {() => void} act  after each change */
  follow(act) {
    this.#followers.push(act);
  }

  #tell() {
    for (const act of this.#followers) act();
  }
}

/** That of this page; tests in Node have none. */
export const theme = typeof document === 'undefined' ? null
  : new Theme(document.querySelector('link[href="dark.css"]'), document.querySelector('meta[name="color-scheme"]'));
