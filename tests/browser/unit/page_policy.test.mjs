// What must hold of the page's files as they lie there.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import test from 'node:test';
import { ELEMENTS } from '../../../web/elements.js';
import { SILENCE_MILLIS } from '../../../web/status.js';

const root = new URL('../../../', import.meta.url);
const read = (name) => readFileSync(new URL(name, root), 'utf8');
const modules = readdirSync(new URL('web/', root)).filter((name) => name.endsWith('.js'));
const sheets = readdirSync(new URL('web/', root)).filter((name) => name.endsWith('.css'));
const html = read('web/index.html');

test('the content security policy contains the current hash of the import map', () => {
  const [, map] = html.match(/<script type="importmap">([^]*?)<\/script>/);
  const hash = createHash('sha256').update(map).digest('base64');
  assert.ok(read('server/http/response_head.cc').includes(`'sha256-${hash}'`),
    `server/http/response_head.cc needs 'sha256-${hash}'`);
});

test('the server provides every library that the modules import', () => {
  const given = read('server/http/static_files.cc');
  const { imports } = JSON.parse(html.match(/<script type="importmap">([^]*?)<\/script>/)[1]);
  for (const name of modules) {
    for (const [, specifier] of read(`web/${name}`).matchAll(/from '([^'.][^']*)'/g)) {
      const prefix = Object.keys(imports).filter((key) => specifier.startsWith(key)).sort((a, b) => b.length - a.length)[0];
      const url = (imports[prefix] + specifier.slice(prefix.length)).replace(/^\./, '');
      assert.ok(given.includes(`"${url}"`), `${name} imports ${specifier}, which is ${url}`);
    }
  }
});

test('the installation contains every library file that the server provides', () => {
  const installed = read('web/CMakeLists.txt');
  for (const [, path] of read('server/http/static_files.cc').matchAll(/"(?:three|uplot)\/([^"]+)"/g)) {
    assert.ok(installed.includes(path), `web/CMakeLists.txt does not install ${path}`);
  }
});

test('the page loads nothing from other sites', () => {
  for (const name of [...modules, 'index.html', ...sheets]) {
    assert.doesNotMatch(read(`web/${name}`), /(https?|wss?):\/\/|@import|[ :]url\(/, name);
  }
});

test('no external text can become markup', () => {
  for (const name of modules) {
    assert.doesNotMatch(read(`web/${name}`), /innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(/, name);
  }
});

test('every element that the code needs exists with the expected tag', () => {
  const tags = new Map([...html.matchAll(/<(\w+)[^>]*? id="([^"]+)"/g)].map(([, tag, id]) => [id, tag]));
  for (const [id, tag] of Object.entries(ELEMENTS)) assert.equal(tags.get(id), tag, `#${id} of index.html`);
  for (const [, id] of read('web/boot.js').matchAll(/getElementById\('([^']+)'/g)) {
    assert.ok(tags.has(id), `index.html has no #${id}`);
  }
});

test('the page waits for several heartbeats before it calls the server disconnected', () => {
  const millisOf = (name) => {
    const [, millis] = read('server/http/hub.h').match(new RegExp(`milliseconds ${name}\\{(\\d+)\\}`));
    return Number(millis);
  };
  const longest = millisOf('kHeartbeat') + millisOf('kTickInterval');  // a tick looks whether a heartbeat is due
  assert.ok(SILENCE_MILLIS >= 3 * longest, `${SILENCE_MILLIS} ms, and a message comes every ${longest} ms`);
});

test('no line of the page is longer than 140 characters', () => {
  const long = [...modules, 'index.html', ...sheets].flatMap((name) => read(`web/${name}`).split('\n')
    .flatMap((line, i) => (line.length > 140 ? [`${name}:${i + 1}`] : [])));
  assert.deepEqual(long, []);
});

test('lock files name versions and hashes, no host', () => {
  for (const folder of ['web', 'tests/browser']) {
    const lock = read(`${folder}/package-lock.json`);
    assert.doesNotMatch(lock, /"resolved"|https?:/, folder);
    for (const [name, entry] of Object.entries(JSON.parse(lock).packages)) {
      if (name !== '') assert.match(entry.integrity, /^sha512-/, name);
    }
  }
});
