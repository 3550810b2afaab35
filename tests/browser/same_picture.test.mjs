// The page shows what the pictures of the server show: all objects, pixel by pixel.
import assert from 'node:assert/strict';
import { test as nodeTest } from 'node:test';
import { saveScreenshot } from './open_page.mjs';
import { cameraOf, mask, MARKS, overlap, PLAIN, record, serve, serverPixels, whatCovers } from './same_pixels.mjs';

const test = (name, body) => nodeTest(name, { timeout: 120000 }, body);
const EVERYTHING = { route: '**/api/v1/model', address: 'api/v1/skin' };

for (const { motion, seconds, camera, person } of [
  { motion: 'lift', seconds: 1, camera: 'three_quarter', person: ['--hand_load', 'both:10'] },
  { motion: 'n_pose', seconds: 1, camera: 'left', person: [] },
]) {
  test(`body, loads, forces and points of ${motion} cover the same pixels on the page and in the server's picture`, async () => {
    const file = await record(motion, seconds, []);
    const site = await serve(file, ['--loop', ...person, '--pictures', 'off']);
    const { page, covered, size, close } = await whatCovers(site, camera, EVERYTHING, { 'status-word': 'Recording' });
    await saveScreenshot(page, `same_${motion}`);
    const sameCamera = await cameraOf(page, camera, size);
    const [all, nothing] = [
      await serverPixels(page, file, sameCamera, size, [...PLAIN, 'shadows', ...person]),
      await serverPixels(page, file, sameCamera, size, [...PLAIN, `body,shadows,${MARKS}`, ...person]),
    ];
    const { share, either } = overlap(covered, mask(all, nothing), new Uint8Array(covered.length));
    assert.ok(either > 0.02 * covered.length, `${either} pixels`);
    assert.ok(share >= 0.95, `${share.toFixed(4)} of the pixels are covered by both`);
    await close();
    await site.stop();
  });
}
