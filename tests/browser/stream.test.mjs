// The health of the stream on the page: the lamp's state "losing data", and the panel "Stream".
import assert from 'node:assert/strict';
import { after, before, test as nodeTest } from 'node:test';
import { chooseTab, closeBrowser, DESKTOP, drawNothing, openPage, PHONE, saveScreenshot, startFixture } from './open_page.mjs';

drawNothing();

const LONG = { timeout: 60000 };  // only a failure takes so long
const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
let site;
before(async () => { site = await startFixture(); });
after(async () => {
  await site.stop();
  await closeBrowser();
});

const never = { count: 0, count_10s: 0, last_micros: null };
const good = { samples: 45678, lost: 12, incomplete: never, loss_10s: 0, loss: 0.0002627, jitter_ms: 0.8, gaps: never, rejected: [], clocks: [] };
const say = (health) => site.say(`stream ${JSON.stringify(health)}`);
const wordIs = (page, pattern) => page.waitForFunction(
  (text) => new RegExp(text).test(document.getElementById('status-word').textContent), pattern, LONG);
const rowsOf = (page) => page.$$eval('#stream-rows tr', (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));

for (const [name, viewport] of [['desktop', DESKTOP], ['phone', PHONE]]) {
  test(`clocks that differ are named, with the delay of each node, on ${name}`, async () => {
    const clock = { node: '/bridge_a', offset_ms: 0.3, uncertainty_ms: 1.2, delay_ms: 3.4, most_delay_ms: 12.8, lag_ms: 3.1, most_lag_ms: 12.5,
      shift_ms: 0, excess_ms: 0, warning: '' };
    const warning = 'the clock of /bridge_b is 2.98 s behind the server\'s';
    say({ ...good, jitter_ms: null, clocks: [clock, { ...clock, node: '/bridge_b', offset_ms: -2980.1, delay_ms: 51.2, most_delay_ms: 68, warning }] });
    const { page, problems, close } = await openPage(site.url, { viewport });
    await page.waitForFunction(() => document.getElementById('stream-line').textContent === '0.0 % lost · clock of /bridge_b 2.98 s behind', null, LONG);
    await chooseTab(page, 'loads');
    await page.locator('#stream summary').click();
    await page.waitForFunction(() => document.querySelectorAll('#stream-rows tr').length === 10, null, LONG);
    assert.deepEqual((await rowsOf(page)).slice(5, 9).map((row) => row.slice(0, 2)), [
      ['Clock of /bridge_a', 'equal ± 1.2 ms'], ['Delay from /bridge_a', '3.4 ms to 13 ms'],
      ['Clock of /bridge_b', '2.98 s ± 1.2 ms behind'], ['Delay from /bridge_b', '51 ms to 68 ms']]);
    const { scroll, client } = await page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth, client: document.documentElement.clientWidth }));
    assert.ok(scroll <= client, `${scroll} px wide on ${client}`);
    await page.locator('#stream').scrollIntoViewIfNeeded();
    await saveScreenshot(page, `clocks_${name}`);
    say({ ...good, jitter_ms: null, clocks: [{ ...clock, excess_ms: 2400, warning: 'the stamps of /bridge_a advance' }] });
    await page.waitForFunction(() => document.getElementById('stream-line').textContent === '0.0 % lost · clock of /bridge_a 0.3 ms ahead, its stamps slowed down', null, LONG);
    assert.deepEqual(problems, []);
    await close();
  });
}

