// Where alarms are seen: one line beside the lamp, which is always there, and the list of those that were.
import { isNew, SERVER_LOST } from './alarms.js';
import { AlarmSound } from './alarm_sound.js';
import { detailText, headline, lengthText, limitText, stars, valueText } from './alarm_text.js';
import { clockText } from './strip.js';
import { messageOf } from './server_api.js';

const MOST_LISTED = 200;
const MANY = 2, TOO_MANY = 10;  // in ten minutes

/** @typedef {import('./messages.js').Alarm} Alarm
 *  @typedef {{area: HTMLElement, stars: HTMLElement, head: HTMLElement, detail: HTMLElement, told: HTMLElement,
 *    acknowledge: HTMLButtonElement, sound: HTMLButtonElement, show: HTMLButtonElement, tab: HTMLElement, list: HTMLElement,
 *    rate: HTMLElement, test: HTMLButtonElement}} Parts  told: what screen readers say when an alarm begins
 *  @typedef {{notice: (text: string) => void, jointLabel: (name: string) => string, wallMillis: (micros: number) => number,
 *    newestMicros: () => number, canPress: boolean}} Page  canPress: whether a press on the line shows its moment */

export class AlarmPanel {
  #sound = new AlarmSound();
  #drawn = '';
  #told = 0;  // id
  #isLossTold = false;
  #isUnblocking = false;  // the press now

