// Which marks an axis of time has room for: of thousands, most would lie on others.

const LEAST_GAP = 3;  // px

/** Those that are drawn: at most two for each gap of the axis.
 *  @template {{micros: number, endMicros: number|null}} Flag
 *  @param {readonly Flag[]} flags  in the order of their moments
 *  @param {{from: number, to: number}} window  µs
 *  @param {(micros: number) => number} xOf  px
 *  @returns {Flag[]} */
export function flagsApart(flags, { from, to }, xOf) {
  let last = -Infinity, farthest = -Infinity;  // px, of those that are drawn
  return flags.filter(({ micros, endMicros }) => {
    const end = endMicros ?? micros;
    if (end < from || micros > to) return false;
    const x = xOf(micros), endX = xOf(end);
    if (x - last < LEAST_GAP && endX - farthest < LEAST_GAP) return false;
    last = x;
    farthest = Math.max(farthest, endX);
    return true;
  });
}
