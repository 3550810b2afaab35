/// Style and script of the report. The script adds views, keys and decisions; without it everything
/// is there to be read. In a file it collects the command that accepts. In a page that `golden
/// review` serves, which has a token, it orders each decision from ReviewSite and shows what became
/// of it; a decision is shown only when the server has confirmed it.
#pragma once

namespace kinescope::app {

inline constexpr char kGoldenReportStyle[] = R"(
:root { color-scheme: light dark; --page: #f1f3f6; --panel: #fff; --ink: #1a212b; --quiet: #55606f; --line: #d9dee5;
  --link: #1d5aa0; --bad: #b0241c; --bad-soft: #fcebea; --warn: #855000; --warn-soft: #fff3de; --ok: #0d6b32; --ok-soft: #e2f4e8; --code: #eef1f5; }
@media (prefers-color-scheme: dark) { :root { --page: #10141a; --panel: #181d25; --ink: #e4e8ee; --quiet: #9da8b6; --line: #2c3440;
  --link: #80b5f1; --bad: #ff8d83; --bad-soft: #3b1d1c; --warn: #f0a840; --warn-soft: #342810; --ok: #4fc47d; --ok-soft: #15301f; --code: #222a34; } }
* { box-sizing: border-box; }
html { scroll-padding-top: 8px; }
body { margin: 0; padding: 0 0 72px; background: var(--page); color: var(--ink); font: 14px/1.45 "DejaVu Sans", system-ui, Arial, sans-serif; }
h1 { font-size: 20px; margin: 0; } h2 { font-size: 17px; margin: 0; overflow-wrap: anywhere; } p { margin: 0; }
a { color: var(--link); }
code { font: 12.5px/1.4 "DejaVu Sans Mono", ui-monospace, monospace; background: var(--code); border-radius: 4px; padding: 1px 5px; overflow-wrap: anywhere; }
button { font: inherit; font-size: 13px; padding: 4px 10px; border: 1px solid var(--line); border-radius: 6px; background: var(--panel); color: var(--ink); cursor: pointer; }
button:disabled, code:empty { display: none; }
button:hover { border-color: var(--quiet); } button[aria-pressed=true] kbd { color: inherit; background: none; }
button[aria-pressed=true] { background: var(--ink); color: var(--panel); }
:focus-visible { outline: 2px solid var(--link); outline-offset: 1px; }
kbd { font: 11px "DejaVu Sans Mono", monospace; border: 1px solid var(--line); border-radius: 4px; padding: 0 4px; color: var(--quiet); }
header.top, main > section { background: var(--panel); border: 1px solid var(--line); }
header.top { border-width: 0 0 1px; padding: 12px 22px; display: flex; gap: 14px; align-items: center; }
header.top p { color: var(--quiet); }
.mark { flex: none; width: 36px; height: 36px; border-radius: 50%; display: grid; place-items: center; color: #fff; font-size: 18px; font-weight: 700; background: #0d6b32; }
.mark.bad { background: #b0241c; } .mark.warn { background: #855000; }
main { max-width: 1560px; margin: 0 auto; padding: 14px 22px; display: grid; gap: 14px; }
main > section { border-radius: 10px; padding: 14px 18px; min-width: 0; }
section.case:target, section.case.here { box-shadow: 0 0 0 2px var(--link); } section.case:focus-visible { outline-color: transparent; }
table { border-collapse: collapse; width: 100%; font-size: 13px; }
th { text-align: left; } thead th { color: var(--quiet); font-weight: normal; font-size: 12px; }
td, th { padding: 4px 12px 4px 0; border-bottom: 1px solid var(--line); vertical-align: top; overflow-wrap: anywhere; }
tr:last-child td, tr:last-child th { border-bottom: 0; }
table.summary td:nth-child(2), table.summary td:nth-child(4), thead th, .layers th { white-space: nowrap; }
details { margin-top: 8px; font-size: 13px; } summary { cursor: pointer; color: var(--quiet); }
.number { color: var(--quiet); width: 28px; }
.tag { font-size: 11.5px; padding: 1px 7px; border-radius: 4px; white-space: nowrap; background: var(--code); }
.tag.bad { background: var(--bad-soft); color: var(--bad); font-weight: 600; } .tag.warn { background: var(--warn-soft); color: var(--warn); font-weight: 600; }
.tag.ok { color: var(--ok); }
table.summary .first { font-weight: 600; }
.head { display: flex; flex-wrap: wrap; gap: 4px 12px; align-items: baseline; }
.head .why { flex-basis: 100%; color: var(--quiet); } .head code { color: var(--quiet); }
.decide { margin-left: auto; display: flex; gap: 6px; }
.accepted { --tone: var(--ok); --soft: var(--ok-soft); } .rejected, .failed { --tone: var(--bad); --soft: var(--bad-soft); } .later { --tone: var(--warn); --soft: var(--warn-soft); }
.outcome, td[data-decision-of], #said { color: var(--tone, inherit); font-weight: 600; } #said:not(.failed) { font-weight: normal; }
.outcome { font-size: 12.5px; padding: 2px 10px; border-radius: 5px; background: var(--soft); overflow-wrap: anywhere; } .outcome:empty { display: none; }
.outcome { margin-left: auto; } .outcome:not(:empty):not(.failed) + .decide { margin-left: 0; }
.outcome.failed { flex-basis: 100%; order: 1; margin: 0; padding: 6px 10px; }
.accepted::before { content: "\2713\00a0"; } .rejected::before { content: "\2715\00a0"; } .later::before { content: "\2026\00a0"; }
.headline { font-size: 16px; font-weight: 600; color: var(--bad); margin: 8px 0; overflow-wrap: anywhere; }
.warn .headline { color: var(--warn); }
.two { display: grid; grid-template-columns: minmax(0, 1.2fr) minmax(0, 1fr); gap: 22px; }
ul.words { margin: 0; padding: 0; list-style: none; font-size: 13px; }
ul.words li { padding: 2px 0 2px 22px; position: relative; overflow-wrap: anywhere; }
ul.words li::before { content: "\2022"; position: absolute; left: 6px; color: var(--bad); }
ul.words .missing::before { content: "\2212"; } ul.words .new::before { content: "+"; } ul.words .moved::before { content: "\2194"; color: var(--quiet); }
ul.words .text::before { content: "T"; font-size: 11px; top: 3px; } ul.words .camera::before, ul.words .floor::before { content: "\25B3"; font-size: 11px; top: 3px; }
ul.words .pixels::before, ul.words .structure::before, ul.words .light::before { content: "\25A6"; color: var(--quiet); }
.dot { display: inline-block; width: 10px; height: 10px; border-radius: 50%; margin-right: 3px; }
.dot.green { background: #0f996e; } .dot.orange { background: #ff9400; } .dot.red { background: #b30d0d; box-shadow: 0 0 0 1.5px #260505; } .dot.grey { background: #8d939c; }
.cause { border-left: 3px solid var(--bad); padding: 2px 0 2px 10px; font-size: 13px; } .cause.other { border-color: #d08a00; background: var(--warn-soft); }
.layers { margin-top: 8px; } .layers .fails th { color: var(--bad); }
.views { display: flex; flex-wrap: wrap; gap: 6px; margin: 12px 0 6px; }
.pictures { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 10px; max-width: max(600px, calc(1.5 * var(--shape, 1.778) * (100vh - 478px) + 20px)); }
figure { margin: 0; min-width: 0; } figcaption { font-size: 12px; color: var(--quiet); margin-bottom: 3px; } figcaption b { color: var(--ink); }
svg.shot { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 4px; background: #fff; }
svg.near { margin-top: 6px; } svg.near * { image-rendering: pixelated; } svg.shot rect { fill: none; stroke: #1d5aa0; stroke-width: 1.5; stroke-dasharray: 5 3; }
svg.shot rect.mask { fill: rgb(133 80 0 / .2); stroke: #855000; stroke-dasharray: none; }
.big { display: none; position: relative; max-width: min(1240px, calc((100vh - 200px) * var(--shape, 1.778))); } .big .over { position: absolute; inset: 0; }
.big .label { position: absolute; left: 10px; bottom: 10px; background: #1a212b; color: #fff; padding: 3px 10px; border-radius: 5px; font-weight: 600; }
.slide { display: none; width: 100%; max-width: min(1240px, calc((100vh - 200px) * var(--shape, 1.778))); }
.case[data-view] .pictures { display: none; } .case[data-view] .big { display: block; } .case[data-view=slider] .slide { display: block; }
.commands { display: flex; flex-wrap: wrap; gap: 6px 26px; margin-top: 12px; padding-top: 10px; border-top: 1px solid var(--line); font-size: 12.5px; color: var(--quiet); }
dl { margin: 0; display: grid; gap: 3px; font-size: 12.5px; } dl div { display: grid; grid-template-columns: 120px minmax(0, 1fr); } dt { color: var(--quiet); } dd { margin: 0; overflow-wrap: anywhere; }
footer { position: fixed; left: 0; right: 0; bottom: 0; background: var(--panel); border-top: 1px solid var(--line); padding: 9px 22px; display: flex; flex-wrap: wrap; gap: 6px 16px; align-items: center; font-size: 13px; }
footer #said { flex: 1 1 240px; min-width: 0; overflow-wrap: anywhere; }
footer .keys { color: var(--quiet); font-size: 12px; }
.js .needs-script { display: flex; } .needs-script { display: none; }
@media screen and (max-width: 760px) { .two, .pictures { grid-template-columns: minmax(0, 1fr); max-width: none; } main { padding: 10px; } main > section { padding: 10px 12px; }
  header.top { padding: 10px 12px; } table.summary thead { display: none; } table.summary tr { display: block; padding: 6px 0; border-bottom: 1px solid var(--line); }
  table.summary td { display: inline; border: 0; padding: 0 6px 0 0; } table.summary td:nth-child(3) { display: block; } footer .keys, .hide-narrow { display: none; } [data-token] button { min-height: 40px; } .outcome:not(:empty):not(.failed) + .decide { margin-left: auto; } dl div { grid-template-columns: 90px minmax(0, 1fr); } }
@media print { body { padding: 0; } .pictures { max-width: none; } footer, .views, .decide { display: none !important; } section.case { break-before: page; } @page { size: A4 landscape; margin: 9mm; } }
)";

inline constexpr char kGoldenReportScript[] = R"(
document.documentElement.classList.add('js');
const cases = [...document.querySelectorAll('section.case')], decided = new Map();
for (const one of cases) if (one.dataset.shape) one.style.setProperty('--shape', one.dataset.shape);
// As a shell takes it, by the rule of ShellWord(): names come from files of anyone.
const word = (text) => (/^[\w.,:/@%+][\w.,:/@%+=-]*$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);
const { run, token } = document.body.dataset;  // with a token, a server carries out what is decided
const decidable = document.querySelectorAll('.decide').length;
let at = 0;
const setView = (one, view) => {
  if (view === 'side') delete one.dataset.view; else one.dataset.view = view;
  one.querySelectorAll('.views button').forEach((each) => { each.ariaPressed = String(each.dataset.view === view); });
  const over = one.querySelector('.big .over'), label = one.querySelector('.big .label');
  if (!over) return;
  over.style.visibility = 'visible';
  over.style.clipPath = view === 'slider' ? `inset(0 0 0 ${one.querySelector('.slide').value}%)` : '';
  over.querySelector('use').setAttribute('href', `#${view === 'heat' ? 'd' : 'a'}${one.dataset.number}`);
  label.textContent = { blink: 'This run', slider: 'Accepted | this run', heat: 'Difference' }[view] ?? '';
};
const collect = () => {
  const names = [...decided].filter(([, each]) => each === 'accept').map(([name]) => name);
  document.getElementById('command').textContent = names.length === 0 ? '' : `kinescope golden accept ${word(run)} ${names.map(word).join(' ')}`;
  document.getElementById('copy').disabled = names.length === 0;
};
const show = (one, verdict) => {
  if (!one.querySelector('.decide')) return;
  if (verdict === null) decided.delete(one.dataset.name); else decided.set(one.dataset.name, verdict);
  one.querySelectorAll('.decide button').forEach((each) => { each.ariaPressed = String(each.dataset.decision === verdict); });
  document.getElementById('decisions').textContent = `${decided.size} of ${decidable} decided`;
};
const mark = (to) => {
  at = to;
  cases.forEach((each, i) => each.classList.toggle('here', i === at));
};
const go = (to) => {
  if (cases.length === 0) return;
  mark(Math.max(0, Math.min(cases.length - 1, to)));
  cases[at].scrollIntoView({ block: 'start' });
  cases[at].focus({ preventScroll: true });
};
// A key decides about the case that is marked and in sight, and no other.
const isInSight = (one) => {
  const { top, bottom } = one.getBoundingClientRect();
  return one.classList.contains('here') && top < innerHeight / 2 && bottom > innerHeight / 8;
};

const words = { accept: 'accepted', reject: 'rejected', later: 'later' };
let isWaiting = false, hasEnded = false;
const say = (text, tone = '') => Object.assign(document.getElementById('said'), { textContent: text, className: tone });
const note = (one, text, tone) => Object.assign(one.querySelector('.outcome'), { textContent: text, className: `outcome ${tone}` });
const showAll = (decisions) => {
  for (const one of cases.filter((each) => each.querySelector('.decide'))) {
    const word = decisions[one.dataset.name] ?? '', cell = document.querySelector(`[data-decision-of="${one.dataset.number}"]`);
    show(one, Object.keys(words).find((each) => words[each] === word) ?? null);
    if (cell.textContent !== word) note(one, word, word);  // why an order failed stays
    Object.assign(cell, { textContent: word, className: word });
  }
  document.getElementById('finish').disabled = hasEnded || decided.size < decidable;
};
// What the server says; nothing if it has ended or another request is under way.
const ask = async (path, order) => {
  if (isWaiting || hasEnded) return null;
  isWaiting = true;
  try {
    const headers = { authorization: `Bearer ${token}` };
    const response = await fetch(path, order ? { method: 'POST', headers, body: JSON.stringify(order) } : { headers });
    const said = await response.json();
    if (path === 'end' && response.ok) hasEnded = true;
    if (said.decisions) showAll(said.decisions);
    return said;
  } catch {
    say(`The review does not answer. If it has ended, continue it with: kinescope golden review ${word(run)}`, 'failed');
    return null;
  } finally {
    isWaiting = false;
  }
};
const finish = async () => {
  await isRead;
  const said = await ask('end', {});
  if (!said) return;
  if (said.error) return say(said.error, 'failed');
  document.querySelectorAll('.decide button').forEach((each) => { each.disabled = true; });
  const counts = Object.entries(words).map(([verdict, word]) => `${[...decided.values()].filter((each) => each === verdict).length} ${word}`);
  say(`The review has ended: ${counts.join(', ')}. This page can be closed.`);
};
const order = async (one, verdict) => {
  const name = one.dataset.name;
  await isRead;  // who is quicker than that loses no key
  const said = await ask('decisions', { case: name, order: verdict ?? 'undo' });
  if (!said) return false;
  if (said.error) {
    note(one, `${verdict ? `not ${words[verdict]}` : 'not undone'}: ${said.error}`, 'failed');
    say(`${name}: ${one.querySelector('.outcome').textContent}`, 'failed');
    return false;
  }
  note(one, words[verdict] ?? '', words[verdict] ?? '');
  say(`${name}: ${words[verdict] ?? 'undecided'}.${decided.size < decidable ? '' : ' All are decided.'}`);
  return true;
};
const decide = async (one, verdict) => {
  if (!one.querySelector('.decide')) return true;
  if (token) return order(one, verdict);
  show(one, verdict);
  collect();
  return true;
};
const decideByKey = async (verdict) => {
  if (!isInSight(cases[at])) return go(at);
  const from = at;
  if (await decide(cases[from], verdict) && verdict && at === from) go(from + 1);
};
cases.forEach((one, i) => {
  for (const kind of ['focusin', 'pointerdown']) one.addEventListener(kind, () => mark(i));
  one.querySelectorAll('.views button').forEach((each) => each.addEventListener('click', () => setView(one, each.dataset.view)));
  one.querySelector('.slide')?.addEventListener('input', () => setView(one, 'slider'));
  one.querySelectorAll('.decide button').forEach((each) => each.addEventListener('click',
    () => decide(one, each.ariaPressed === 'true' ? null : each.dataset.decision)));
});
setInterval(() => document.querySelectorAll('.case[data-view=blink] .over').forEach((over) => {
  const isAfter = over.style.visibility === 'hidden';
  over.style.visibility = isAfter ? 'visible' : 'hidden';
  over.parentElement.querySelector('.label').textContent = isAfter ? 'This run' : 'Accepted';
}), 600);
document.getElementById('copy')?.addEventListener('click', () => {
  const range = document.createRange();
  range.selectNodeContents(document.getElementById('command'));
  getSelection().removeAllRanges();
  getSelection().addRange(range);
  navigator.clipboard?.writeText(document.getElementById('command').textContent).catch(() => undefined);
});
document.getElementById('finish')?.addEventListener('click', finish);
// Settled when what was decided before is known.
const isRead = token ? ask('decisions').then((said) => { if (said?.error) say(said.error, 'failed'); }) : Promise.resolve();
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || cases.length === 0) return;
  const one = cases[at], views = { 1: 'side', 2: 'blink', 3: 'slider', 4: 'heat' };
  const verdicts = { a: 'accept', r: 'reject', u: null, ...(token && { l: 'later' }) };
  const key = event.key.toLowerCase();
  if (key === 'j') go(at + (one.classList.contains('here') ? 1 : 0));
  else if (key === 'k') go(at - 1);
  else if (key in views) setView(one, views[key]);
  else if (event.repeat) return;  // a key that is held down decides once
  else if (key in verdicts) decideByKey(verdicts[key]);
  else if (key === 'f' && token && !document.getElementById('finish').disabled) finish();
});
)";

}  // namespace kinescope::app
