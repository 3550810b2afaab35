// The bar below the view: pause, steps, speed, a slider over all moments that the server has (strip.js draws what lies
// under it), and back to live; with the keys for them.
import { lag } from './format.js';
import { SPEEDS } from './viewer_time.js';

const STEP_MILLIS = 1000, PAGE_MILLIS = 10_000;

/** @typedef {import('./viewer_time.js').Kept} Kept
 *  @typedef {{bar: HTMLElement, play: HTMLButtonElement, back: HTMLButtonElement, forward: HTMLButtonElement,
 *    speed: HTMLSelectElement, slider: HTMLInputElement, oldest: HTMLElement, live: HTMLButtonElement}} Parts
 */

/** @param {Parts} parts
 *  @param {import('./shown.js').Shown} shown
 *  @param {(moment: number) => string} wordsAt  what the strip shows at a moment, for screen readers
 *  @param {import('./keys.js').Keys} keys
 *  @returns {(now: number) => void}  shows where the viewer is; call it several times a second */
export function mountTransport(parts, shown, wordsAt, keys) {
  const { time } = shown;
  parts.speed.replaceChildren(...SPEEDS.map((speed) => new Option(`${speed} ×`, String(speed), speed === 1, speed === 1)));

  /** @param {(now: number, kept: Kept) => void} act */
  const change = (act) => {
    const kept = shown.kept();
    if (kept === null) return;
    act(performance.now(), kept);
    shown.onTimeChanged();
  };
  const pauseOrPlay = () => change((now, kept) => {
    if (time.isPlaying) time.pause(now, kept, shown.millis ?? undefined);
    else time.play(now, kept);
  });
  const goLive = () => change(() => time.goLive());
  /** @param {1|-1} by  sample */
  const step = (by) => change((now, kept) => {
    time.pause(now, kept, shown.millis ?? undefined);
    shown.stepBy(by);
  });
  /** @param {number} millis */
  const skip = (millis) => change((now, kept) => time.seek(time.momentAt(now, kept) + millis, now, kept));

  /** @param {1|-1} by  place in the list of speeds */
  const changeSpeed = (by) => change((now, kept) => {
    const next = SPEEDS[SPEEDS.findIndex((speed) => speed === time.speed) + by];
    if (next !== undefined) time.setSpeed(next, now, kept);
  });

  parts.play.addEventListener('click', pauseOrPlay);
  parts.back.addEventListener('click', () => step(-1));
  parts.forward.addEventListener('click', () => step(1));
  parts.live.addEventListener('click', goLive);
  parts.speed.addEventListener('change', () =>
    change((now, kept) => time.setSpeed(Number(parts.speed.value), now, kept)));
  parts.slider.addEventListener('input', () => change((now, kept) => {
    time.seek(kept.newest + 1000 * Number(parts.slider.value), now, kept);
  }));

  const held = { repeats: true };
  keys.add('Time', 'Space', 'Pause or play', pauseOrPlay);
  keys.add('Time', 'ArrowLeft', 'One sample back', () => step(-1), held);
  keys.add('Time', 'ArrowRight', 'One sample forward', () => step(1), held);
  keys.add('Time', 'Shift+ArrowLeft', 'One second back', () => skip(-STEP_MILLIS), held);
  keys.add('Time', 'Shift+ArrowRight', 'One second forward', () => skip(STEP_MILLIS), held);
  keys.add('Time', 'PageUp', 'Ten seconds back', () => skip(-PAGE_MILLIS), held);
  keys.add('Time', 'PageDown', 'Ten seconds forward', () => skip(PAGE_MILLIS), held);
  keys.add('Time', 'Home', 'The oldest sample', () => change((now, kept) => time.seek(kept.oldest, now, kept)));
  keys.add('Time', ['Escape', 'End'], 'Live, or the end of a recording', goLive);
  keys.add('Time', '<', 'Slower', () => changeSpeed(-1));
  keys.add('Time', '>', 'Faster', () => changeSpeed(1));

  return (now) => {
    const kept = shown.kept();
    parts.bar.hidden = kept === null;
    if (kept === null) return;
    const behind = kept.newest - time.momentAt(now, kept), length = kept.newest - kept.oldest;
    parts.play.dataset.act = time.isPlaying ? 'pause' : 'play';
    parts.play.ariaLabel = time.isPlaying ? 'Pause' : 'Play';
    parts.live.disabled = behind === 0;
    parts.live.textContent = shown.newestDetails.recording ? 'End' : 'Live';
    parts.speed.value = String(time.speed);
    parts.slider.min = (-length / 1000).toFixed(3);
    parts.slider.max = '0';
    parts.slider.value = (-behind / 1000).toFixed(3);
    // Live, the classes would be read aloud all the time.
    const where = time.isLive ? 'live' : [lag(behind), wordsAt(kept.newest - behind)].filter(Boolean).join(', ');
    if (parts.slider.getAttribute('aria-valuetext') !== where) parts.slider.setAttribute('aria-valuetext', where);
    parts.oldest.textContent = lag(length);
  };
}
