// Prints what a Kinescope server shows, once a second: a program of your own that uses web/client.js. Needs Node 22.
//   node docs/watch.mjs 'http://127.0.0.1:8080/?token=...' [SECONDS]
import { KinescopeClient } from '../web/client.js';

const [url, seconds = 'Infinity'] = process.argv.slice(2);
let joints = [];
let printedAt = -Infinity;

const client = new KinescopeClient({
  async onOpen() {
    const model = await (await client.ask('api/v1/model')).json();
    joints = model.joints.map(({ label }) => label);
  },
  onState({ liveness, stateNumber, people }) {
    if (joints.length === 0 || performance.now() - printedAt < 1000) return;
    printedAt = performance.now();
    console.log(`${liveness}, state ${stateNumber}`);
    for (const { character, loads } of people) {
      const [worst] = loads.filter(({ ratio }) => ratio >= 0).sort((a, b) => b.ratio - a.ratio);  // unknown: NaN
      if (worst) console.log(`  person ${character}: ${joints[worst.joint]} ${worst.loadClass}, ${(100 * worst.ratio).toFixed(0)} %`);
    }
  },
  onError: (reason) => console.error(reason),
  onClose: (reason) => console.error(reason || `no server at ${url}`),
}, { url });
if (Number.isFinite(Number(seconds))) setTimeout(() => client.close(), 1000 * Number(seconds));
