// Where the skin is and how limbs cover the sky over it: what the page computes on the graphics card, and what the
// server computes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { after, test } from 'node:test';
import { closeBrowser, drawSeldom, openPage, startFixture } from './open_page.mjs';

drawSeldom();
after(closeBrowser);

/** In the page: places of all vertices and the open sky over them in each posture, read from where the skin's material
 *  reads them. */
async function surfaceOnPage({ hex, postures }) {
  const here = (file) => import(new URL(file, location.href).href);
  const [THREE, { readSkin }, { framesOf }, { SkinSurface }] = [
    await import('three'), await here('skin_buffer.js'), await here('skin_frames.js'), await here('skin_surface.js')];
  const bytes = Uint8Array.from(hex.match(/../g), (digits) => parseInt(digits, 16));
  const skin = readSkin(bytes.buffer, 'skin');
  const surface = new SkinSurface(skin);
  const renderer = new THREE.WebGLRenderer();
  const gl = renderer.getContext();
  const one = new THREE.Vector3(1, 1, 1);
  const matrix = ({ position, rotation }) => new THREE.Matrix4().compose(position, rotation, one);
  const fromBind = skin.rig.bind.map((frame) => matrix(frame).invert());
  return postures.map(({ links }) => {
    for (let i = 0; i < 3; ++i) {  // the sky is computed for every third posture
      surface.setPosture(framesOf(skin.rig, links).map((frame, k) => matrix(frame).multiply(fromBind[k])), links);
      surface.pose(renderer);
    }
    const read = (target) => {
      const { width, height } = target.image;
      gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
      const { __webglTexture: texture } = renderer.properties.get(target);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
      const bits = new Uint32Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
      renderer.resetState();
      return new Float32Array(bits.buffer);
    };
    const vertices = Array.from({ length: skin.positions.length / 3 }, (_, i) => i);
    const sky = read(surface.uniforms.posedSky.value), places = read(surface.uniforms.posedPositions.value);
    return { open: vertices.map((i) => sky[4 * i]), places: vertices.map((i) => [...places.subarray(4 * i, 4 * i + 3)]) };
  });
}

for (const { name, hexOf, surfaceOf } of [
  { name: 'the skin lies', hexOf: (skin) => skin.hex, surfaceOf: (posture) => posture.surface },
  { name: 'a skin of fewer triangles lies', hexOf: (skin) => skin.coarse_hex, surfaceOf: (posture) => posture.coarse },
]) {
  test(`${name} on the page where it does in pictures of the server, and limbs cover as much of the sky`, async () => {
    const told = JSON.parse(execFileSync(process.env.KINESCOPE_PAGE_FIXTURE, ['describe'],
      { encoding: 'utf8', maxBuffer: 1 << 26 }));
    const site = await startFixture();
    const { page, close } = await openPage(site.url);
    for (const skin of told.skins) {
      const { postures, sky_step: step } = skin;
      const shown = await page.evaluate(surfaceOnPage, { hex: hexOf(skin), postures: postures.map(({ links }) => ({ links })) });
      postures.map(surfaceOf).forEach(({ open, places }, posture) => {
        const away = (i) => Math.hypot(...shown[posture].places[step * i].map((value, k) => value - places[3 * i + k]));
        const off = open.reduce((most, _, i) => Math.max(most, away(i)), 0);
        assert.ok(off < 0.0005, `posture ${posture}: ${off} m beside its place`);
        let farthest = 0, sum = 0, covered = 0;
        open.forEach((expected, i) => {
          const difference = Math.abs(shown[posture].open[step * i] - expected);
          farthest = Math.max(farthest, difference);
          sum += difference;
          covered += expected < 0.9 ? 1 : 0;
        });
        const { length } = open;
        assert.ok(covered > 0.05 * length, `posture ${posture} covers only ${covered} of ${length}`);
        assert.ok(farthest < 0.03 && sum / length < 0.003, `posture ${posture}: ${farthest}, on average ${sum / length}`);
      });
    }
    await close();
    await site.stop();
  });
}
