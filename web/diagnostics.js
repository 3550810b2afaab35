// What the server and this page could not do, for the panel that is there only when there is something.

const MOST_LINES = 12;

/** One line each, the most urgent first; equal ones once.
 *  @param {import('./messages.js').Diagnostics} diagnostics
 *  @param {string[]} failedMeshes  that this page could not load
 *  @returns {string[]} */
export function problemLines(diagnostics, failedMeshes) {
  const { pictures, source } = diagnostics;
  const lines = [];
  if (pictures?.last_error) lines.push(`The server’s picture: ${pictures.last_error}`);
  for (const problem of pictures?.problems ?? []) lines.push(`Not in the picture as it is: ${problem}`);
  for (const mesh of failedMeshes) lines.push(`Not loaded by this page: ${mesh}`);
  for (const [reason, count] of Object.entries(source?.rejected ?? {})) {
    lines.push(`${count} ${count === 1 ? 'datagram' : 'datagrams'} refused: ${reason}`);
  }
  const all = [...new Set(lines)];
  if (all.length <= MOST_LINES) return all;
  return [...all.slice(0, MOST_LINES - 1), `and ${all.length - MOST_LINES + 1} more: /api/diagnostics has all`];
}

/** @param {HTMLElement} panel  hidden while there is nothing to say
 *  @param {HTMLElement} list  within it
 *  @returns {(lines: string[]) => void} shows these lines */
export function mountDiagnostics(panel, list) {
  let shown = '';
  return (lines) => {
    const text = lines.join('\n');
    if (text === shown) return;
    shown = text;
    panel.hidden = lines.length === 0;
    list.replaceChildren(...lines.map((line) => {
      const entry = document.createElement('li');
      entry.textContent = line;  // not markup: names come from outside
      return entry;
    }));
  };
}
