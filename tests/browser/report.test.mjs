// The report of `kinescope loads`, opened and printed as a person would: for every kind of input it
// is exactly one A4 page per person, in Chromium and as PDF, with no text below 7 pt.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { copyFile, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { closeBrowser, openPage, saveScreenshot } from './open_page.mjs';

const LEAST_PT = 7;
const MOST_MM = 282;  // of 284, so that other fonts of the same widths fit, too
const run = promisify(execFile);

let folder = '';
before(async () => { folder = await mkdtemp(join(tmpdir(), 'kinescope-report-')); });
after(async () => {
  await closeBrowser();
  await rm(folder, { recursive: true, force: true });
});

/** The report of `args` in each of the formats; the paths. */
async function report(name, args, formats = ['html', 'pdf']) {
  const html = join(folder, `${name}.html`);
  const pdf = join(folder, `${name}.pdf`);
  for (const file of [html, pdf].filter((each) => formats.some((format) => each.endsWith(format)))) {
    // Exit code 1: not one load is known, which is a report, too.
    await run(process.env.KINESCOPE, ['loads', ...args, '--report', file]).catch((error) => {
      if (error.code !== 1) throw error;
    });
  }
  return { html, pdf };
}

async function pdfFacts(file) {
  const { stdout } = await run('pdfinfo', [file]);
  return {
    pages: Number(stdout.match(/^Pages: +(\d+)/m)[1]),
    isA4: /^Page size: .*\(A4\)/m.test(stdout),
  };
}

/** Every text of the page with its size in print, pt; texts beside their page and tables that are
 *  wider than their place; the heights of the pages, mm. */
function measure() {
  const sizes = [];
  const outside = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const text = walker.currentNode.textContent.trim();
    const element = walker.currentNode.parentElement;
    if (text === '') continue;
    const px = parseFloat(getComputedStyle(element).fontSize);
    const scale = element instanceof SVGElement ? element.getScreenCTM().a : 1;
    sizes.push({ pt: px * scale * 0.75, text });
    const range = document.createRange();
    range.selectNodeContents(walker.currentNode);
    const box = range.getBoundingClientRect();
    const page = element.closest('main').getBoundingClientRect();
    if (box.left < page.left - 1 || box.right > page.right + 1) outside.push(text);
  }
  const tables = [...document.querySelectorAll('table')].filter((table) => {
    const cell = table.parentElement.getBoundingClientRect();
    return table.getBoundingClientRect().right > cell.right + 1;
  }).map((table) => table.className);
  const heights = [...document.querySelectorAll('main')]
    .map((main) => main.getBoundingClientRect().height / 96 * 25.4);
  return { sizes, outside, tables, heights };
}

/** Checks the report of one person; its HTML and the path of its PDF. */
async function checkReport(name, args, formats = ['html', 'pdf']) {
  const { html, pdf } = await report(name, args, formats);
  const visit = await openPage(`file://${html}`);
  const { page, problems, requests } = visit;
  await saveScreenshot(page, `report_${name}`);
  const printed = join(folder, `${name}.printed.pdf`);
  await page.pdf({ path: printed, preferCSSPageSize: true, printBackground: true });
  await page.emulateMedia({ media: 'print' });
  await page.setViewportSize({ width: Math.round(186 / 25.4 * 96), height: 1000 });
  const { sizes, outside, tables, heights } = await page.evaluate(measure);
  const [height] = heights;
  assert.deepEqual(await pdfFacts(printed), { pages: 1, isA4: true }, `${name}, printed: ${height} mm`);
  assert.ok(height <= MOST_MM, `${name}: ${height} mm`);
  if (formats.includes('pdf')) {
    assert.deepEqual(await pdfFacts(pdf), { pages: 1, isA4: true }, `${name}, PDF`);
  }
  assert.ok(sizes.length > 300, `${sizes.length} texts`);
  assert.deepEqual(sizes.filter(({ pt }) => pt < LEAST_PT - 0.01), [], `${name}: too small`);
  assert.deepEqual(outside, [], `${name}: beside the page`);
  assert.deepEqual(tables, [], `${name}: wider than their place`);
  assert.deepEqual(requests.filter((url) => !url.startsWith('data:') && url !== `file://${html}`), []);
  assert.deepEqual(problems, []);
  await visit.close();
  return { html: await readFile(html, 'utf8'), pdf };
}

