// Colours as the server sends them, for three.js.
import * as THREE from 'three';

/** @param {number[]} rgb  sRGB 0..1 */
export const toColor = (rgb) => new THREE.Color().setRGB(rgb[0], rgb[1], rgb[2], THREE.SRGBColorSpace);
