// Starts the page; says what is wrong when its modules cannot be loaded, which the browser itself
// tells only in its console.
import('./app.js').catch((error) => {
  const banner = document.getElementById('banner');
  banner.textContent = `The page could not start: ${error.message}. `
    + 'If a file under /lib is missing, run “npm ci” in the server’s web folder.';
  banner.hidden = false;
  document.getElementById('lamp').dataset.level = 'disconnected';
  document.getElementById('lamp-word').textContent = 'Page failed';
});
