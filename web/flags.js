// Which marks an axis of time has room for: of thousands, most would lie on others.

const LEAST_GAP = 3;  // px

/** Those that are drawn: at most two for each gap of the axis; `hasRoom`: for its sign, beside that of another.
 *  @template {{micros: number, endMicros: number|null}} Flag
 *  @param {readonly Flag[]} flags  in the order of their moments
 *  @param {{from: number, to: number}} window  µs
 *  @param {(micros: number) => number} xOf  px
 *  @param {number} signPx  that a sign takes
 *  @returns {(Flag & {hasRoom: boolean})[]} */
export function flagsApart(flags, { from, to }, xOf, signPx) {
  let last = -Infinity, farthest = -Infinity, lastSign = -Infinity;  // px, of those that are drawn
  return flags.flatMap((flag) => {
    const end = flag.endMicros ?? flag.micros;
    if (end < from || flag.micros > to) return [];
    const x = xOf(flag.micros), endX = xOf(end);
    if (x - last < LEAST_GAP && endX - farthest < LEAST_GAP) return [];
    last = x;
    farthest = Math.max(farthest, endX);
    const hasRoom = flag.micros >= from && x - lastSign >= signPx;
    if (hasRoom) lastSign = x;
    return [{ ...flag, hasRoom }];
  });
}
