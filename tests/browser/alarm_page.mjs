// A page with an alarm: a rule that the compression of the made-up people breaks when a test says so.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { startFixture } from './open_page.mjs';

const LONG = { timeout: 60000 };  // only a failure takes so long
const RULES = `rules:
  - {name: high compression of the lower back, value: compression, above: 3400, over_after: 0.1, priority: high}
`;

/** The fixture with this rule. */
export async function startWithAlarms() {
  const folder = mkdtempSync(join(tmpdir(), 'kinescope-alarm-'));
  writeFileSync(join(folder, 'rules.yaml'), RULES);
  const site = await startFixture(['--alarms', join(folder, 'rules.yaml')]);
  rmSync(folder, { recursive: true });
  return site;
}

const stateIs = (page, states) => page.waitForFunction(
  (wanted) => wanted.includes(document.getElementById('alarm').dataset.state), states, LONG);

/** Until the page shows the alarm of all people, on or over.
 *  @param {any} site
 *  @param {any} page */
export async function raiseAlarm(site, page, isOn = true) {
  site.say(`compression ${isOn ? 4000 : 2150}`);
  await stateIs(page, [isOn ? 'on' : 'over']);
}

/** Until it is over and acknowledged, and so is the alarm for those who have left the stream before, which comes two
 *  seconds later. */
export async function endAlarm(site, page) {
  site.say('compression 2150');
  const acknowledged = page.evaluate(async () => {
    while (document.getElementById('alarm').dataset.state !== 'none') {
      const { alarms } = await (await fetch('api/v1/alarms')).json();
      for (const { id } of alarms.filter(({ is_shown: isShown, acknowledged: by, over, rule }) => isShown && by === null
        && (over !== null || rule === 'lost'))) {
        await fetch('api/v1/acknowledge', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ id }) });
      }
      await new Promise(requestAnimationFrame);
    }
  });
  await Promise.all([acknowledged, stateIs(page, ['none'])]);
}
