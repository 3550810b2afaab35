// The pinhole camera of an image that was calibrated. Pure functions.

const PIXEL_MIDDLE = 0.5;  // px, from its edge

/** Where the edges of the image are in a plane before the camera, as in OpenGL's frustum: x to the right, y up.
 *  @param {import('./messages.js').ImageCamera} camera
 *  @param {number} distance  of the plane
 *  @returns {{left: number, right: number, top: number, bottom: number}}  in the unit of the distance */
export function edgesAt({ width, height, focal_px: focal, center_px: center }, distance) {
  const [x, y] = center.map((px) => px + PIXEL_MIDDLE);
  return {
    left: -x / focal[0] * distance, right: (width - x) / focal[0] * distance,
    top: y / focal[1] * distance, bottom: (y - height) / focal[1] * distance,
  };
}
