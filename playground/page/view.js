// @ts-check
/** The part of the plane that a picture shows, and the pixel of each point. */

/** @typedef {{x: number, y: number}} Spot */
/** @typedef {{left: number, top: number, width: number, height: number}} Box In metres; `top` is the largest y. */

const MARGIN_M = 0.3;
const SMALLEST_M = 1.2;

/** @param {import("./state.js").State} state @returns {Box} A box around everything in the room. */
export function boxOf(state) {
  const { robot, radius } = state;
  const points = [
    ...state.walls.flat(),
    ...state.poles.map(([x, y]) => [x, y]),
    [robot.x - radius, robot.y - radius],
    [robot.x + radius, robot.y + radius],
  ];
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const span = (/** @type {number[]} */ all) => {
    const [low, high] = [Math.min(...all), Math.max(...all)];
    const spare = Math.max(0, SMALLEST_M - (high - low)) / 2 + MARGIN_M;
    return [low - spare, high + spare];
  };
  const [left, right] = span(xs);
  const [bottom, top] = span(ys);
  return { left, top, width: right - left, height: top - bottom };
}

/** A box fitted into a picture of this many pixels, in its middle. */
export class View {
  /** @param {Box} box @param {number} width @param {number} height */
  constructor(box, width, height) {
    this.scale = Math.min(width / box.width, height / box.height);
    this.left = box.left - (width / this.scale - box.width) / 2;
    this.top = box.top + (height / this.scale - box.height) / 2;
    this.width = width;
    this.height = height;
  }

  /** @param {number} x @param {number} y @returns {Spot} In pixels. */
  px(x, y) {
    return { x: (x - this.left) * this.scale, y: (this.top - y) * this.scale };
  }

  /** @param {Spot} spot In pixels. @returns {Spot} In metres. */
  metres(spot) {
    return { x: this.left + spot.x / this.scale, y: this.top - spot.y / this.scale };
  }
}

/** @returns {number} Pixels of the page for each unit of a picture, so that pictures grow with the text. */
export function unit() {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
}

/**
 * A canvas as large as it is on the screen, at the screen's resolution.
 * @param {HTMLCanvasElement} canvas
 * @returns {{context: CanvasRenderingContext2D, width: number, height: number}} Empty, with its size in units.
 */
export function contextOf(canvas) {
  const density = window.devicePixelRatio || 1;
  const [across, down] = [Math.round(canvas.clientWidth * density), Math.round(canvas.clientHeight * density)];
  if (canvas.width !== across || canvas.height !== down) {
    canvas.width = across;
    canvas.height = down;
  }
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const scale = density * unit();
  context.setTransform(scale, 0, 0, scale, 0, 0);
  const [width, height] = [canvas.clientWidth / unit(), canvas.clientHeight / unit()];
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}
