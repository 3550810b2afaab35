// Tabs over panels of which one is seen at a time. A wide page shows the plots beside the others, and a phone shows the
// view as a panel, too: a tab that is not there cannot be chosen (layouts.css).

export class Tabs {
  /** @type {HTMLButtonElement[]} */ #tabs;
  /** @type {HTMLButtonElement|null} */ #chosen = null;
  /** @type {((name: string) => void)[]} */ #followers = [];

  /** @param {HTMLElement} list  of buttons with role "tab", each with aria-controls
   *  @param {HTMLElement[]} boxes  their data-tab is the panel that is seen */
  constructor(list, boxes) {
    this.boxes = boxes;
    this.#tabs = [...list.querySelectorAll('button')];
    for (const tab of this.#tabs) tab.addEventListener('click', () => this.#choose(tab));
    list.addEventListener('keydown', (event) => this.#onKey(event));
    this.settle();
  }

  /** Of the tab that is chosen: its id without "tab-". */
  get name() {
    return this.#chosen === null ? '' : nameOf(this.#chosen);
  }

  /** Whether it is the one that the page begins with. */
  get isFirst() {
    return this.#chosen === this.#there()[0];
  }

  /** @param {string} name  without such a tab, or where it is not there, nothing changes */
  choose(name) {
    const tab = this.#there().find((each) => nameOf(each) === name);
    if (tab) this.#choose(tab);
  }

  /** @param {(name: string) => void} act  after each choice */
  follow(act) {
    this.#followers.push(act);
  }

  /** Call it when tabs have come or gone: chooses the first one if the chosen one is not there. */
  settle() {
    const there = this.#there();
    if (there.length > 0 && (this.#chosen === null || !there.includes(this.#chosen))) this.#choose(there[0]);
  }

  #there() {
    return this.#tabs.filter((tab) => tab.offsetParent !== null);
  }

  /** @param {HTMLButtonElement} chosen */
  #choose(chosen) {
    this.#chosen = chosen;
    for (const box of this.boxes) box.dataset.tab = panelOf(chosen);
    for (const tab of this.#tabs) {
      tab.ariaSelected = String(tab === chosen);
      tab.tabIndex = tab === chosen ? 0 : -1;
      document.getElementById(panelOf(tab))?.toggleAttribute('data-chosen', tab === chosen);
    }
    chosen.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    for (const act of this.#followers) act(nameOf(chosen));
  }

  /** @param {KeyboardEvent} event */
  #onKey(event) {
    const tabs = this.#there(), at = tabs.findIndex((tab) => tab === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (at < 0 || to === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();  // these keys also move the viewer's time
    const tab = tabs[(to + tabs.length) % tabs.length];
    tab.focus();
    this.#choose(tab);
  }
}

/** @param {HTMLButtonElement} tab */
const panelOf = (tab) => tab.getAttribute('aria-controls') ?? '';

/** @param {HTMLButtonElement} tab */
const nameOf = (tab) => tab.id.replace(/^tab-/, '');
