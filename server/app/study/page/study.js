// The page of a study: compares conditions by joint, lists trials and people, says what failed; its keys and clicks.
import { conditions, find, measures, study, view } from './data.js';
import { drawFailures, drawTrial, filterOfKind } from './details.js';
import { drawPanels, measureButtons } from './panels.js';
import { fields, filterLine, jointOf, selectTrials } from './selection.js';
import { drawRows, drawTable, ROW, tableSection } from './table.js';

/** @typedef {import('./data.js').Trial} Trial */

const place = find('#study');
place.innerHTML = `${filterLine()}<div class="main">
<section class="answer"><h2>Conditions by joint ${measureButtons()}<span class="key"></span></h2><div class="panels"></div></section>
${tableSection(place.dataset.csv ?? '')}
<div class="side"><section class="failures" hidden></section><section class="trial" aria-live="polite"></section></div>
</div>`;
const scroll = find('.scroll'), { search, least, joint, measure } = fields();

const update = () => {
  selectTrials();
  const [shown, all] = [view.shown, study.trials].map(({ length }) => length.toLocaleString('en'));
  find('.hits').textContent = shown === all ? `all ${all} trials` : `${shown} of ${all} trials`;
  drawPanels();
  drawTable();
};
const updateFromTop = () => {
  scroll.scrollTop = 0;
  update();
};

/** @param {string} what @param {string} value */
const choose = (what, value) => {
  if (what === 'measure') view.measure = measures[Number(value)];
  if (what === 'state') view.state = value;
  if (what === 'condition') view.condition = value === '' ? null : conditions[Number(value)];
  for (const button of document.querySelectorAll(`[data-choice=${what}] button`)) {
    button.setAttribute('aria-pressed', String(button instanceof HTMLElement && button.dataset.value === value));
  }
};
/** @param {string} tab */
const showTab = (tab) => {
  view.tab = tab;
  scroll.className = `scroll ${tab}`;
  for (const button of document.querySelectorAll('[role=tab]')) {
    button.setAttribute('aria-selected', String(button instanceof HTMLElement && button.dataset.tab === tab));
  }
  const { key } = view.sort;
  if (tab === 'people' && jointOf(key) < 0 && !['person', 'condition', 'spine'].includes(key)) view.sort = { key: 'person', way: 1 };
  updateFromTop();
};
/** @param {string} key */
const sortBy = (key) => {
  const isText = ['id', 'person', 'condition', 'state'].includes(key);
  view.sort = { key, way: view.sort.key === key ? -view.sort.way : isText ? 1 : -1 };
  updateFromTop();
};
const clear = () => {
  search.value = least.value = joint.value = '';
  choose('state', 'all');
  choose('condition', '');
  updateFromTop();
};
/** Shows a trial, and its row. @param {Trial} trial */
const show = (trial) => {
  view.chosen = trial;
  drawTrial();
  const top = view.shown.indexOf(trial) * ROW, room = scroll.clientHeight - find('.head').offsetHeight - ROW;
  if (top < scroll.scrollTop) scroll.scrollTop = top;
  if (top > scroll.scrollTop + room) scroll.scrollTop = top - room;
  drawRows();
};
/** The trials of a kind of failure. @param {number} kind */
const showKind = (kind) => {
  search.value = filterOfKind(kind);
  choose('state', 'all');
  choose('condition', '');
  showTab('trials');
};
/** The trials of a group. @param {string} person @param {string} condition */
const showGroup = (person, condition) => {
  search.value = person;
  if (conditions.length > 1) choose('condition', String(conditions.indexOf(condition)));
  showTab('trials');
};

/** @param {HTMLElement} button */
const press = (button) => {
  const { tab, sort, joint: panel, kind, value } = button.dataset, choice = button.closest('[data-choice]');
  if (button.matches('.clear')) clear();
  else if (choice instanceof HTMLElement) {
    choose(choice.dataset.choice ?? '', value ?? '');
    updateFromTop();
  } else if (tab) showTab(tab);
  else if (sort) sortBy(sort);
  else if (panel) sortBy(`j${panel}`);
  else if (kind) showKind(Number(kind));
};
place.addEventListener('click', ({ target }) => {
  const element = target instanceof Element ? target : null, button = element?.closest('button'), row = element?.closest('.rows .row');
  if (button instanceof HTMLElement) press(button);
  else if (row instanceof HTMLElement && !element?.closest('a')) {
    const { group, of, id, person } = row.dataset;
    const found = view.shown.find((trial) => trial.id === id && (person === undefined || trial.person === person));
    if (group !== undefined) showGroup(group, of ?? '');
    else if (found) show(found);
  }
});
for (const field of [search, least, joint, measure]) field.addEventListener('input', updateFromTop);

let isDue = false;
scroll.addEventListener('scroll', () => {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => {
    isDue = false;
    drawRows();
  });
});
addEventListener('resize', () => drawRows());
addEventListener('beforeprint', () => drawRows(true));
addEventListener('afterprint', () => drawRows());
addEventListener('keydown', (event) => {
  const { target, key } = event;
  if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) {
    if (key === 'Escape') target.blur();
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (key === '/') {
    search.focus();
    event.preventDefault();
  }
  const step = ({ ArrowDown: 1, j: 1, ArrowUp: -1, k: -1 })[key];
  if (view.tab !== 'trials' || step === undefined) return;
  const next = view.shown[Math.max(0, Math.min(view.shown.length - 1, view.shown.indexOf(view.chosen) + step))];
  if (next) show(next);
  event.preventDefault();
});

drawFailures();
drawTrial();
update();
