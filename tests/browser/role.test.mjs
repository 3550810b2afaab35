// Roles on the page: what a viewer sees, and what a browser without the right token sees.
import assert from 'node:assert/strict';
import { after, before, test as nodeTest } from 'node:test';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, openPage, PHONE, saveScreenshot, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const OPERATOR = '0perator-of-the-lab', VIEWER = 'v1ewer-of-the-lab';
let site;
before(async () => { site = await startFixture(['--token', OPERATOR, '--viewer_token', VIEWER]); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

const roleIs = (page, role) =>
  page.waitForFunction((wanted) => document.getElementById('role').dataset.role === wanted, role, LONG);
const GATED = ['#picture-camera', '#hand', '#hand-kg', '#hand-load button'];
const CONTROLS = ['#trial-person', '#trial-run', '#recording-run', '#clip-last', '#clip-next', '#clip-begin', '#person-mass', '#person-sex',
  '#hands-right', '#hands-form button', '#limits-medium', '#limits-form button'];

for (const [name, viewport, colorScheme] of [
  ['desktop', DESKTOP, 'light'], ['phone_dark', PHONE, 'dark']]) {
  test(`a viewer sees every control, and why some are disabled, on ${name}`, async () => {
    const { page, problems, close } = await openPage(site.viewer_url, { viewport, colorScheme });
    await roleIs(page, 'viewer');
    for (const selector of GATED) {
      await chooseTab(page, selector.startsWith('#picture') ? 'picture' : 'loads');
      const control = page.locator(selector);
      assert.ok(await control.isVisible(), selector);
      assert.ok(await control.isDisabled(), selector);
      assert.match(await control.evaluate((part) => part.closest('[title^="Only"]')?.title ?? ''), /operator’s token/, selector);
      assert.equal(await control.evaluate((part) => getComputedStyle(part).borderTopStyle), 'dashed', selector);
    }
    await chooseTab(page, 'controls');
    for (const selector of CONTROLS) {
      assert.ok(await page.locator(selector).isVisible(), selector);
      assert.ok(await page.locator(selector).isDisabled(), selector);
    }
    await chooseTab(page, 'loads');
    assert.match(await page.locator('#role').textContent(), /^Role: viewer\. .*operator’s token$/);
    const { scroll, client } = await page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth, client: document.documentElement.clientWidth }));
    assert.ok(scroll <= client, `${scroll} px wide on ${client}`);
    await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
    await saveScreenshot(page, `viewer_${name}`);
    assert.deepEqual(problems, []);
    await close();
  });
}

test('a viewer may look back, and an operator may change what all see', async () => {
  const viewer = await openPage(site.viewer_url);
  await roleIs(viewer.page, 'viewer');
  await viewer.page.waitForFunction(() => !document.getElementById('transport').hidden, null, LONG);
  await viewer.page.click('#play');
  await viewer.page.waitForFunction(() => document.body.dataset.time === 'behind', null, LONG);
  const operator = await openPage(site.url);
  await roleIs(operator.page, 'operator');
  for (const selector of [...GATED, ...CONTROLS]) assert.ok(await operator.page.locator(selector).isEnabled(), selector);
  await chooseTab(operator.page, 'picture');
  await operator.page.selectOption('#picture-camera', 'iso');
  await viewer.page.waitForFunction(() => document.getElementById('picture-camera').value === 'iso', null, LONG);
  assert.deepEqual([...viewer.problems, ...operator.problems], []);
  await viewer.close();
  await operator.close();
});

test('a control that a viewer enables by force changes nothing and says why', async () => {
  const { page, problems, close } = await openPage(site.viewer_url);
  await roleIs(page, 'viewer');
  await page.evaluate(() => document.querySelectorAll('fieldset').forEach((gate) => { gate.disabled = false; }));
  await page.waitForFunction(() => document.querySelectorAll('#loads li').length === 15, null, LONG);
  await page.fill('#hand-kg', '4');
  await page.click('#hand-load button');
  await page.waitForFunction(() => /a viewer may look/.test(document.getElementById('banner').textContent), null, LONG);
  assert.equal(problems.filter((line) => line.includes('403')).length, 2, problems.join('\n'));
  await close();
});

for (const [name, viewport, colorScheme] of [['desktop', DESKTOP, 'light'], ['phone_dark', PHONE, 'dark']]) {
  test(`a browser without a token gets a page with a field, which leads to the page, on ${name}`, async () => {
    const home = new URL('/?loads=both', site.url);
    const { page, problems, close } = await openPage(home.href, { viewport, colorScheme });
    assert.equal(await page.title(), 'Token needed · Kinescope');
    assert.match(await page.locator('[role=alert]').textContent(), /token missing/);
    await page.waitForFunction(() => document.activeElement.id === 'token', null, LONG);  // typed without a click; at the first frame
    const { body, panel } = await page.evaluate(() => ({
      body: getComputedStyle(document.body).backgroundColor,
      panel: getComputedStyle(document.querySelector('main')).backgroundColor }));
    assert.notEqual(body, panel, 'the style is applied');
    await saveScreenshot(page, `token_${name}`);
    await page.keyboard.type('not-the-right-token');
    await page.keyboard.press('Enter');
    await page.getByText('wrong token').waitFor(LONG);
    await page.getByLabel('Token').fill(VIEWER);
    await page.getByRole('button', { name: 'Open the page' }).click();
    await roleIs(page, 'viewer');
    assert.equal(new URL(page.url()).search, '?loads=both', 'the token is not kept, the rest of the address is');
    assert.deepEqual(problems.filter((line) => !/401/.test(line)), []);
    await close();
  });
}
