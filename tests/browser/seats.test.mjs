// Every seat: the keyboard alone, screen readers, a link from one page to another, a page without WebGL, a server that is
// gone.
import assert from 'node:assert/strict';
import { after, before, test as nodeTest } from 'node:test';
import { chooseTab, closeBrowser, drawNothing, openPage, PHONE, pressedCameras, saveScreenshot, settled, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
let site;
before(async () => {
  site = await startFixture();
  site.say('people 2');
  site.say('live');
});
after(async () => {
  await site.stop();
  await closeBrowser();
});

async function open(query = '', options = {}) {
  const visit = await openPage(site.url + query, options);
  await visit.page.waitForFunction(() => document.getElementById('status-word').textContent === 'Live'
    && document.querySelectorAll('.person').length === 2 && document.querySelectorAll('#cameras button').length === 7
    && Number(document.getElementById('moment').min) < -1, null, LONG);
  return visit;
}
const addressIs = (page, pattern) => page.waitForFunction((source) => new RegExp(source).test(location.search), pattern.source, LONG);
const noWebGl = (page) => page.addInitScript(() => {
  const before = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return kind === '2d' ? before.call(this, kind, ...more) : null; };
});

test('the 3-D view is turned, moved and zoomed by keys, and its arrows do not move the time', async () => {
  const { page, problems, close } = await open();
  await page.focus('#view canvas');
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), 'none', 'the focus is seen');
  await page.keyboard.press('Space');  // the same picture before and after
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  const sample = await page.textContent('#sample');
  const places = [];
  for (const key of ['ArrowLeft', 'ArrowUp', 'Shift+ArrowRight', '+', '-']) {
    await page.keyboard.press(key);
    const before = places.at(-1) ?? '';
    await page.waitForFunction((old) => {
      const camera = new URL(location.href).searchParams.get('camera');
      return camera !== null && camera !== old;
    }, before, LONG);
    places.push(await page.evaluate(() => new URL(location.href).searchParams.get('camera')));
  }
  assert.deepEqual(await pressedCameras(page), []);
  assert.equal(new Set(places.slice(0, 4)).size, 4, places.join(' | '));
  assert.equal(await page.textContent('#sample'), sample);
  await page.keyboard.press('f');
  await addressIs(page, /camera=front/);
  assert.deepEqual(await pressedCameras(page), ['front']);
  assert.deepEqual(problems, []);
  await close();
});

test('all controls of the desk are reached by Tab, and the focus is seen on each', async () => {
  const { page, close } = await open();
  await page.evaluate(() => {
    window.toReach = new Set([...document.querySelectorAll('button, select, input, summary, canvas[tabindex="0"]')]
      .filter((part) => part.checkVisibility() && !part.disabled && part.tabIndex >= 0));
  });
  for (let i = 0; i < 80; ++i) {
    await page.keyboard.press('Tab');
    const { isSeen, what } = await page.evaluate(() => {
      const part = document.activeElement, { outlineStyle, outlineWidth } = getComputedStyle(part);
      window.toReach.delete(part);
      return { what: part.outerHTML.slice(0, 120),
        isSeen: part === document.body || (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2) };
    });
    assert.ok(isSeen, what);
  }
  assert.deepEqual(await page.evaluate(() => [...window.toReach].map((part) => part.outerHTML.slice(0, 120))), []);
  await close();
});

test('the key map lists what exists, and its switch turns keys of one character off for good', async () => {
  const { page, problems, close } = await open();
  await page.keyboard.press('?');
  await page.locator('#key-map').waitFor({ state: 'visible', ...LONG });
  const rows = await page.$$eval('#key-list dl > div', (all) => all.map((row) => row.textContent));
  for (const row of [/Space.*Pause or play/, /Esc.*End.*Live/, /F.*Camera front/, /P.*next person/, /1.*9.*Set a mark/, /D.*Dark/,
    /C.*Copy a link/, /\?.*This map/, /\+.*-.*Nearer/]) {
    assert.ok(rows.some((text) => row.test(text)), `${row} in ${rows.join('; ')}`);
  }
  await saveScreenshot(page, 'key_map');
  await page.keyboard.press('f');
  assert.deepEqual(await pressedCameras(page), ['three_quarter'], 'the map is in front');
  await page.uncheck('#character-keys');
  await page.keyboard.press('Escape');
  await page.locator('#key-map').waitFor({ state: 'hidden', ...LONG });
  assert.equal(await page.getAttribute('body', 'data-time'), 'live');
  for (const key of ['f', '1', 'd', '?']) await page.keyboard.press(key);
  assert.deepEqual(await pressedCameras(page), ['three_quarter']);
  assert.equal(await page.locator('#key-map').isVisible(), false);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  await page.reload();
  await page.waitForFunction(() => document.querySelectorAll('#cameras button').length === 7, null, LONG);
  await page.keyboard.press('f');
  assert.deepEqual(await pressedCameras(page), ['three_quarter'], 'the browser keeps the choice');
  await page.click('#show-keys');
  assert.equal(await page.isChecked('#character-keys'), false);
  assert.deepEqual(problems.filter((line) => !line.startsWith('failed: ')), [], 'but for requests that the reload cut short');
  await close();
});

