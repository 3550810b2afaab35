// What the plots show as files: CSV of the columns, and a picture with person, trial and time.
import { DASHES } from './plot.js';

const MARGIN = 16, TITLE_PX = 22, GAP_PX = 10, HEAD_PX = 46;

/** @typedef {{person: string, source: string, from: number, to: number, wallMillis: (micros: number) => number,
 *    flags: import('./plot.js').Flag[]}} About
 *    source: trials and recording; from, to: µs of the server's clock; flags: of marks
 *  @typedef {{title: string, canvas: HTMLCanvasElement|null, lines: {name: string}[]}} Part */

/** A cell in quotes if it needs them. A text that a spreadsheet would take for a formula gets an apostrophe.
 *  @param {string} text */
export function cellOf(text) {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/** A row for each column of time: its beginning, how many samples it has, and of each value the smallest, the largest
 *  and the newest; at last what was marked in it. Unknown values are empty.
 *  @param {import('./series.js').Series} series
 *  @param {About} about */
export function csvOf(series, about) {
  const { keys, width } = series.grid;
  const rows = [['person', 'source', 'time', 'seconds', 'samples',
    ...keys.flatMap((key) => [`${key}_min`, `${key}_max`, `${key}_last`]), 'marks']];
  for (let n = series.numberAt(about.from); n * width < about.to; ++n) {
    const column = series.column(n);
    if (column === undefined) continue;
    const text = (/** @type {number|null|undefined} */ value) => (value === null || value === undefined ? '' : String(value));
    rows.push([cellOf(about.person), cellOf(about.source), new Date(about.wallMillis(n * width)).toISOString(),
      ((n * width - about.from) / 1e6).toFixed(3), String(column.samples), ...keys.flatMap((key) => {
        const value = column.values[key];
        return [text(value?.min), text(value?.max), text(value?.last)];
      }), cellOf(about.flags.filter(({ micros }) => micros >= n * width && micros < (n + 1) * width).map((flag) => flag.text).join('; '))]);
  }
  return new Blob([rows.map((row) => row.join(',')).join('\r\n'), '\r\n'], { type: 'text/csv' });
}

/** @param {About} about
 *  @param {string} end  of the name */
export function fileNameOf({ person, to, wallMillis }, end) {
  const name = person.replace(/[^\p{L}\p{N}_-]+/gu, '_').slice(0, 40);
  return `kinescope_${name}_${new Date(wallMillis(to)).toISOString().replace(/[:.]/g, '-')}.${end}`;
}

/** All plots below each other, with who, what and when.
 *  @param {Part[]} parts
 *  @param {About} about
 *  @param {HTMLElement} panel  has the colours
 *  @returns {Promise<Blob>} */
export async function pictureOf(parts, about, panel) {
  const shown = parts.flatMap(({ canvas, ...part }) => (canvas ? [{ ...part, canvas }] : []));
  const scale = devicePixelRatio || 1, style = getComputedStyle(panel);
  const color = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`);
  const width = Math.max(...shown.map(({ canvas }) => canvas.width / scale)) + 2 * MARGIN;
  const height = shown.reduce((sum, { canvas }) => sum + TITLE_PX + canvas.height / scale + GAP_PX, HEAD_PX + MARGIN);
  const picture = document.createElement('canvas');
  picture.width = Math.round(width * scale);
  picture.height = Math.round(height * scale);
  const context = picture.getContext('2d');
  if (context === null) throw new Error('this browser has no 2-D canvas');
  context.scale(scale, scale);
  context.fillStyle = color('panel');
  context.fillRect(0, 0, width, height);
  context.textBaseline = 'top';
  context.fillStyle = color('ink');
  context.font = `700 15px ${style.fontFamily}`;
  context.fillText(about.person, MARGIN, MARGIN - 4, width - 2 * MARGIN);
  context.fillStyle = color('quiet');
  context.font = `12px ${style.fontFamily}`;
  const [from, to] = [about.from, about.to].map((micros) => new Date(about.wallMillis(micros)));
  context.fillText([about.source, `${from.toLocaleString()} to ${to.toLocaleTimeString()}`].filter(Boolean).join(' · '),
    MARGIN, MARGIN + 16, width - 2 * MARGIN);
  let y = HEAD_PX + 4;
  for (const { title, canvas, lines } of shown) {
    context.font = `700 12px ${style.fontFamily}`;
    context.fillStyle = color('ink');
    context.fillText(title, MARGIN, y + 4);
    drawLegend(context, color, lines, { right: width - MARGIN, y: y + 4, font: `12px ${style.fontFamily}` });
    y += TITLE_PX;
    context.drawImage(canvas, MARGIN, y, canvas.width / scale, canvas.height / scale);
    y += canvas.height / scale + GAP_PX;
  }
  return new Promise((resolve, reject) => {
    picture.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser cannot write this picture'))), 'image/png');
  });
}

/** From the right to the left: name and dash of each line.
 *  @param {CanvasRenderingContext2D} context
 *  @param {(name: string) => string} color
 *  @param {{name: string}[]} lines
 *  @param {{right: number, y: number, font: string}} place */
function drawLegend(context, color, lines, { right, y, font }) {
  context.font = font;
  let x = right;
  for (let i = lines.length - 1; i >= 0; --i) {
    if (lines[i].name === '') continue;
    x -= context.measureText(lines[i].name).width;
    context.fillStyle = context.strokeStyle = color(`line-${i + 1}`);
    context.fillText(lines[i].name, x, y);
    context.lineWidth = 1.75;
    context.setLineDash(DASHES[i]);
    context.beginPath();
    context.moveTo(x - 30, y + 7);
    context.lineTo(x - 6, y + 7);
    context.stroke();
    context.setLineDash([]);
    x -= 44;
  }
}

/** @param {Blob} file
 *  @param {string} name */
export function download(file, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
