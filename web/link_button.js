// The button that copies the address of what is on the screen: a link always has the moment, also of a live page.
import { withShown } from './address.js';

/** @param {HTMLButtonElement} button
 *  @param {() => Partial<import('./address.js').Shown>} shown
 *  @param {(text: string) => void} notice
 *  @returns {() => Promise<void>}  what the button does */
export function mountLinkButton(button, shown, notice) {
  const copy = async () => {
    const link = withShown(new URL(location.href), shown()).href;
    notice(await copied(link) ? 'The link to this moment is copied' : `The browser does not let the page copy. The link: ${link}`);
  };
  button.addEventListener('click', copy);
  return copy;
}

/** Browsers give the clipboard to pages of this machine and with TLS only; for others there is an older way.
 *  @param {string} text */
async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = document.createElement('textarea'), before = document.activeElement;
    field.className = 'visually-hidden';
    field.value = text;
    document.body.append(field);
    field.select();
    const isDone = document.execCommand('copy');
    field.remove();
    if (before instanceof HTMLElement) before.focus();
    return isDone;
  }
}