test('screen readers hear of a new state of the lamp once, and not of each sample', async () => {
  const { page, close } = await open();
  await page.evaluate(() => {
    window.said = [];
    new MutationObserver(() => window.said.push(document.getElementById('announcer').textContent))
      .observe(document.getElementById('announcer'), { childList: true, characterData: true, subtree: true });
  });
  await page.keyboard.press('Space');
  await page.waitForFunction(() => /^Behind −[1-9]/.test(document.getElementById('status-word').textContent), null, LONG);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => window.said.includes('Live'), null, LONG);
  const said = await page.evaluate(() => window.said);
  assert.equal(said.filter((text) => /^Behind/.test(text)).length, 1, said.join(' | '));
  const regions = await page.$$eval('[aria-live], [role="status"], [role="alert"], [role="log"]', (all) => all.map(({ id }) => id));
  assert.deepEqual(regions.filter((id) => !['announcer', 'mark-said', 'alarm-told', 'clip-note'].includes(id)), []);
  await close();
});

test('changes of load classes are said, a few times a minute', async () => {
  const { page, close } = await open();
  await page.evaluate(() => {
    window.said = [];
    new MutationObserver(() => window.said.push({ at: performance.now(), text: document.getElementById('announcer').textContent }))
      .observe(document.getElementById('announcer'), { childList: true, characterData: true, subtree: true });
  });
  // The made-up people bend and rise: some joint goes over a limit again and again.
  await page.waitForFunction(() => window.said.filter(({ text }) => /(high|medium|low), \d+ %/.test(text)).length >= 2, null, LONG);
  const said = await page.evaluate(() => window.said.filter(({ text }) => /(high|medium|low), \d+ %/.test(text)));
  assert.ok(said.every(({ at }, i) => i === 0 || at - said[i - 1].at >= 4900), JSON.stringify(said));
  await close();
});

test('a link shows another person the same moment, person, joints, camera, panel, window and theme', async () => {
  const one = await open('', { isDrawn: true, context: { permissions: ['clipboard-read', 'clipboard-write'] } });
  const { page } = one;
  await page.click('.person[data-character="1"]');
  await chooseTab(page, 'body');
  await page.click('.joint-card[data-joint="left_knee"]');
  await chooseTab(page, 'plots');
  await page.click('#plot-window >> text=5 min');
  await page.keyboard.press('d');
  await page.focus('#view canvas');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.body.dataset.time === 'behind' && new URL(location.href).searchParams.has('t'), null, LONG);
  await addressIs(page, /person=1.*tab=plots|tab=plots.*person=1/);
  const sample = await page.textContent('#sample');
  await page.click('#copy-link');
  await page.waitForFunction(() => /link to this moment is copied/.test(document.getElementById('banner').textContent), null, LONG);
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const two = await openPage(link, { isDrawn: true });
  await two.page.waitForFunction((wanted) => document.getElementById('sample').textContent === wanted
    && /^Behind/.test(document.getElementById('status-word').textContent), sample, LONG);
  await two.page.waitForFunction(() => document.querySelector('.person[data-character="1"]')?.ariaPressed === 'true', null, LONG);
  const what = (where) => where.evaluate(() => ({
    tab: document.getElementById('side').dataset.tab, joints: document.getElementById('plot-chosen').textContent,
    window: document.querySelector('#plot-window [aria-pressed="true"]').textContent,
    page: getComputedStyle(document.body).getPropertyValue('--page'), camera: new URL(location.href).searchParams.get('camera'),
  }));
  await two.page.waitForFunction(() => new URL(location.href).searchParams.has('camera'), null, LONG);
  assert.deepEqual(await what(two.page), await what(page));
  assert.equal((await what(two.page)).page.trim(), '#0f1318');
  const [a, b] = [await settled(page, '#view canvas'), await settled(two.page, '#view canvas')];
  let differ = 0;
  for (let i = 0; i < a.data.length; i += 4) if (Math.abs(a.data[i] - b.data[i]) > 40) ++differ;
  await saveScreenshot(page, 'link_from');
  await saveScreenshot(two.page, 'link_to');
  assert.ok(differ < 0.02 * a.data.length / 4, `${differ} pixels of the views differ`);
  assert.deepEqual([...one.problems, ...two.problems], []);
  await one.close();
  await two.close();
});

