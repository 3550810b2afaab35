// The four arrangements of the page: desk, phone, wall and kiosk, and the people in them.
import assert from 'node:assert/strict';
import { after, before, test as nodeTest } from 'node:test';
import { endAlarm, raiseAlarm, startWithAlarms } from './alarm_page.mjs';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, openPage, PHONE, pictureOf, pixelsOfPng, saveScreenshot } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const WALL = { width: 1920, height: 1080 };
const LEAST_DIGIT = 0.047;  // of the height: 16 arc minutes at 4 m on a screen of 32 inches
let site;
before(async () => { site = await startWithAlarms(); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

/** Until the cards of `people` persons have their numbers. */
async function open(query, people, options) {
  site.say(`people ${people}`);
  site.say('live');
  const visit = await openPage(site.url + query, options);
  await visit.page.waitForFunction((count) => {
    const ratios = [...document.querySelectorAll('.person .ratio')].map((part) => part.textContent);
    return ratios.length === count && ratios.every((text) => /\d %/.test(text))
      && document.getElementById('status-word').textContent === 'Live';
  }, people, LONG);
  return visit;
}
const isVisible = (page, selector) => page.locator(selector).first().isVisible();
const boxOf = (page, selector) => page.locator(selector).first().boundingBox();
const isWide = (page) => page.evaluate(() => document.documentElement.scrollWidth > innerWidth);

test('the width decides between desk and phone, the address between all four', async () => {
  for (const [query, viewport, expected] of [
    ['', DESKTOP, 'desk'], ['', PHONE, 'phone'], ['?view=phone', DESKTOP, 'phone'], ['?view=wall', PHONE, 'wall'],
    ['?view=kiosk', DESKTOP, 'kiosk'], ['?view=desk', PHONE, 'phone'], ['?view=cinema', DESKTOP, 'desk']]) {
    const { page, problems, close } = await openPage(site.url + query, { viewport });
    await page.waitForFunction(() => document.body.dataset.view, null, LONG);
    assert.equal(await page.getAttribute('body', 'data-view'), expected, query);
    await page.setViewportSize({ width: 500, height: 900 });
    if (expected === 'desk') await page.waitForFunction(() => document.body.dataset.view === 'phone', null, LONG);
    assert.deepEqual(problems, []);
    await close();
  }
});

for (const [width, height, least, people] of [[1440, 900, 640, 1], [1440, 900, 640, 3], [1280, 720, 400, 1], [900, 640, 300, 3]]) {
  test(`a desk of ${width} x ${height} has a view of ${least} px or more, and every control is in reach, with ${people}`, async () => {
    const { page, problems, close } = await open('', people, { viewport: { width, height } });
    await page.waitForFunction(() => document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);
    const view = await boxOf(page, '#view');
    assert.ok(view.height >= least, `the view is ${view.height} px high`);
    const rows = () => page.evaluate(() => document.querySelector('.load-list').clientHeight);
    await page.locator('.stream summary').click();
    assert.ok(await rows() >= 110, `beside the table of the stream, ${await rows()} px of loads`);
    await page.locator('.stream summary').click();
    for (const tab of ['body', 'plots', 'marks', 'alarms', 'controls', 'picture', 'loads']) {
      await chooseTab(page, tab);
      const out = await page.evaluate(() => [...document.querySelectorAll('button, select, input, summary')].filter((part) => {
        const { left, right, top, bottom, width } = part.getBoundingClientRect();
        const scrolls = part.closest('.load-list, .mark-list, .plot-list, .body-map, .control-list');
        return part.checkVisibility() && width > 0 && !scrolls && (left < 0 || right > innerWidth || top < 0 || bottom > innerHeight);
      }).map((part) => part.id || part.textContent));
      if (tab === 'body') {
        const [card, hint] = await page.evaluate(() => [Math.max(...[...document.querySelectorAll('.joint-card')]
          .map((each) => each.getBoundingClientRect().bottom)), document.querySelector('.body-map .hint').getBoundingClientRect().top]);
        assert.ok(card <= hint, `the last joint ends at ${card} px, the hint begins at ${hint}`);
      }
      assert.deepEqual(out, [], tab);
    }
    await saveScreenshot(page, `desk_${width}_${people}`);
    await raiseAlarm(site, page);  // what follows holds with it
    const alarm = await page.evaluate(() => ['alarm-head', 'acknowledge', 'alarm-sound'].map((id) => {
      const { left, right, top, bottom } = document.getElementById(id).getBoundingClientRect();
      return left >= 0 && right <= innerWidth && top >= 0 && bottom <= innerHeight && right > left;
    }));
    assert.deepEqual(alarm, [true, true, true], 'the alarm and its buttons are on the screen');
    const crossed = await page.evaluate(() => {
      const parts = ['#status', '#alarm', '.readings', '#about', '#tools', '#cameras', '.points', '#loads-shown'];
      const boxes = parts.map((name) => document.querySelector(name).getBoundingClientRect());
      return parts.flatMap((name, i) => parts.slice(i + 1).filter((_, k) => {
        const one = boxes[i], two = boxes[i + 1 + k];
        return one.left < two.right && two.left < one.right && one.top < two.bottom && two.top < one.bottom;
      }).map((other) => `${name} and ${other}`));
    });
    assert.deepEqual(crossed, []);
    assert.equal(await isWide(page), false);
    await saveScreenshot(page, `desk_${width}_${people}_alarm`);
    await endAlarm(site, page);
    assert.deepEqual(problems, []);
    await close();
  });
}

/** Heights of what is drawn of digits, as a share of the height of the screen, by where they are: an "8" in the font of
 *  the place, black on white, of which the rows with dark pixels are counted. */
async function digitHeights(page, selectors) {
  // On a busy machine the stream may be stale for a moment: then there are no numbers.
  const found = await page.waitForFunction((all) => [...document.querySelectorAll('.person .ratio')].every((part) => /\d/.test(part.textContent))
    && all.flatMap((selector) => [...document.querySelectorAll(selector)]
      .filter((part) => part.checkVisibility() && /\d/.test(part.textContent)).map((part) => {
        const { fontSize, fontFamily, fontWeight, fontStretch } = getComputedStyle(part);
        return { selector, font: { fontSize, fontFamily, fontWeight, fontStretch } };
      })), selectors, LONG);
  const fonts = await found.jsonValue();
  /** @type {Map<string, number>} */ const measured = new Map();
  for (const { font } of fonts) {
    const key = JSON.stringify(font);
    if (measured.has(key)) continue;
    await page.evaluate((style) => {
      const eight = document.createElement('div');
      eight.id = 'eight';
      eight.textContent = '8';
      Object.assign(eight.style, { position: 'fixed', inset: '0', zIndex: '99', background: '#fff', color: '#000', lineHeight: '1.5',
        ...style });
      document.body.append(eight);
    }, font);
    const { width, height, data } = pixelsOfPng(await pictureOf(page));
    await page.evaluate(() => document.getElementById('eight').remove());
    const isDark = (y) => data.subarray(4 * y * width, 4 * (y * width + 400)).some((value, i) => i % 4 === 0 && value < 128);
    const rows = Array.from({ length: height }, (_, y) => y).filter(isDark);
    measured.set(key, (rows.at(-1) - rows[0] + 1) / height);
  }
  return fonts.map(({ selector, font }) => ({ selector, share: measured.get(JSON.stringify(font)) }));
}

for (const people of [1, 2, 4, 6]) {
  test(`digits on a wall with ${people} are as high as 16 arc minutes at 4 m, and nothing is cut off`, async () => {
    const { page, problems, close } = await open('?view=wall&theme=dark', people, { viewport: WALL });
    const heights = await digitHeights(page, ['#clock', '.person .ratio', '.figure b', '.joint span', '.head-name', '.person-name b']);
    assert.ok(heights.length >= 1 + 3 * Math.min(people, 4), `places with digits: ${JSON.stringify(heights)}`);
    assert.deepEqual(heights.filter(({ share }) => share < LEAST_DIGIT), []);
    console.log(`smallest digit: ${(100 * Math.min(...heights.map(({ share }) => share))).toFixed(2)} % of the height`);
    const letters = await page.evaluate((least) => [...document.querySelectorAll('body *')].filter((part) => part.checkVisibility()
      && part.offsetWidth > 1 && [...part.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim())
      && parseFloat(getComputedStyle(part).fontSize) < least && parseFloat(getComputedStyle(part).fontSize) > 0)
      .map((part) => part.id || part.className), 0.067 * WALL.height);
    assert.deepEqual(letters, [], 'all words are as large as the digits');
    const cutParts = () => page.evaluate(() => [...document.querySelectorAll('.person, .person *, #status, #clock, .head-name, #alarm, #alarm *')]
      .filter((part) => part.checkVisibility() && part.offsetWidth > 1).filter((part) => {
        const box = part.getBoundingClientRect(), card = (part.closest('.person, #status, #alarm, .stage') ?? part).getBoundingClientRect();
        return box.right > card.right + 1 || box.bottom > card.bottom + 1 || box.right > innerWidth || box.bottom > innerHeight;
      }).map((part) => `${part.className} ${part.textContent}`));
    assert.deepEqual(await cutParts(), []);
    const more = await page.evaluate(() => getComputedStyle(document.getElementById('people'), '::after').content);
    assert.equal(more.includes('and 2 more'), people === 6, more);
    for (const control of ['button:not(:disabled)', 'input', 'select', '[tabindex="0"]']) {
      assert.equal(await page.locator(`${control}:visible`).count(), 0, control);
    }
    assert.match(await page.textContent('#clock'), /^\d\d:\d\d:\d\d$/);
    await page.keyboard.press('Space');
    await page.keyboard.press('f');
    assert.equal(await page.getAttribute('body', 'data-time'), 'live', 'there are no keys');
    await saveScreenshot(page, `wall_${people}`);
    await raiseAlarm(site, page);
    assert.deepEqual(await cutParts(), [], 'with an alarm');
    await saveScreenshot(page, `wall_${people}_alarm`);
    await endAlarm(site, page);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('a long name of a source is cut on a desk, and covers no button', async () => {
  const { page, close } = await open('', 1, { viewport: DESKTOP });
  const [source, tools] = await page.evaluate((text) => {
    document.getElementById('source').textContent = text;
    return ['source', 'tools'].map((id) => document.getElementById(id).getBoundingClientRect().toJSON());
  }, `/srv/recordings/${'a_long_folder/'.repeat(12)}trial_07.mvnx`);
  assert.ok(source.right <= tools.left, `the source ends at ${source.right} px, the buttons begin at ${tools.left} px`);
  await close();
});

test('a wall shows whole what the lamp and an alarm say, whatever the lamp says', async () => {
  for (const viewport of [WALL, { width: 1280, height: 720 }, { width: 1440, height: 900 }]) {
    const { page, close } = await open('?view=wall', 1, { viewport });
    for (const [word, head] of [['Losing data 20.4 %', '20.4 % of the samples lost'], ['Recording 0:02.7 of 0:12', ''],
      ['Behind −12.4 s', 'Stream lost for 15.0 s'], ['Disconnected', 'Server lost for 15.0 s'], ['Overloaded', ''], ['Live', '']]) {
      // In one go: the page writes both again several times a second.
      const { cut, isSeen } = await page.evaluate(([says, alarm]) => {
        const line = document.getElementById('alarm');
        document.getElementById('status-word').textContent = says;
        document.getElementById('alarm-head').textContent = alarm || 'No alarm';
        line.dataset.priority = alarm ? 'high' : 'none';
        const parts = ['status-word', 'alarm-head'].map((id) => document.getElementById(id));
        const bottom = document.querySelector('main').getBoundingClientRect().top;
        const isWhole = (part) => {
          const { right, bottom: low, top } = part.getBoundingClientRect();
          return (part.scrollWidth <= part.clientWidth + 1 || part.clientWidth === 0) && right <= innerWidth && low <= bottom && top >= 0;
        };
        return {
          cut: parts.filter((part) => part.id !== 'alarm-head' || alarm).filter((part) => !isWhole(part)).map(({ id }) => id),
          isSeen: isWhole(parts[1]) || line.getBoundingClientRect().top >= document.querySelector('.topbar').getBoundingClientRect().bottom,
        };
      }, [word, head]);
      assert.deepEqual(cut, [], `${word}, ${head} on ${viewport.width} px`);
      assert.ok(isSeen, `“No alarm” is whole or not there: ${word} on ${viewport.width} px`);
    }
    await close();
  }
});

test('the wall says in large words that the stream has stopped', async () => {
  const { page, close } = await open('?view=wall', 2, { viewport: WALL });
  site.say('stale');
  await page.waitForFunction(() => document.getElementById('status-word').textContent === 'Stale', null, LONG);
  await page.waitForFunction(() => document.querySelector('.person .ratio')?.textContent === '–', null, LONG);
  assert.deepEqual(await page.$$eval('.joint span', (all) => all.filter((each) => each.scrollWidth > each.clientWidth
    || each.parentElement.scrollWidth > each.parentElement.clientWidth).map((each) => each.textContent)), []);
  const banner = await boxOf(page, '#banner'), card = await boxOf(page, '.person');
  assert.ok(banner.y + banner.height <= card.y, 'the banner covers no card');
  await saveScreenshot(page, 'wall_stale');
  await close();
});

test('a kiosk has lamp, view, body map, strip and one sentence, and nothing to press', async () => {
  const { page, problems, close } = await open('?view=kiosk', 2, { viewport: { width: 1280, height: 800 } });
  for (const part of ['#status', '#view canvas', '#body-map', '#strip-rows', '#kiosk-line']) assert.ok(await isVisible(page, part), part);
  await page.waitForFunction(() => /^Percent of what .* from 30 % .* from 60 % on it is high\.$/
    .test(document.getElementById('kiosk-line').textContent), null, LONG);
  await page.waitForFunction(() => document.querySelectorAll('.joint-card').length === 15, null, LONG);
  for (const control of ['button', 'input', 'select', 'summary', '[tabindex="0"]']) {
    assert.equal(await page.locator(`${control}:visible`).count(), 0, control);
  }
  await page.keyboard.press('Space');
  await page.keyboard.press('?');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.localName), 'body');
  assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  const out = await page.evaluate(() => [...document.querySelectorAll('.joint-card, .person, #kiosk-line, .strip')]
    .filter((part) => part.getBoundingClientRect().bottom > innerHeight).length);
  assert.equal(out, 0, 'all is on the screen');
  await saveScreenshot(page, 'kiosk');
  await raiseAlarm(site, page);
  assert.equal(await page.locator('button:visible').count(), 0, 'an alarm brings nothing to press');
  await saveScreenshot(page, 'kiosk_alarm');
  await endAlarm(site, page);
  assert.deepEqual(problems, []);
  await close();
});

/** What can be pressed on this page of the phone, outside of lists and maps that are content themselves. */
const pressed = (page) => page.evaluate(() => [...document.querySelectorAll('button, select, input')]
  .filter((part) => part.checkVisibility() && part.getBoundingClientRect().width > 1 && !part.closest('#side-loads, #body-map, #plots, .mark-list, #picture, #alarms, #alarm, #controls'))
  .map((part) => {
    const { left, right, top, bottom, width, height } = part.getBoundingClientRect();
    const inRow = part.closest('.tabs, .people') !== null;  // these rows can be moved sideways
    return { what: part.id || part.textContent, inRow, left, right, top, bottom, width, height };
  }));

for (const [name, viewport, colorScheme, people] of [
  ['phone', PHONE, 'light', 1], ['phone_two', PHONE, 'dark', 2], ['phone_small', { width: 320, height: 640 }, 'light', 1],
  ['phone_small_two', { width: 320, height: 640 }, 'dark', 2]]) {
  test(`${name}: what is pressed is in reach of a thumb and large enough, and nothing covers the feet`, async () => {
    const { page, problems, close } = await open('', people, { viewport, colorScheme });
    await page.waitForFunction(() => document.querySelectorAll('#mark-buttons button').length === 9, null, LONG);
    const third = viewport.height === PHONE.height ? viewport.height * 2 / 3 : viewport.height / 2;
    const inReach = async (tab) => {
      for (const { what, inRow, top, bottom, left, right, width, height } of await pressed(page)) {
        assert.ok(width >= 43.5 && height >= 43.5, `${tab}: ${what} is ${width} x ${height}`);
        assert.ok(top >= third - 1 && bottom <= viewport.height, `${tab}: ${what} is at ${top} to ${bottom}`);
        assert.ok(inRow || (left >= 0 && right <= viewport.width), `${tab}: ${what} is at ${left} to ${right}`);
      }
    };
    for (const tab of ['view', 'loads', 'body', 'plots', 'marks', 'alarms', 'controls', 'picture', 'more']) {
      await chooseTab(page, tab);
      await inReach(tab);
      assert.equal(await isWide(page), false, tab);
      const panel = await page.evaluate(() => document.querySelector('[data-chosen]:is(section, div)').getBoundingClientRect().height);
      assert.ok(panel >= 150, `${tab}: ${panel} px are left`);
      await saveScreenshot(page, `${name}_${tab}`);
    }
    await chooseTab(page, 'view');
    await raiseAlarm(site, page);  // what follows holds with it
    await inReach('view with an alarm');
    await saveScreenshot(page, `${name}_alarm`);
    const view = await boxOf(page, '#view canvas');
    const over = await page.evaluate(([x, y, width, height]) => {
      const covers = new Set();
      for (let i = 0.05; i < 1; i += 0.1) {
        for (let k = 0.35; k < 1; k += 0.05) {
          const part = document.elementFromPoint(x + i * width, y + k * height);
          if (part?.localName !== 'canvas') covers.add(part?.id || part?.className);
        }
      }
      return [...covers];
    }, [view.x, view.y, view.width, view.height]);
    assert.deepEqual(over, [], 'nothing lies over the lower part of the view');
    assert.ok(view.height >= 240, `the view is ${view.height} px high`);
    await endAlarm(site, page);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('the mark buttons of a phone are there with their page, and set marks', async () => {
  const { page, close } = await open('', 1, { viewport: PHONE });
  await chooseTab(page, 'marks');
  await page.click('#mark-buttons button:nth-child(3)');
  await page.waitForFunction(() => document.querySelector('#mark-list .go span')?.textContent === 'place', null, LONG);
  await chooseTab(page, 'view');
  assert.equal(await isVisible(page, '#mark-buttons'), false);
  await close();
});

test('each person has a card with name, colour and three numbers; a card chooses its person for the whole page', async () => {
  const { page, problems, close } = await open('', 3);
  await page.waitForFunction((wanted) => JSON.stringify([...document.querySelectorAll('.person')].map((card) => ({
    name: card.querySelector('.person-name').textContent,
    numbers: [...card.querySelectorAll('.figure-value')].map((value) => value.textContent),
    joint: card.querySelector('.joint').textContent, pressed: card.ariaPressed }))) === wanted,
  JSON.stringify(['Demo', 'Demo 2', 'Demo 3'].map((name, i) => (
    { name, numbers: ['2.15 kN', '8.3 cm'], joint: 'L5/S1 high', pressed: String(i === 0) }))), LONG);
  const colors = await page.$$eval('.person', (all) => all.map((card) => getComputedStyle(card).borderTopColor));
  assert.equal(new Set(colors).size, 3);
  const asked = page.waitForRequest((request) => /api\/(v1\/)?series\?person=2&keys=l5_s1/.test(request.url()));
  await page.click('.person >> text=Demo 3');
  await chooseTab(page, 'plots');
  await asked;
  await page.waitForFunction(() => document.querySelectorAll('.person')[2].ariaPressed === 'true', null, LONG);
  assert.equal(await page.inputValue('#hand-person'), '2');
  await page.keyboard.press('p');
  await page.waitForFunction(() => document.querySelectorAll('.person')[0].ariaPressed === 'true', null, LONG);
  await page.keyboard.press('Shift+P');
  await page.waitForFunction(() => document.querySelectorAll('.person')[2].ariaPressed === 'true', null, LONG);
  assert.deepEqual(problems, []);
  await close();
});

test('several people have their names over their heads, as text, and none over another', async () => {
  const { page, problems, close } = await open('?camera=right', 3);
  await page.waitForFunction(() => document.querySelectorAll('.head-name').length === 3, null, LONG);
  assert.deepEqual(await page.locator('.head-name').allTextContents(), ['Demo', 'Demo 2', 'Demo 3']);
  const boxes = await page.$$eval('.head-name', (all) => all.map((label) => label.getBoundingClientRect().toJSON()));
  for (const [i, a] of boxes.entries()) {
    for (const b of boxes.slice(i + 1)) {
      assert.ok(a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top, 'names overlap');
    }
  }
  await saveScreenshot(page, 'names_overlapping');
  site.say('people 1');
  await page.waitForFunction(() => document.querySelectorAll('.head-name').length === 0, null, LONG);
  assert.deepEqual(problems, []);
  await close();
});
