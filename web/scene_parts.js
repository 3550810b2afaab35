// The parts of the scene, with the names that they have in `kinescope render --hide`: `?hide=shadows,loads`.

export const SCENE_PARTS = /** @type {const} */ (
  ['body', 'loads', 'com', 'cop', 'support', 'forces', 'hand_loads', 'shadows', 'objects', 'robots', 'markers']);
/** @typedef {(typeof SCENE_PARTS)[number]} ScenePart */

/** @param {string|null} text  names, separated by commas; others are ignored
 *  @returns {ScenePart[]} */
export const partsIn = (text) => SCENE_PARTS.filter((part) => (text ?? '').split(',').includes(part));
