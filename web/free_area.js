// Where overlays leave room for people in the 3-D view.

/** @typedef {import('./view_frame.js').Rect} Rect
 *  @typedef {import('./view_frame.js').FreeArea} FreeArea
 *  @typedef {{left: number, top: number, right: number, bottom: number}} Box  px */

const MARGIN = 6;    // px beside an overlay
const ACROSS = 0.9;  // of the width: what covers so much leaves nothing beside it
const LEAST_FREE = 0.3;  // of the height; no room is no reason to show nothing

/** @param {Box} view
 *  @param {Box[]} overlays  those without a size are not shown
 *  @returns {FreeArea} */
export function freeAreaOf(view, overlays) {
  const width = view.right - view.left, height = view.bottom - view.top;
  const free = { left: 0, top: 0, right: 1, bottom: 1 }, corners = /** @type {Rect[]} */ ([]);
  for (const { left, top, right, bottom } of overlays) {
    const isOver = left < right && top < bottom
      && left < view.right && right > view.left && top < view.bottom && bottom > view.top;
    if (!isOver) continue;
    const covered = {
      left: Math.max(0, (left - MARGIN - view.left) / width), top: Math.max(0, (top - MARGIN - view.top) / height),
      right: Math.min(1, (right + MARGIN - view.left) / width), bottom: Math.min(1, (bottom + MARGIN - view.top) / height),
    };
    if (covered.right - covered.left < ACROSS) corners.push(covered);
    else if (covered.top + covered.bottom < 1) free.top = Math.max(free.top, covered.bottom);
    else free.bottom = Math.min(free.bottom, covered.top);
  }
  if (free.bottom - free.top < LEAST_FREE) return { free: { left: 0, top: 0, right: 1, bottom: 1 }, corners: [] };
  return { free, corners };
}

/** Calls back with it now and when an overlay appears, goes, or changes its size.
 *  @param {HTMLElement} view
 *  @param {HTMLElement[]} overlays
 *  @param {(area: FreeArea) => void} onArea */
export function watchFreeArea(view, overlays, onArea) {
  const measure = () =>
    onArea(freeAreaOf(view.getBoundingClientRect(), overlays.map((overlay) => overlay.getBoundingClientRect())));
  const observer = new ResizeObserver(measure);
  for (const part of [view, ...overlays]) observer.observe(part);
  measure();
}
