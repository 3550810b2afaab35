import assert from 'node:assert/strict';
import test from 'node:test';

/** @type {any} */ (globalThis).location ??= new URL('http://lab/');
/** @type {any} */ (globalThis).history ??= { replaceState() {} };
const { Shown } = await import('../../../web/shown.js');

const RATE_HZ = 100, PERIOD_MICROS = 1e6 / RATE_HZ;

/** The `n`th state of a server, which was 30 ms late from the 40th to the 60th.
 *  @param {number} n */
const stateOf = (n) => /** @type {any} */ ({
  state: n, liveness: 'live', stateNumber: n, counter: n, rateHz: RATE_HZ, stampMicros: 1e12 + n * PERIOD_MICROS,
  madeMicros: 5e9 + n * PERIOD_MICROS + (n >= 40 && n <= 60 ? 30_000 : 0), oldestMicros: 5e9,
});

function setUp() {
  const sent = /** @type {any[]} */ ([]);
  const page = { send: (/** @type {any} */ command) => sent.push(command), notice() {}, changed() {}, arrived() {} };
  const shown = new Shown(page, { micros: null, place: null });
  shown.setNewest(stateOf(100));
  const details = JSON.stringify({ details: shown.newestDetails });
  const answer = (/** @type {number} */ n) => {
    const { id } = sent.filter(({ look }) => look).at(-1).look, state = stateOf(n);
    const former = { state, stateNumber: n, madeMicros: state.madeMicros, details };
    shown.onPast(/** @type {any} */ ({ id, untilMicros: state.madeMicros, formers: [former] }));
  };
  return { sent, shown, answer };
}

test('a sample that is meant is found beside its moment, where the server was late', () => {
  const { sent, shown, answer } = setUp();
  const wanted = stateOf(50);
  shown.pauseAt((wanted.madeMicros - 30_000) / 1000, wanted.stampMicros);
  shown.ask(performance.now());
  assert.equal(sent.at(-1).look.micros, wanted.madeMicros - 30_000);
  answer(47);
  assert.equal(sent.at(-1).look.number, 50);
  answer(50);
  assert.equal(shown.state?.counter, 50);
  assert.equal(shown.millis, wanted.madeMicros / 1000, 'and a step leads to the next one');
  const count = sent.length;
  shown.ask(performance.now());
  assert.equal(sent.length, count);
});

test('a sample that is not there is not sought for ever, and not after the viewer has gone elsewhere', () => {
  const { sent, shown, answer } = setUp();
  shown.pauseAt(stateOf(20).madeMicros / 1000, stateOf(20).stampMicros - 5000);  // between two samples
  shown.ask(performance.now());
  for (let n = 0; n < 8; ++n) {
    answer(n % 2 === 0 ? 20 : 19);
    assert.equal(sent.at(-1).look.number, n % 2 === 0 ? 19 : 20);
  }
  answer(20);
  assert.equal(shown.state?.counter, 20);
  const count = sent.length;
  shown.pauseAt(stateOf(30).madeMicros / 1000, stateOf(32).stampMicros);
  shown.seek(stateOf(10).madeMicros / 1000);
  shown.time.pause(performance.now(), /** @type {any} */ (shown.kept()), stateOf(10).madeMicros / 1000);
  shown.ask(performance.now());
  answer(10);
  assert.equal(sent.length, count + 1);
  assert.equal(shown.state?.counter, 10);
});
