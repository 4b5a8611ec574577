// @ts-check
/** The readings of one sensor over time: the same marks as in the room, and a line for its readings alone. */
import { drawMark, markOf } from "./marks.js";

const LEFT = 38;
const BOTTOM = 20;
const TOP = 8;

/** @param {number} range @param {number} lines @returns {number} A round distance between grid lines. */
export function gridStep(range, lines) {
  const rough = range / lines;
  const magnitude = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((n) => n * magnitude).find((step) => step >= rough * 0.999) ?? rough;
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {{width: number, height: number, until: number, farthest: number}} frame Pixels, seconds and metres.
 * @param {{readings: import("./run.js").Reading[], sound_m_s: number, at: number}} what The readings of the sensor.
 * @param {import("./colours.js").Colours} colours
 */
export function drawChart(context, { width, height, until, farthest }, { readings, sound_m_s, at }, colours) {
  const x = (/** @type {number} */ s) => LEFT + (s / until) * (width - LEFT - 8);
  const y = (/** @type {number} */ m) => height - BOTTOM - (m / farthest) * (height - BOTTOM - TOP);
  const metres = (/** @type {number} */ us) => 0.5e-6 * us * sound_m_s;
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = colours.muted;
  context.strokeStyle = colours.faint;
  context.lineWidth = 1;
  context.textAlign = "right";
  context.textBaseline = "middle";
  const step = gridStep(farthest, 3);
  for (let m = 0; m <= farthest + 1e-9; m += step) {
    line(context, LEFT, y(m), width - 8, y(m));
    context.fillText(`${Number(m.toFixed(2))} m`, LEFT - 5, y(m));
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  const tick = gridStep(until, 5);
  for (let s = 0; s <= until + 1e-9; s += tick)
    context.fillText(`${Number(s.toFixed(2))} s`, Math.min(x(s), width - 20), height - BOTTOM + 5);
  // A sensor alone in the room reads this.
  context.strokeStyle = colours.muted;
  context.globalAlpha = 0.6;
  context.lineWidth = 3;
  readings.forEach((reading, k) => {
    if (reading.reference_us === null) return;
    const next = readings[k + 1]?.fired ?? until;
    line(
      context,
      x(reading.fired),
      y(metres(reading.reference_us)),
      x(Math.min(until, next)),
      y(metres(reading.reference_us)),
    );
  });
  context.globalAlpha = 1;
  for (const reading of readings) {
    const mark = markOf(reading);
    if (!mark || reading.t_echo_us === null) continue;
    context.globalAlpha = reading.heard <= at ? 1 : 0.25;
    drawMark(context, mark, x(reading.fired), y(Math.min(farthest, metres(reading.t_echo_us))), 4, colours);
  }
  context.globalAlpha = 1;
  context.strokeStyle = colours.ink;
  context.lineWidth = 1;
  line(context, x(Math.min(at, until)), TOP, x(Math.min(at, until)), height - BOTTOM);
}

/** @param {CanvasRenderingContext2D} context @param {number} x0 @param {number} y0 @param {number} x1 @param {number} y1 */
function line(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
