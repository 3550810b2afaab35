// axe-core finds nothing serious or critical in any arrangement of the page, in both themes and in its main states.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { after, before, test as nodeTest } from 'node:test';
import { endAlarm, raiseAlarm, startWithAlarms } from './alarm_page.mjs';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, openPage, PHONE, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 240000 }, body);
const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
let site;
before(async () => { site = await startWithAlarms(); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

/** Rules that are broken, with the places. The policy of the page forbids scripts of others, so the page's own
 *  security is switched off for these tests only (bypassCSP). */
async function brokenRules(page) {
  const { violations } = await page.evaluate((tags) => globalThis.axe.run(document, { runOnly: tags }), TAGS);
  return violations.filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.map(({ target, failureSummary }) => `${target} ${failureSummary.split('\n')[1]?.trim()}`).join('; ')}`);
}

async function open(query, colorScheme, viewport, people = 2) {
  site.say(`people ${people}`);
  site.say('live');
  const { page, close } = await openPage(site.url + query, { viewport, colorScheme, context: { bypassCSP: true } });
  await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live'
    && document.querySelectorAll('.person .ratio').length > 0, null, LONG);
  await page.addScriptTag({ path: axe });
  return { page, close };
}

// Each arrangement in one theme: the colours are those of the theme, wherever they are.
for (const colorScheme of ['light', 'dark']) {
  for (const [name, viewport, tabs] of [
    ['desk', DESKTOP, ['loads', 'body', 'plots', 'marks', 'alarms', 'controls', 'picture']],
    ['phone', PHONE, ['view', 'loads', 'body', 'plots', 'marks', 'alarms', 'controls', 'picture', 'more']]]) {
    if ((name === 'desk') !== (colorScheme === 'light')) continue;
    test(`every panel of the ${colorScheme} ${name}`, async () => {
      const { page, close } = await open(`?view=${name}`, colorScheme, viewport);
      for (const tab of tabs) {
        await chooseTab(page, tab);
        assert.deepEqual(await brokenRules(page), [], tab);
      }
      for (const isOn of [true, false]) {
        await raiseAlarm(site, page, isOn);
        assert.deepEqual(await brokenRules(page), [], `an alarm that is ${isOn ? 'on' : 'over'}`);
      }
      await endAlarm(site, page);
      if (name === 'desk') {
        await page.click('#show-keys');
        assert.deepEqual(await brokenRules(page), [], 'key map');
      }
      await close();
    });
  }

  test(`walls and kiosks, ${colorScheme}`, async () => {
    for (const [view, people] of colorScheme === 'light' ? [['wall', 1], ['kiosk', 2]] : [['wall', 2], ['wall', 4]]) {
      const { page, close } = await open(`?view=${view}`, colorScheme, { width: 1920, height: 1080 }, people);
      assert.deepEqual(await brokenRules(page), [], `${view} with ${people}`);
      await raiseAlarm(site, page);
      assert.deepEqual(await brokenRules(page), [], `${view} with ${people} and an alarm`);
      await endAlarm(site, page);
      await close();
    }
  });

  test(`behind, stale and no data, ${colorScheme}`, async () => {
    const { page, close } = await open('', colorScheme, DESKTOP, 1);
    await page.keyboard.press('Space');
    await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
    assert.deepEqual(await brokenRules(page), [], 'behind');
    await page.keyboard.press('Escape');
    for (const [order, word] of [['stale', 'Stale'], ['nodata', 'No data']]) {
      site.say(order);
      await page.waitForFunction((wanted) => document.getElementById('status-word').textContent === wanted, word, LONG);
      assert.deepEqual(await brokenRules(page), [], word);
    }
    site.say('live');
    await close();
  });
}

test('losing data, as a viewer, and without a server', async () => {
  const guarded = await startFixture(['--token', '0perator-of-the-lab', '--viewer_token', 'v1ewer-of-the-lab']);
  const never = { count: 0, count_10s: 0, last_micros: null };
  guarded.say(`stream ${JSON.stringify({ samples: 4567, lost: 12, incomplete: never, loss_10s: 0.06, loss: 0.06, jitter_ms: 0.8,
    gaps: never, rejected: [], clocks: [] })}`);
  const { page, close } = await openPage(guarded.viewer_url, { context: { bypassCSP: true } });
  await page.waitForFunction(() => /^Losing data/.test(document.getElementById('status-word').textContent), null, LONG);
  await page.waitForFunction(() => document.getElementById('role').dataset.role === 'viewer', null, LONG);
  await page.addScriptTag({ path: axe });
  assert.deepEqual(await brokenRules(page), [], 'losing');
  await guarded.kill();
  await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Disconnected', null, LONG);
  assert.deepEqual(await brokenRules(page), [], 'disconnected');
  await close();
});
