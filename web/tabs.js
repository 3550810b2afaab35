// Tabs over panels of which one is seen at a time; a wide page shows all of them, without tabs (charts.css).

/** @param {HTMLElement} list  of buttons with role "tab", each with aria-controls
 *  @param {HTMLElement} box  of the panels; its data-tab is the panel that is seen */
export function mountTabs(list, box) {
  const tabs = [...list.querySelectorAll('button')];
  const choose = (/** @type {HTMLButtonElement} */ chosen) => {
    box.dataset.tab = chosen.getAttribute('aria-controls') ?? '';
    for (const tab of tabs) {
      tab.ariaSelected = String(tab === chosen);
      tab.tabIndex = tab === chosen ? 0 : -1;
    }
  };
  for (const tab of tabs) tab.addEventListener('click', () => choose(tab));
  list.addEventListener('keydown', (event) => {
    const at = tabs.findIndex((tab) => tab === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (at < 0 || to === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();  // these keys also move the viewer's time
    const tab = tabs[(to + tabs.length) % tabs.length];
    tab.focus();
    choose(tab);
  });
  choose(tabs[0]);
}
