// Problems that the server, its ROS graph and this page have now. The panel is visible only if there are any. What the stream had is in
// the panel "Stream".

import { nameOfLeftOut } from './status.js';

const MOST_LINES = 12;

/** One line per problem, the most urgent first, without duplicates.
 *  @param {import('./messages.js').Diagnostics} diagnostics
 *  @param {string[]} failedMeshes  that this page could not load
 *  @param {string[]} notShown  what its 3-D view does not show as it should
 *  @returns {string[]} */
export function problemLines(diagnostics, failedMeshes, notShown = []) {
  const { pictures, source, stream, ros } = diagnostics;
  const lines = [];
  if (pictures?.last_error) lines.push(`Server rendering: ${pictures.last_error}`);
  for (const problem of pictures?.problems ?? []) lines.push(`Missing or replaced in the server picture: ${problem}`);
  for (const mesh of failedMeshes) lines.push(`This page could not load: ${mesh}`);
  for (const problem of notShown) lines.push(`Missing or replaced in the 3-D view: ${problem}`);
  const warnings = (stream?.clocks ?? []).map((clock) => clock.warning).filter((warning) => warning !== '');
  for (const text of [...warnings, ...source?.problems ?? []]) lines.push(`${text[0].toUpperCase()}${text.slice(1)}.`);
  for (const person of source?.left_out ?? []) lines.push(`${nameOfLeftOut(person)} is left out: ${person.reason}`);
  if (source?.passed_secs) {
    lines.push(`The recording is passed over up to the moment at which it is to begin: ${Math.round(source.passed_secs)} s so far`);
  }
  if (source?.transport?.ros_master_answers === 0) {
    const where = ros?.master_uri ? ` at ${ros.master_uri}` : '';
    lines.push(`No ROS master answers${where}: start roscore, or set ROS_MASTER_URI for the server.`);
  }
  for (const problem of ros?.not_shown ?? []) lines.push(`Not shown: ${problem}`);
  const all = [...new Set(lines)];
  if (all.length <= MOST_LINES) return all;
  return [...all.slice(0, MOST_LINES - 1), `and ${all.length - MOST_LINES + 1} more, see /api/v1/diagnostics`];
}

/** @param {HTMLElement} panel  hidden while there are no problems
 *  @param {HTMLElement} list  inside the panel
 *  @returns {(lines: string[]) => void} function that shows these lines */
export function mountDiagnostics(panel, list) {
  let shown = '';
  return (lines) => {
    const text = lines.join('\n');
    if (text === shown) return;
    shown = text;
    panel.hidden = lines.length === 0;
    list.replaceChildren(...lines.map((line) => {
      const entry = document.createElement('li');
      entry.textContent = line;  // text and not markup: names come from outside
      return entry;
    }));
  };
}
