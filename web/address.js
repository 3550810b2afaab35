// The address of the page holds what it shows, so that a link shows another person the same. Pure but for the two
// functions at the end.

/** @typedef {{micros: number|null}} Shown  micros: the moment of a viewer who looks back; null: live */

/** @param {URL} url
 *  @returns {Shown} */
export function shownIn(url) {
  const text = url.searchParams.get('t');
  const seconds = text === null || text === '' ? NaN : Number(text);
  return { micros: Number.isFinite(seconds) && seconds >= 0 ? 1e6 * seconds : null };
}

/** The moment is rounded up to microseconds, so that the sample that is shown is not after it.
 *  @param {URL} url
 *  @param {Shown} shown
 *  @returns {URL} */
export function withShown(url, { micros }) {
  const next = new URL(url);
  if (micros === null) next.searchParams.delete('t');
  else next.searchParams.set('t', (Math.ceil(micros) / 1e6).toFixed(6));
  return next;
}

/** The cookie has been set, so the token is not needed in history and bookmarks. */
export function forgetToken() {
  const url = new URL(location.href);
  if (!url.searchParams.has('token')) return;
  url.searchParams.delete('token');
  history.replaceState(null, '', url);
}

/** @param {Shown} shown */
export function showInAddress(shown) {
  const url = withShown(new URL(location.href), shown);
  if (url.href !== location.href) history.replaceState(null, '', url);
}