  /** @param {Parts} parts
   *  @param {import('./alarms.js').Alarms} alarms
   *  @param {import('./shown.js').Shown} shown
   *  @param {Page} page
   *  @param {import('./keys.js').Keys} keys */
  constructor(parts, alarms, shown, page, keys) {
    this.parts = parts;
    this.alarms = alarms;
    this.shown = shown;
    this.page = page;
    parts.acknowledge.addEventListener('click', () => this.#acknowledge());
    // The press that lets the page sound is over before its click, which would mute at once.
    const press = () => { this.#isUnblocking = this.#sound.stateAt(performance.now()) === 'blocked'; };
    for (const event of ['pointerdown', 'keydown']) addEventListener(event, press, { capture: true });
    parts.sound.addEventListener('click', () => this.#mute());
    parts.show.addEventListener('click', () => {
      const first = this.alarms.shown.find(hasMoment) ?? this.alarms.last;
      if (first) this.#goTo(first);
    });
    parts.test.addEventListener('click', () => {
      this.#sound.arm();
      this.#sound.play('high');
    });
    keys.add('Alarms', 'A', 'Acknowledge all that are shown', () => { this.#acknowledge(); });
    keys.add('Alarms', 'S', 'Mute for two minutes, or sound again', () => this.#mute());
  }

  #highest() {
    return this.alarms.shown.find((alarm) => alarm.is_on && isNew(alarm))?.priority ?? null;
  }

  #mute() {
    const now = performance.now();
    if (this.#isUnblocking || this.#sound.stateAt(now) === 'blocked') this.#sound.arm();
    else this.#sound.toggleMute(now, this.#highest());
    this.#isUnblocking = false;
  }

  /** All that are shown: who has read the line has seen that there are more. */
  async #acknowledge() {
    const { parts, alarms } = this;
    if (parts.acknowledge.matches(':disabled')) return;
    try {
      for (const alarm of alarms.shown.filter(isNew)) await alarms.acknowledge(alarm);
    } catch (error) {
      this.page.notice(`The alarm was not acknowledged: ${messageOf(error)}`);
    }
  }

  /** @param {Alarm} alarm */
  #goTo(alarm) {
    const kept = this.shown.kept();
    if (kept === null) return;
    if (alarm.began.micros / 1000 < kept.oldest) return this.page.notice('The moment of this alarm is no longer kept');
    this.shown.pauseAt((alarm.began.micros + 1) / 1000);  // rounded down to µs
  }

  /** Call it several times a second.
   *  @param {number} now  ms */
  update(now) {
    const { parts, alarms } = this;
    parts.area.hidden = !alarms.isKnown;
    this.#sound.update(this.#highest(), now);
    this.#showLine();
    this.#showSound(now);
    this.#showList();
  }

  #showLine() {
    const { parts, alarms, page } = this;
    const first = alarms.shown[0] ?? null, { last } = alarms;
    const micros = page.newestMicros();
    parts.area.dataset.priority = first?.priority ?? 'none';
    parts.area.dataset.state = first === null ? 'none' : !isNew(first) ? 'acknowledged' : first.is_on ? 'on' : 'over';
    setText(parts.stars, first ? stars(first) : '');
    setText(parts.head, first ? headline(first, page.jointLabel) : alarms.isCurrent ? 'No alarm' : 'Alarms unknown');
    setText(parts.detail, first ? detailText(first, alarms.count - 1, micros) : !alarms.isCurrent ? 'the server does not answer'
      : last ? `last: ${headline(last, page.jointLabel)}, ${this.#beganText(last)}` : 'none since the start');
    parts.show.disabled = !page.canPress || !(alarms.shown.some(hasMoment) || last !== null);
    parts.acknowledge.hidden = first === null || !isNew(first);
    this.#tellLoss(alarms.shown.some(({ id }) => id === SERVER_LOST));
    const newest = Math.max(0, ...alarms.shown.filter(isNew).map(({ id }) => id));
    if (newest > this.#told && first) {
      this.#told = newest;
      setText(parts.told, `Alarm, ${first.priority}: ${headline(first, page.jointLabel)}`);
    } else if (first === null && alarms.isCurrent && this.#told > 0 && parts.told.textContent !== 'No alarm') {
      setText(parts.told, 'No alarm');
    }
  }

  /** @param {boolean} isLost  the server */
  #tellLoss(isLost) {
    if (isLost && !this.#isLossTold) setText(this.parts.told, 'Alarm, high: server lost');
    if (!isLost && this.#isLossTold) setText(this.parts.told, 'The server answers again');
    this.#isLossTold = isLost;
  }

  /** @param {number} now */
  #showSound(now) {
    const { sound } = this.parts, state = this.#sound.stateAt(now);
    sound.dataset.state = state;
    sound.dataset.played = String(this.#sound.played);
    setText(sound, state === 'blocked' ? 'Sound blocked: click' : state === 'on' ? 'Mute' : `Muted ${this.#sound.mutedFor(now)} s`);
    sound.title = state === 'blocked' ? 'The browser lets this page sound after a click in it'
      : state === 'on' ? 'Silence in this browser for two minutes (S)' : 'Sound again (S)';
  }

  #showList() {
    const { parts, alarms, page } = this;
    const log = alarms.log().slice(0, MOST_LISTED), open = alarms.shown.filter(isNew).length;
    const label = open > 0 ? `Alarms (${open})` : 'Alarms';
    setText(parts.tab, label);
    const recent = alarms.countBefore(page.newestMicros());
    setText(parts.rate, recent > TOO_MANY ? `${recent} in the last 10 minutes: raise the limits` : `${recent} in the last 10 minutes`);
    parts.rate.classList.toggle('warn', recent > MANY);
    const drawn = JSON.stringify(log.map((alarm) => [this.#beganText(alarm), alarm.is_on ? { ...alarm, value: null } : alarm]));
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    parts.list.replaceChildren(...log.map((alarm) => this.#entry(alarm)));
  }

  /** @param {Alarm} alarm
   *  @returns {string} the time of day at which it began */
  #beganText(alarm) {
    return clockText(this.page.wallMillis(alarm.began.micros), 1);
  }

  /** @param {Alarm} alarm */
  #entry(alarm) {
    const { page } = this;
    const item = document.createElement('li'), go = document.createElement('button');
    const sign = document.createElement('b'), name = document.createElement('span'), when = document.createElement('small');
    sign.textContent = stars(alarm);
    sign.dataset.priority = alarm.priority;
    name.textContent = headline({ ...alarm, value: alarm.worst }, page.jointLabel);  // of the past, the worst
    const length = alarm.over ? `lasted ${lengthText(alarm, 0)}` : 'is on';
    const who = alarm.acknowledged ? `acknowledged by ${alarm.acknowledged.role}` : alarm.is_shown ? 'not acknowledged' : '';
    when.textContent = [this.#beganText(alarm), length, limitText(alarm), who].filter(Boolean).join(' · ');
    go.type = 'button';
    go.className = 'go';
    go.title = `Show the moment when it began (worst: ${valueText(alarm.worst, alarm)})`;
    go.append(sign, name, when);
    go.addEventListener('click', () => this.#goTo(alarm));
    item.append(go);
    return item;
  }
}

/** Whether the server had a state when it began.
 *  @param {Alarm} alarm */
const hasMoment = ({ id }) => id !== SERVER_LOST;

/** @param {HTMLElement} part
 *  @param {string} text */
function setText(part, text) {
  if (part.textContent !== text) part.textContent = text;
}
