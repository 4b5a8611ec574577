// @ts-check
/** Sound on its way at one moment, and the beliefs of the sensors at that moment. */
import { sensorColour } from "./colours.js";
import { drawMark, markOf } from "./marks.js";

/** @typedef {import("./run.js").Reading} Reading */

/** Radius up to which the puff of a firing sensor is seen. */
const PUFF_M = 0.45;
const HALF_BEAM_RAD = (18 * Math.PI) / 180;
/** The length of the moving stroke that stands for sound. */
const STROKE_M = 0.16;
/** Time for which a rejected reading is seen, in seconds. */
const REJECTED_FOR_S = 0.04;
/** Least distance of a mark from the edge of the picture. */
const EDGE_PX = 10;

/**
 * @param {CanvasRenderingContext2D} context
 * @param {import("./view.js").View} view
 * @param {{traced: import("./draw-scene.js").Traced, readings: Reading[], at: number}} moment Readings in order of firing.
 * @param {import("./colours.js").Colours} colours
 */
export function drawSound(context, view, { traced, readings, at }, colours) {
  context.lineCap = "round";
  for (const reading of readings) {
    if (reading.fired > at) break;
    const sensor = traced.sensors[reading.sensor];
    if (!sensor) continue;
    const [x, y, heading] = sensor;
    const out = (at - reading.fired) * traced.sound_m_s;
    if (out < PUFF_M) {
      const spot = view.px(x, y);
      context.globalAlpha = 1 - out / PUFF_M;
      context.strokeStyle = sensorColour(colours, reading.sensor);
      context.lineWidth = 3;
      context.beginPath();
      context.arc(spot.x, spot.y, out * view.scale, -heading - HALF_BEAM_RAD, -heading + HALF_BEAM_RAD);
      context.stroke();
      context.globalAlpha = 1;
    }
    if (reading.way && reading.emitted <= at && at < reading.heard) drawStroke(context, view, reading, at, colours);
  }
}

/**
 * @param {CanvasRenderingContext2D} context @param {import("./view.js").View} view @param {Reading} reading
 * @param {number} at @param {import("./colours.js").Colours} colours
 */
function drawStroke(context, view, reading, at, colours) {
  const way = /** @type {import("./run.js").Way} */ (reading.way);
  const length = way.lengths[way.lengths.length - 1];
  const head = ((at - reading.emitted) / (reading.heard - reading.emitted)) * length;
  const foreign = way.emitter !== way.receiver;
  const corners = between(way, Math.max(0, head - STROKE_M), head);
  context.strokeStyle = sensorColour(colours, way.emitter);
  context.lineWidth = foreign ? 5 : 2.5;
  context.beginPath();
  corners.forEach(([x, y], k) => {
    const spot = view.px(x, y);
    if (k === 0) context.moveTo(spot.x, spot.y);
    else context.lineTo(spot.x, spot.y);
  });
  context.stroke();
}

/** @param {import("./run.js").Way} way @param {number} from @param {number} to @returns {[number, number][]} */
function between(way, from, to) {
  const corners = way.corners.filter((_, k) => way.lengths[k] > from && way.lengths[k] < to);
  return [pointAt(way, from), ...corners, pointAt(way, to)];
}

/** @param {import("./run.js").Way} way @param {number} length @returns {[number, number]} */
function pointAt({ corners, lengths }, length) {
  let k = 1;
  while (k < lengths.length - 1 && lengths[k] < length) k += 1;
  const share = (length - lengths[k - 1]) / Math.max(1e-9, lengths[k] - lengths[k - 1]);
  const [[x0, y0], [x1, y1]] = [corners[k - 1], corners[k]];
  return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
}

/**
 * @param {import("./view.js").View} view @param {import("./view.js").Spot} from @param {import("./view.js").Spot} to
 * @returns {import("./view.js").Spot} The end, or the point where the way there leaves the picture: each mark is seen.
 */
function within({ width, height }, from, to) {
  const share = (/** @type {number} */ a, /** @type {number} */ b, /** @type {number} */ most) =>
    b < EDGE_PX ? (a - EDGE_PX) / (a - b) : b > most - EDGE_PX ? (most - EDGE_PX - a) / (b - a) : 1;
  const part = Math.max(0, Math.min(1, share(from.x, to.x, width), share(from.y, to.y, height)));
  return { x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) };
}

/**
 * The belief of each sensor: the last accepted reading along its axis, and for a moment rejected ones.
 * @param {CanvasRenderingContext2D} context
 * @param {import("./view.js").View} view
 * @param {{traced: import("./draw-scene.js").Traced, readings: Reading[], at: number}} moment
 * @param {import("./colours.js").Colours} colours
 */
export function drawBeliefs(context, view, { traced, readings, at }, colours) {
  /** @type {Map<number, Reading>} */
  const believed = new Map();
  /** @type {Reading[]} */
  const rejected = [];
  for (const reading of readings) {
    if (reading.fired > at) break;
    if (reading.heard > at) continue;
    if (reading.verdict === "accepted") believed.set(reading.sensor, reading);
    else if (reading.verdict === "rejected" && at - reading.heard < REJECTED_FOR_S) rejected.push(reading);
  }
  for (const reading of [...rejected, ...believed.values()]) {
    const sensor = traced.sensors[reading.sensor];
    const mark = markOf(reading);
    if (!sensor || !mark || reading.t_echo_us === null) continue;
    const [x, y, heading] = sensor;
    const range = 0.5e-6 * reading.t_echo_us * traced.sound_m_s;
    const from = view.px(x, y);
    const to = within(view, from, view.px(x + range * Math.cos(heading), y + range * Math.sin(heading)));
    context.strokeStyle = mark === "wrong" ? colours.wrong : mark === "right" ? colours.right : colours.rejected;
    context.globalAlpha = mark === "wrong" ? 0.8 : 0.35;
    context.lineWidth = mark === "wrong" ? 2 : 1.25;
    context.beginPath();
    context.moveTo(from.x, from.y);
    context.lineTo(to.x, to.y);
    context.stroke();
    context.globalAlpha = 1;
    drawMark(context, mark, to.x, to.y, mark === "wrong" ? 6.5 : 5, colours);
  }
}