for (const [name, viewport, colorScheme] of [
  ['desktop', DESKTOP, 'light'], ['desktop_dark', DESKTOP, 'dark'], ['phone', PHONE, 'light'], ['phone_dark', PHONE, 'dark']]) {
  test(`a stream that loses data has a lamp of its own, and the table says what is wrong, on ${name}`, async () => {
    say(good);
    const { page, problems, close } = await openPage(site.url, { viewport, colorScheme });
    await wordIs(page, '^Live$');
    await page.waitForFunction(() => document.getElementById('status-note').textContent === '0.0 % lost or incomplete', null, LONG);
    const before = await page.locator('#status').boundingBox();
    const { pong, server_micros: now } = await page.evaluate(() => new Promise((resolve) => {
      const socket = new WebSocket(new URL('api/v1/ws', location.href.replace('http', 'ws')));
      socket.onopen = () => socket.send('{"ping": 1}');
      socket.onmessage = ({ data }) => {
        if (typeof data !== 'string' || !data.includes('pong')) return;
        resolve(JSON.parse(data));
        socket.close();
      };
    }));
    assert.equal(pong, 1);
    const losing = {
      ...good, lost: 1234, loss_10s: 0.0543, loss: 0.0263, jitter_ms: 12.3, gaps: { count: 812, count_10s: 31, last_micros: now },
      rejected: [{ reason: 'no MXTP id string', count: 3, count_10s: 0, last_micros: now - 72e6 },
        { reason: 'payload size does not fit the message type', count: 1200, count_10s: 12, last_micros: now - 1e6 }],
    };
    say(losing);
    await wordIs(page, '^Losing data 5\\.4 %$');
    assert.equal(await page.locator('#status-note').textContent(), 'lost or incomplete in 10 s');
    assert.equal(await page.title(), 'Losing data 5.4 % · Kinescope');
    const after = await page.locator('#status').boundingBox();
    assert.deepEqual([after.x, after.y, after.width, after.height], [before.x, before.y, before.width, before.height], 'nothing jumps');
    const words = await page.$$eval('#loads .word', (parts) => parts.map((part) => part.textContent));
    assert.ok(words.includes('high'), 'the newest sample is shown as one that is new');
    await chooseTab(page, 'loads');
    await page.locator('#stream summary').focus();
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelectorAll('#stream-rows tr').length === 7, null, LONG);
    const rows = await rowsOf(page);
    assert.deepEqual(rows[0].slice(0, 3), ['Loss', '5.4 %', '2.6 %']);
    assert.equal(rows[5][0], 'Refused: payload size does not fit the message type');
    assert.match(rows[6][3], /^[7-9]\d s ago$/);
    assert.deepEqual(await page.$$eval('#stream-rows .recent th', (all) => all.length), 3, 'lost, gaps and one reason');
    const { scroll, client } = await page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth, client: document.documentElement.clientWidth }));
    assert.ok(scroll <= client, `${scroll} px wide on ${client}`);
    const small = await page.$$eval('#stream *, #status *', (all) => all.filter((part) => part.textContent
      && parseFloat(getComputedStyle(part).fontSize) < 11).map((part) => part.id || part.tagName));
    assert.deepEqual(small, []);
    await saveScreenshot(page, `losing_${name}`);
    if (viewport === PHONE) {
      await page.locator('#stream').scrollIntoViewIfNeeded();
      await saveScreenshot(page, `losing_table_${name}`);
    }
    assert.deepEqual(problems, []);
    await close();
  });
}

test('what is over is over: the lamp is live again, and the table has it as history', async () => {
  const lost = { ...good, lost: 90, loss_10s: 0.05, loss: 0.002, gaps: { count: 9, count_10s: 9, last_micros: 1e6 },
    rejected: [{ reason: 'empty datagram', count: 4, count_10s: 4, last_micros: 1e6 }] };
  say(lost);
  const { page, close } = await openPage(site.url);
  await wordIs(page, '^Losing data 5\\.0 %$');
  say({ ...lost, loss_10s: 0, gaps: { ...lost.gaps, count_10s: 0 }, rejected: [{ ...lost.rejected[0], count_10s: 0 }] });
  await wordIs(page, '^Live$');
  await page.click('#stream summary');
  await page.waitForFunction(() => document.querySelectorAll('#stream-rows tr').length === 6, null, LONG);
  assert.equal(await page.locator('#stream-rows .recent').count(), 0);
  assert.equal((await rowsOf(page))[5][2], '4');
  assert.ok(await page.locator('#diagnostics').isHidden(), 'a datagram refused once is no problem of now');
  say({ ...good, clock_steps: { count: 1, count_10s: 1, last_micros: 1e6 } });
  await page.waitForFunction(() => /^The clock of the server was set: /.test(document.getElementById('banner').textContent), null, LONG);
  await wordIs(page, '^Live$');
  await saveScreenshot(page, 'clock_set');
  say({ ...good, clock_steps: { count: 1, count_10s: 0, last_micros: 1e6 } });
  await page.waitForFunction(() => document.getElementById('banner').hidden
    && document.querySelectorAll('#stream-rows tr')[5].cells[0].textContent === 'Clock of the server set', null, LONG);
  await close();
});
