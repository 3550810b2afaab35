// A lab for the tests: `kinescope serve` as operators start it, and suits that stream to it.
//   const lab = await startLab({ folder });
//   const suit = lab.stream(['demo:lift']);
//   ... lab.operator and lab.viewer are addresses of the page ...
//   await suit.stop(); await lab.stop();
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';
import { endWithTests } from './open_page.mjs';

const OPERATOR = '0perator-of-the-lab', VIEWER = 'v1ewer-of-the-lab';

/** @param {import('node:child_process').ChildProcess} child */
async function stop(child) {
  child.kill('SIGINT');
  if (child.exitCode === null && child.signalCode === null) await once(child, 'exit');
}

/** @param {{source?: string, folder: string, marks?: string, options?: string[], shell?: (command: string) => string}} settings
 *    marks: a file in the folder; shell: of a command line that runs the given one */
export async function startLab({ source = 'udp://127.0.0.1:0', folder, marks = 'marks.jsonl', options = [], shell }) {
  const command = [process.env.KINESCOPE, 'serve', source, '--ros', 'off', '--http_port', '0', '--token', OPERATOR,
    '--viewer_token', VIEWER, '--marks_file', `${folder}/${marks}`, '--picture_size', '320x180', ...options];
  const quoted = command.map((word) => `'${word}'`).join(' ');
  const child = shell ? spawn('sh', ['-c', shell(`exec ${quoted}`)], { stdio: ['ignore', 'ignore', 'pipe'] })
    : spawn(command[0], command.slice(1), { stdio: ['ignore', 'ignore', 'pipe'] });
  endWithTests(child);
  let page = '', suitAddress = '';
  const log = [];
  for await (const line of createInterface({ input: child.stderr })) {
    log.push(line);
    suitAddress = /listening at (udp:\/\/[\d.]+:\d+)/.exec(line)?.[1] ?? suitAddress;
    page = /page at (http:\/\/[\d.:]+\/)/.exec(line)?.[1] ?? page;
    if (page !== '') break;
  }
  if (page === '') throw new Error(`the server did not start: ${log.join('\n')}`);
  child.stderr.resume();
  return {
    page, operator: `${page}?token=${OPERATOR}`, viewer: `${page}?token=${VIEWER}`, token: OPERATOR,
    /** @param {string[]} args  of `kinescope stream` */
    stream(args) {
      const suit = spawn(process.env.KINESCOPE, ['stream', ...args, '--to', suitAddress], { stdio: 'ignore' });
      endWithTests(suit);
      return { stop: () => stop(suit) };
    },
    stop: () => stop(child),
    /** Without any goodbye, as a crash would. */
    async kill() {
      child.kill('SIGKILL');
      if (child.exitCode === null && child.signalCode === null) await once(child, 'exit');
    },
  };
}