test('a live page copies the moment of its sample, and its own address stays without', async () => {
  const { page, close } = await open('', { context: { permissions: ['clipboard-read', 'clipboard-write'] } });
  await page.keyboard.press('c');
  await page.waitForFunction(() => /is copied/.test(document.getElementById('banner').textContent), null, LONG);
  const link = new URL(await page.evaluate(() => navigator.clipboard.readText()));
  assert.match(link.searchParams.get('t'), /^\d+\.\d{6}$/);
  assert.equal(new URL(page.url()).search, '');
  await close();
});

test('an address that is nonsense is a page as it begins', async () => {
  const { page, problems, close } = await open('?person=99&joint=nose,l5_s1&camera=1,2&tab=hidden&view=cinema&theme=pink&window=7');
  await chooseTab(page, 'plots');
  await page.waitForFunction(() => document.getElementById('plot-chosen').textContent === 'L5/S1', null, LONG);
  assert.deepEqual(await pressedCameras(page), ['three_quarter']);
  assert.equal(await page.getAttribute('.person >> nth=0', 'aria-pressed'), 'true');
  assert.deepEqual(problems, []);
  await close();
});

const marksOf = (page) => page.evaluate(async () => (await (await fetch('api/v1/marks')).json()).marks);

/** A mark has the sample that the picture shows, not the newest one. Of live pictures the fixture draws every fourth state.
 *  @param {any} page
 *  @param {() => Promise<number>|null} stateIn  of the picture; null: it is live */
async function markedIsInPicture(page, stateIn) {
  for (let i = 0; i < 4; ++i) {
    const count = (await marksOf(page)).length;
    const wanted = await stateIn();
    await page.keyboard.press('2');
    const until = Date.now() + LONG.timeout;
    let marks = await marksOf(page);
    while (marks.length === count && Date.now() < until) marks = await marksOf(page);
    assert.equal(marks.length, count + 1, 'a mark has been set');
    const mark = marks.at(-1);
    if (wanted === null) assert.equal(mark.at.state % 4, 0, `marked ${mark.at.state}, which is in no picture`);
    else assert.equal(mark.at.state, wanted);
  }
}

