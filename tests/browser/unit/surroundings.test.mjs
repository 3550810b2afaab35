// How points of external markers are drawn, with the real three.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { squares } from '../../../web/surroundings.js';

const materialOf = (extras) => squares({ material: { transparent: false }, userData: extras });

/** The size in the vertex shader, whose distance three.js adds where `sizeAttenuation` is on. */
function shaderSize(material) {
  const shader = { vertexShader: 'gl_PointSize = size;' };
  material.onBeforeCompile(shader);
  return shader.vertexShader;
}

test('points in pixels have their size at any distance and with any lens', () => {
  const material = materialOf({ size: [3, 3], in_pixels: true });
  assert.equal(material.size, 3);
  assert.equal(material.sizeAttenuation, false);
  assert.equal(shaderSize(material), 'gl_PointSize = size;');
});

test('points in metres are smaller far away', () => {
  const material = materialOf({ size: [0.01, 0.01], in_pixels: false });
  assert.equal(material.size, 0.01);
  assert.equal(material.sizeAttenuation, true);
  assert.match(shaderSize(material), /projectionMatrix/);
});

test('points without a unit are rejected', () => {
  assert.throws(() => materialOf({ size: [3, 3] }), /nothing as extras\.in_pixels; expected true or false/);
});