test('the report of a lift is one A4 page with searchable text of at least 7 pt, the same each time', async () => {
  const args = ['demo:lift', '--hand_load', 'both:10', '--mass', '75', '--sex', 'male'];
  const { html, pdf } = await checkReport('lift', args);
  const { stdout } = await run('pdftotext', ['-layout', pdf, '-']);
  for (const text of ['Checked by', 'Peak compression at L5/S1', 'Right shoulder', '6400 N',
    'R knee', 'assumed', 'What would change the answer', 'page 1 of 1']) {
    assert.ok(stdout.includes(text), `${text} is not in the text of the PDF`);
  }
  const again = await report('lift_again', args);
  assert.equal(await readFile(again.html, 'utf8'), html);
  assert.ok((await readFile(again.pdf)).equals(await readFile(pdf)), 'the PDF differs');
  // By the boxes of its words: a line of Liberation Sans is 1.117 times its size.
  const boxes = (await run('pdftotext', ['-bbox', pdf, '-'])).stdout;
  const words = [...boxes.matchAll(/yMin="([\d.]+)" xMax="[\d.]+" yMax="([\d.]+)">([^<]*)</g)];
  assert.ok(words.length > 300, `${words.length} words`);
  const small = words.filter(([, top, bottom]) => Number(bottom) - Number(top) < LEAST_PT * 1.1);
  assert.deepEqual(small.map(([, , , word]) => word), []);
});

test('long names, lists and options stay on the page', async () => {
  const masses = ['head', 't8', 'right_upper_arm', 'left_upper_arm', 'right_forearm', 'left_forearm',
    'right_hand', 'left_hand', 'right_foot', 'left_foot'].map((segment) => `${segment}:1.25`);
  await checkReport('options', ['demo:lift', '--extra_mass', masses.join(','), '--hand_load',
    'right:5,left:2.5,both:10', '--class_limits', '0.1,0.25', '--floor_z', '0.01',
    '--capacity_factor', '0.5', '--body_table', 'dumas', '--filter_hz', '5', '--sex', 'female',
    '--mass', '61.25', '--height', '1.67', '--load_metric', 'overload']);
});

test('a single sample, static loads and unknown loads are a page', async () => {
  await checkReport('one_sample', ['demo:walk', '--seconds', '0.001']);
  await checkReport('static', ['demo:overhead', '--seconds', '3', '--load_mode', 'static',
    '--lumbar_compression', 'off', '--hand_load', 'none'], ['html']);
  await checkReport('external', ['demo:lift', '--seconds', '2', '--load_metric', 'external'], ['html']);
});

test('a trial with many samples and rises is a page', async () => {
  await checkReport('long', ['demo:walk', '--seconds', '300', '--hand_load', 'both:15'], ['html']);
});

// As of a recording of three people: each <main> is a page.
test('every person has a page', async () => {
  const { html } = await report('people', ['demo:walk', '--seconds', '1'], ['html']);
  const text = await readFile(html, 'utf8');
  const [main] = text.match(/<main>[^]*<\/main>/);
  const three = join(folder, 'three.html');
  await writeFile(three, text.replace(main, () => main + main + main));
  const printed = join(folder, 'three.printed.pdf');
  const { page, close } = await openPage(`file://${three}`);
  await page.pdf({ path: printed, preferCSSPageSize: true, printBackground: true });
  await close();
  assert.equal((await pdfFacts(printed)).pages, 3);
  const converted = join(folder, 'three.pdf');
  // Preloaded as by the program: see server/app/loads/report_pdf.cc.
  const env = { ...process.env, LD_PRELOAD: 'libpangoft2-1.0.so.0' };
  await run('weasyprint', ['--quiet', three, converted], { env });
  assert.equal((await pdfFacts(converted)).pages, 3);
});

test('a recording of the upper body with a long file name is a page', async (t) => {
  const shared = process.env.KINESCOPE_SHARED_DATA ?? process.env.KINESCOPE_SHARED_DATA_DEFAULT;
  const source = shared && join(shared, 'mvnx', 'test_mocap.mvnx');
  const text = source && await readFile(source, 'utf8').catch(() => '');
  if (!text) return t.skip(`${source} does not exist`);
  const long = join(folder, `${'Wm_'.repeat(18)}60.mvnx`);
  await writeFile(long, text.replace(/<subject label="[^"]*"/, `<subject label="${'Mm Ww '.repeat(20)}"`));
  await checkReport('upper_body', [long]);
  const short = join(folder, 'four samples.mvnx');
  await copyFile(join(shared, 'mvnx', 'Meri-020.mvnx'), short);
  await checkReport('four_samples', [short], ['html']);
});