for (const [name, options] of [['desk', {}], ['phone', { viewport: PHONE, colorScheme: 'dark' }]]) {
  test(`without WebGL the server's picture takes the stage, and the cameras are its cameras, on a ${name}`, async () => {
    const { page, problems, close } = await open('', { ...options, beforeLoad: noWebGl });
    await page.locator('#view #picture-image').waitFor({ state: 'visible', ...LONG });
    const view = await page.locator('#view').boundingBox(), picture = await page.locator('#picture-image').boundingBox();
    assert.ok(picture.width > 0.95 * view.width && picture.height > 0.95 * view.height);
    await page.click('[data-camera="top"]');
    await page.waitForFunction(() => document.querySelector('#cameras [aria-pressed="true"]')?.dataset.camera === 'top'
      && document.getElementById('picture-camera').value === 'top', null, LONG);
    await saveScreenshot(page, `no_webgl_${name}`);
    await markedIsInPicture(page, () => null);
    await page.click('#play');
    // The fixture draws the number of a former state in green and blue.
    const drawn = () => page.waitForFunction(() => {
      const image = document.getElementById('picture-image'), canvas = document.createElement('canvas').getContext('2d');
      if (image.hidden || image.naturalWidth === 0 || document.body.dataset.time !== 'behind') return null;
      canvas.drawImage(image, 0, 0);
      const [red, green, blue] = canvas.getImageData(5, 5, 1, 1).data;
      return red === 255 && { state: 256 * green + blue };
    }, null, LONG).then((handle) => handle.jsonValue());
    const { state } = await drawn();
    await page.keyboard.press('Shift+ArrowLeft');
    await page.waitForFunction(([before]) => {
      const image = document.getElementById('picture-image'), canvas = document.createElement('canvas').getContext('2d');
      canvas.drawImage(image, 0, 0);
      const [, green, blue] = canvas.getImageData(5, 5, 1, 1).data;
      return 256 * green + blue < before;
    }, [state], LONG);
    await markedIsInPicture(page, async () => (await drawn()).state);
    await saveScreenshot(page, `no_webgl_behind_${name}`);
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => {
      const image = document.getElementById('picture-image'), canvas = document.createElement('canvas').getContext('2d');
      if (image.hidden || document.body.dataset.time !== 'live') return false;
      canvas.drawImage(image, 0, 0);
      return canvas.getImageData(5, 5, 1, 1).data[0] < 100;
    }, null, LONG);
    assert.deepEqual(problems.filter((line) => !/Error creating WebGL context/.test(line)), []);
    await close();
  });
}

test('a viewer without WebGL sees why the cameras are not for them', async () => {
  const guarded = await startFixture(['--token', '0perator-of-the-lab', '--viewer_token', 'v1ewer-of-the-lab']);
  const { page, close } = await openPage(guarded.viewer_url, { beforeLoad: noWebGl });
  await page.waitForFunction(() => document.querySelectorAll('#cameras button').length === 7, null, LONG);
  await page.waitForFunction(() => document.getElementById('role').dataset.role === 'viewer', null, LONG);
  assert.ok(await page.locator('#cameras button').first().isDisabled());
  await close();
  await guarded.stop();
});

test('a dark page has a dark picture of the server, and the light page of another viewer makes it light for both', async () => {
  const isDark = (page, wanted) => page.waitForFunction((dark) => {
    const image = document.getElementById('picture-image'), canvas = document.createElement('canvas').getContext('2d');
    if (image.hidden || image.naturalWidth === 0) return false;
    canvas.drawImage(image, 0, 0);
    return (canvas.getImageData(5, 5, 1, 1).data[2] < 100) === dark;
  }, wanted, LONG);
  const one = await open('?theme=dark&tab=picture');
  await isDark(one.page, true);
  const asked = one.page.waitForRequest(/snapshot\.png\?.*theme=dark/);
  await one.page.click('#save-picture');
  await asked;
  const two = await open('?theme=light&tab=picture');
  await isDark(one.page, false);
  await isDark(two.page, false);
  await chooseTab(two.page, 'loads');
  await isDark(one.page, true);
  await one.page.keyboard.press('d');
  await isDark(one.page, false);
  assert.deepEqual([...one.problems, ...two.problems], []);
  await one.close();
  await two.close();
});

test('when the server is gone, its last picture is grey and says so', async () => {
  const mortal = await startFixture();
  const { page, close } = await openPage(mortal.url);
  await chooseTab(page, 'picture');
  await page.locator('#picture-image').waitFor({ state: 'visible', ...LONG });
  await mortal.kill();
  await page.waitForFunction(() => /^The server does not answer\. This picture is the last one, of \d\d:\d\d:\d\d$/
    .test(document.getElementById('picture-note').textContent), null, LONG);
  assert.ok(await page.locator('#picture-note').isVisible());
  assert.match(await page.locator('#picture-image').evaluate((image) => getComputedStyle(image).filter), /grayscale/);
  assert.ok(await page.locator('#save-picture').isDisabled());
  await saveScreenshot(page, 'server_gone');
  await close();
});

test('who asked for less motion gets a view that does not glide', async () => {
  const { page, close } = await open('', { context: { reducedMotion: 'reduce' } });
  const moving = await page.evaluate(() => [...document.querySelectorAll('*')].filter((part) => {
    const { transitionDuration, animationName } = getComputedStyle(part);
    return transitionDuration.split(',').some((text) => parseFloat(text) > 0) || animationName !== 'none';
  }).map((part) => part.className));
  assert.deepEqual(moving, []);
  await close();
});
