// Starts the page. Shows an error if its modules cannot be loaded, because the browser reports that only in its
// console.
try {
  new Intl.NumberFormat(navigator.language);
} catch {  // Chromium without a locale calls it en-US@posix, which Intl refuses: uPlot could not be loaded
  Object.defineProperty(navigator, 'language', { value: 'en-GB', configurable: true });
}
import('./app.js').catch((/** @type {unknown} */ error) => {
  const banner = document.getElementById('banner');
  const status = document.getElementById('status');
  const word = document.getElementById('status-word');
  if (banner) {
    banner.textContent = `The page could not start: ${error instanceof Error ? error.message : error}. `
      + 'If a file under /lib is missing, run “npm ci --prefix web” on the server.';
    banner.hidden = false;
  }
  if (status) status.dataset.level = 'disconnected';
  if (word) word.textContent = 'Page failed';
});
