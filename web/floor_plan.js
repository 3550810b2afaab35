// CoM and CoP from above, with the support polygon: their ways over the time that the plots show, up to the moment on
// the screen. The direction in which the cameras look at the person's front is down.

const MARGIN = 1.25, LEAST_METRES = 0.5, GRID_METRES = 0.1;

/** @typedef {{x: number, y: number}} Point  world, m
 *  @typedef {{com: (Point|null)[], cop: (Point|null)[]}} Ways  oldest first; null: unknown
 *  @typedef {{com: number[]|null, cop: number[]|null, support: number[][]}} Now  world, m */

/** The square that has all points and the polygon in it.
 *  @param {Point[]} points
 *  @returns {{x: number, y: number, side: number}}  its middle and side, m */
export function frameOf(points) {
  if (points.length === 0) return { x: 0, y: 0, side: LEAST_METRES };
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  return { x: (left + right) / 2, y: (low + high) / 2, side: Math.max(LEAST_METRES, MARGIN * Math.max(right - left, high - low)) };
}

/** @param {number[]} point
 *  @returns {Point} */
const pointOf = ([x, y]) => ({ x, y });

export class FloorPlan {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
  }

  /** @param {Ways} ways
   *  @param {Now} now
   *  @param {number} heading  rad, by which the named views are turned about z */
  draw(ways, now, heading) {
    const { canvas } = this, width = canvas.clientWidth, height = canvas.clientHeight, dpr = devicePixelRatio || 1;
    const context = canvas.getContext('2d');
    if (width === 0 || height === 0 || context === null) return;
    if (canvas.width !== Math.round(width * dpr) || canvas.height !== Math.round(height * dpr)) {
      canvas.width = Math.round(width * dpr);
      canvas.height = Math.round(height * dpr);
    }
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.clearRect(0, 0, width, height);
    const style = getComputedStyle(canvas), color = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`);
    // Forward is up, left is left.
    const turned = (/** @type {Point} */ { x, y }) => ({
      x: Math.sin(heading) * x - Math.cos(heading) * y, y: Math.cos(heading) * x + Math.sin(heading) * y,
    });
    const corners = now.support.map((corner) => turned(pointOf(corner)));
    const [com, cop] = [ways.com, ways.cop].map((way) => way.map((point) => point && turned(point)));
    const frame = frameOf([...corners, ...[...com, ...cop].flatMap((point) => point ?? [])]);
    const scale = Math.min(width, height) / frame.side;
    const place = (/** @type {Point} */ { x, y }) =>
      /** @type {[number, number]} */ ([width / 2 + (x - frame.x) * scale, height / 2 - (y - frame.y) * scale]);
    this.#grid(context, color('line'), frame, scale);
    if (corners.length > 2) {
      context.beginPath();
      for (const corner of corners) context.lineTo(...place(corner));
      context.closePath();
      context.strokeStyle = context.fillStyle = color('support');
      context.globalAlpha = 0.12;
      context.fill();
      context.globalAlpha = 1;
      context.lineWidth = 1.5;
      context.stroke();
    }
    this.#way(context, color('cop'), cop, place, 1.25);
    this.#way(context, color('com'), com, place, 2);
    if (now.cop) {
      const [x, y] = place(turned(pointOf(now.cop)));
      this.#dot(context, color, 'cop', () => context.rect(x - 4, y - 4, 8, 8));
    }
    if (now.com) {
      const [x, y] = place(turned(pointOf(now.com)));
      this.#dot(context, color, 'com', () => context.arc(x, y, 5, 0, 7));
    }
  }

  /** @param {CanvasRenderingContext2D} context
   *  @param {string} color
   *  @param {{x: number, y: number, side: number}} frame
   *  @param {number} scale */
  #grid(context, color, frame, scale) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const step = GRID_METRES * Math.max(1, 10 ** Math.ceil(Math.log10(frame.side / 2)));
    context.strokeStyle = color;
    context.lineWidth = 1;
    context.beginPath();
    for (let n = Math.ceil((frame.x - width / 2 / scale) / step); n * step < frame.x + width / 2 / scale; ++n) {
      const x = Math.round(width / 2 + (n * step - frame.x) * scale) + 0.5;
      context.moveTo(x, 0);
      context.lineTo(x, height);
    }
    for (let n = Math.ceil((frame.y - height / 2 / scale) / step); n * step < frame.y + height / 2 / scale; ++n) {
      const y = Math.round(height / 2 - (n * step - frame.y) * scale) + 0.5;
      context.moveTo(0, y);
      context.lineTo(width, y);
    }
    context.stroke();
  }

  /** @param {CanvasRenderingContext2D} context
   *  @param {string} color
   *  @param {(Point|null)[]} way
   *  @param {(point: Point) => [number, number]} place
   *  @param {number} width */
  #way(context, color, way, place, width) {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.lineJoin = 'round';
    context.globalAlpha = 0.75;
    context.beginPath();
    let isDown = false;
    for (const point of way) {
      if (point !== null) context[isDown ? 'lineTo' : 'moveTo'](...place(point));
      isDown = point !== null;
    }
    context.stroke();
    context.globalAlpha = 1;
  }

  /** @param {CanvasRenderingContext2D} context
   *  @param {(name: string) => string} color
   *  @param {string} name
   *  @param {() => void} shape */
  #dot(context, color, name, shape) {
    context.beginPath();
    shape();
    context.fillStyle = color(name);
    context.fill();
    context.strokeStyle = color('panel');
    context.lineWidth = 1.5;
    context.stroke();
  }
}
