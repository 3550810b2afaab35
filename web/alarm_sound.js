// The sound of alarms: patterns of pulses by priority. Browsers stay silent until a first click or key in the page, which
// is a state that the page shows. Muting is this browser's own, for two minutes.

/** @typedef {import('./messages.js').Priority} Priority
 *  @typedef {'blocked'|'on'|'muted'} SoundState */

/** @type {Record<Priority, {pulses: number[], hz: number, every: number}>}  pulses: s from the first; every: s */
const PATTERNS = {
  high: { pulses: [0, 0.25, 0.5, 0.95, 1.2], hz: 880, every: 10 },
  medium: { pulses: [0, 0.3, 0.6], hz: 660, every: 25 },
  low: { pulses: [0], hz: 520, every: 30 },
};
const RANK = { low: 1, medium: 2, high: 3 };
const MUTE_MILLIS = 120_000;
const PULSE_SECS = 0.15, EDGE_SECS = 0.02, LOUDNESS = 0.15;

export class AlarmSound {
  /** @type {AudioContext|null} */ #context = null;
  #mutedUntil = -Infinity;
  #mutedRank = 0;  // of what was on when it was muted
  #playedAt = -Infinity;
  #playedRank = 0;
  played = 0;  // patterns so far

  constructor() {
    const arm = () => { this.arm(); };
    for (const event of ['pointerdown', 'keydown']) addEventListener(event, arm, { capture: true });
    this.arm();  // browsers that the user has told to allow sound need no click
  }

  /** Call it while the browser handles a click or a key. */
  arm() {
    try {
      this.#context ??= new AudioContext();
      if (this.#context.state === 'suspended') this.#context.resume().catch(() => {});
    } catch {
      this.#context = null;  // a browser without sound: it stays "blocked", and says so
    }
  }

  /** @param {number} now  ms
   *  @returns {SoundState} */
  stateAt(now) {
    if (this.#context?.state !== 'running') return 'blocked';
    return now < this.#mutedUntil ? 'muted' : 'on';
  }

  /** @param {number} now  ms
   *  @returns {number}  s */
  mutedFor(now) {
    return Math.max(0, Math.ceil((this.#mutedUntil - now) / 1000));
  }

  /** Silence for two minutes, or sound again.
   *  @param {number} now
   *  @param {Priority|null} priority  of what is on */
  toggleMute(now, priority) {
    const isMuted = now < this.#mutedUntil;
    this.#mutedUntil = isMuted ? -Infinity : now + MUTE_MILLIS;
    this.#mutedRank = isMuted || priority === null ? 0 : RANK[priority];
  }

  /** Call it several times a second.
   *  @param {Priority|null} priority  the highest that is on and not acknowledged
   *  @param {number} now  ms */
  update(priority, now) {
    if (priority === null) {
      this.#playedRank = 0;
      this.#playedAt = -Infinity;
      return;
    }
    const rank = RANK[priority];
    if (this.#context?.state !== 'running') return;
    if (now < this.#mutedUntil) {
      if (rank <= this.#mutedRank) return;
      this.#mutedRank = rank;  // a higher one sounds once
    } else if (rank <= this.#playedRank && now - this.#playedAt < 1000 * PATTERNS[priority].every) {
      return;
    }
    this.play(priority);
    this.#playedRank = rank;
    this.#playedAt = now;
  }

  /** @param {Priority} priority */
  play(priority) {
    const context = this.#context;
    if (context?.state !== 'running') return;
    this.played += 1;
    const { pulses, hz } = PATTERNS[priority];
    for (const pulse of pulses) {
      const start = context.currentTime + EDGE_SECS + pulse, end = start + PULSE_SECS;
      const tone = new OscillatorNode(context, { frequency: hz }), gain = new GainNode(context, { gain: 0 });
      gain.gain.setValueAtTime(0, start);
      gain.gain.linearRampToValueAtTime(LOUDNESS, start + EDGE_SECS);
      gain.gain.setValueAtTime(LOUDNESS, end - EDGE_SECS);
      gain.gain.linearRampToValueAtTime(0, end);
      tone.connect(gain).connect(context.destination);
      tone.start(start);
      tone.stop(end);
    }
  }
}
