// The keys of the 3-D view while it has the focus: turn, move, zoom.

const TURN = Math.PI / 24, SHIFT = 0.05, ZOOM = 1.15;
const GROUP = '3-D view, when it has the focus';

/** @param {import('./scene.js').Scene} scene
 *  @param {import('./keys.js').Keys} keys */
export function mountViewKeys(scene, keys) {
  /** @type {Record<string, () => void>} */
  const acts = {
    'ArrowLeft': () => scene.turn(-TURN, 0), 'ArrowRight': () => scene.turn(TURN, 0),
    'ArrowUp': () => scene.turn(0, TURN), 'ArrowDown': () => scene.turn(0, -TURN),
    'Shift+ArrowLeft': () => scene.shift(-SHIFT, 0), 'Shift+ArrowRight': () => scene.shift(SHIFT, 0),
    'Shift+ArrowUp': () => scene.shift(0, SHIFT), 'Shift+ArrowDown': () => scene.shift(0, -SHIFT),
    '+': () => scene.zoom(1 / ZOOM), '=': () => scene.zoom(1 / ZOOM), '-': () => scene.zoom(ZOOM),
  };
  const names = Object.keys(acts);
  keys.add(GROUP, names.slice(0, 4), 'Turn', null);
  keys.add(GROUP, names.slice(4, 8), 'Move', null);
  keys.add(GROUP, ['+', '-'], 'Nearer, farther', null);
  scene.canvas.addEventListener('keydown', (event) => {
    const act = event.ctrlKey || event.altKey || event.metaKey ? undefined
      : acts[`${event.shiftKey && event.key.startsWith('Arrow') ? 'Shift+' : ''}${event.key}`];
    if (act === undefined) return;
    event.preventDefault();
    event.stopPropagation();  // the arrows also move the viewer's time
    act();
  });
}
