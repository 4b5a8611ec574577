// @ts-check
/** The timing diagram of a schedule (Fig. 3 of the paper): two periods, one lane for each sensor; point at it to read. */
import { gridStep } from "./chart.js";
import { sensorColour } from "./colours.js";
import { contextOf, unit } from "./view.js";

const LEFT = 34;
const RIGHT = 12;
const TOP = 24;
const BOTTOM = 22;

/** @typedef {{period_us: number, window_us: number, fire_us: number[][]}} Timing */

/** @param {number} us @returns {string} In milliseconds. */
export function inMs(us) {
  return `${Number((us / 1000).toFixed(3))} ms`;
}

/** @param {number} sensors @returns {number} Height of the diagram for this many sensors, in units of the picture. */
export function timingHeight(sensors) {
  return TOP + BOTTOM + sensors * laneHeight(sensors);
}

/** @param {number} sensors */
function laneHeight(sensors) {
  return sensors > 32 ? 13 : sensors > 16 ? 17 : 24;
}

/** @param {Timing} timing @param {number} sensor @param {number} at In microseconds within two periods. */
function soundAge({ period_us, fire_us }, sensor, at) {
  const cycle = 2 * period_us;
  const ages = fire_us.map((times, phase) => {
    const since = (at - times[sensor] - phase * period_us + 2 * cycle) % cycle;
    return { since, phase };
  });
  return ages.reduce((one, other) => (one.since <= other.since ? one : other));
}

/** @param {Timing} timing @param {number} sensor @param {number} at @returns {string} The sensor's activity then. */
export function saidAt(timing, sensor, at) {
  const { since, phase } = soundAge(timing, sensor, at);
  const [a, b] = timing.fire_us.map((times) => times[sensor]);
  const does =
    since < timing.window_us
      ? `listens, having fired ${inMs(since)} ago`
      : `is silent, its last sound ${inMs(since)} old`;
  const cycle = `fires ${inMs(a)} into phase a and ${inMs(b)} into phase b, a difference of ${inMs(Math.abs(b - a))}`;
  return `At ${inMs(at)} sensor ${sensor + 1} ${does} (phase ${"ab"[phase]}). It ${cycle}.`;
}

/** The time and the sensor under the pointer. @param {HTMLCanvasElement} canvas @param {Timing} timing
 *  @param {{offsetX: number, offsetY: number}} event */
export function pointedAt(canvas, timing, event) {
  const sensors = timing.fire_us[0].length;
  const share = (event.offsetX / unit() - LEFT) / (canvas.clientWidth / unit() - LEFT - RIGHT);
  const at = Math.round(Math.min(1, Math.max(0, share)) * 2 * timing.period_us);
  const lane = Math.floor((event.offsetY / unit() - TOP) / laneHeight(sensors));
  return { at, sensor: Math.min(sensors - 1, Math.max(0, lane)) };
}

/**
 * @param {HTMLCanvasElement} canvas @param {Timing} timing
 * @param {{at: number, sensor: number}} cursor
 * @param {import("./colours.js").Colours} colours
 */
export function drawTiming(canvas, timing, cursor, colours) {
  const { period_us, window_us, fire_us } = timing;
  const sensors = fire_us[0].length;
  const lane = laneHeight(sensors);
  const { context, width } = contextOf(canvas);
  const right = width - RIGHT;
  const bottom = TOP + sensors * lane;
  const x = (/** @type {number} */ us) => LEFT + (us / (2 * period_us)) * (right - LEFT);
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.fillStyle = colours.muted;
  context.textAlign = "left";
  ["phase a", "phase b"].forEach((name, phase) => context.fillText(name, x(phase * period_us) + 5, 11));
  context.textAlign = "center";
  const step = gridStep((2 * period_us) / 1000, width > 600 ? 10 : 5);
  for (let ms = 0; ms <= (2 * period_us) / 1000; ms += step) {
    stroke(context, [x(1000 * ms), TOP, x(1000 * ms), bottom + 3], 1, colours.faint);
    context.fillText(String(Number(ms.toFixed(3))), x(1000 * ms), bottom + 12);
  }
  context.textAlign = "right";
  context.fillText("ms", right, bottom + 12);
  for (const phase of [0, 1, 2])
    stroke(context, [x(phase * period_us), 4, x(phase * period_us), bottom], 1.5, colours.muted);
  for (let sensor = 0; sensor < sensors; sensor++) {
    const top = TOP + sensor * lane;
    if (sensor === cursor.sensor) {
      context.fillStyle = colours.robot;
      context.fillRect(LEFT, top, right - LEFT, lane);
    }
    context.fillStyle = colours.ink;
    context.fillText(String(sensor + 1), LEFT - 7, top + lane / 2);
    fire_us.forEach((times, phase) => {
      const fire = phase * period_us + times[sensor];
      context.fillStyle = colours.listening;
      // A window that passes the end of the second period continues in the first.
      for (const from of [fire, fire - 2 * period_us]) {
        const [start, end] = [Math.max(0, from), Math.min(2 * period_us, from + window_us)];
        if (end > start) context.fillRect(x(start), top + lane * 0.3, x(end) - x(start), lane * 0.4);
      }
    });
    fire_us.forEach((times, phase) => {
      const fire = (phase * period_us + times[sensor]) % (2 * period_us);
      context.fillStyle = sensorColour(colours, sensor);
      context.fillRect(x(fire) - 1.5, top + lane * 0.12, 4, lane * 0.76);
    });
  }
  stroke(context, [x(cursor.at), TOP - 4, x(cursor.at), bottom], 1.5, colours.ink);
}

/** @param {CanvasRenderingContext2D} context @param {number[]} ends @param {number} width @param {string} colour */
function stroke(context, [x0, y0, x1, y1], width, colour) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
