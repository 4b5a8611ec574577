// @ts-check
/** The room with the robot, and the paths along which foreign sound reaches one sensor. */
import { sensorColour } from "./colours.js";

/** @typedef {import("./colours.js").Colours} Colours */
/** @typedef {import("./view.js").View} View */
/** @typedef {{sensors: [number, number, number][], body_radius_m: number, sound_m_s: number, period_us: number,
 *   window_us: number, paths: {emitter: number, receiver: number, order: number, length_m: number, level_db: number,
 *   corners: [number, number][]}[]}} Traced */

const HALF_BEAM_RAD = (12 * Math.PI) / 180;
const BEAM_M = 0.22;
/** Distance of a number behind its sensor, in pixels. */
const NUMBER_IN = 11;

/** @param {CanvasRenderingContext2D} context @param {View} view @param {[number, number][]} corners */
export function polyline(context, view, corners) {
  context.beginPath();
  corners.forEach(([x, y], k) => {
    const at = view.px(x, y);
    if (k === 0) context.moveTo(at.x, at.y);
    else context.lineTo(at.x, at.y);
  });
}

/**
 * @param {CanvasRenderingContext2D} context @param {View} view @param {import("./state.js").State} state
 * @param {Colours} colours
 */
export function drawRoom(context, view, state, colours) {
  context.fillStyle = colours.floor;
  context.fillRect(0, 0, view.width, view.height);
  context.lineCap = "round";
  context.lineJoin = "round";
  context.strokeStyle = colours.ink;
  context.lineWidth = 3.5;
  for (const wall of state.walls) {
    polyline(context, view, wall);
    context.stroke();
  }
  context.fillStyle = colours.ink;
  for (const [x, y, radius] of state.poles) {
    const at = view.px(x, y);
    context.beginPath();
    context.arc(at.x, at.y, Math.max(3, radius * view.scale), 0, 2 * Math.PI);
    context.fill();
  }
  drawScale(context, view, colours);
}

/** @param {CanvasRenderingContext2D} context @param {View} view @param {Colours} colours */
function drawScale(context, view, colours) {
  const metres = view.scale > 160 ? 0.5 : view.scale > 60 ? 1 : 5;
  const [right, y] = [view.width - 10, view.height - 10];
  const left = right - metres * view.scale;
  context.strokeStyle = colours.muted;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(left, y - 4);
  context.lineTo(left, y);
  context.lineTo(right, y);
  context.lineTo(right, y - 4);
  context.stroke();
  context.fillStyle = colours.muted;
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "right";
  context.textBaseline = "bottom";
  context.fillText(`${metres} m`, right - 4, y - 3);
}

/**
 * The paths along which one sensor is fooled, with arrows; the more often, the wider.
 * @param {CanvasRenderingContext2D} context @param {View} view
 * @param {ReturnType<typeof import("./run.js").foolersOf>} foolers @param {Colours} colours
 */
export function drawFoolers(context, view, foolers, colours) {
  const most = Math.max(1, ...foolers.map((one) => one.wrong));
  for (const { emitter, wrong, accepted, corners } of foolers) {
    if (corners.length < 2) continue;
    const width = 1 + 3 * Math.sqrt(wrong / most);
    context.strokeStyle = context.fillStyle = sensorColour(colours, emitter);
    context.globalAlpha = accepted > 0 ? 0.75 : 0.4;
    context.lineWidth = width;
    // Paths of sound that was never believed are dashed.
    context.setLineDash(accepted > 0 ? [] : [5, 5]);
    polyline(context, view, corners);
    context.stroke();
    context.setLineDash([]);
    const [from, to] = corners.slice(-2).map(([x, y]) => view.px(x, y));
    const turn = Math.atan2(to.y - from.y, to.x - from.x);
    const size = 5 + 2 * width;
    context.beginPath();
    context.moveTo(to.x, to.y);
    context.lineTo(to.x - size * Math.cos(turn - 0.4), to.y - size * Math.sin(turn - 0.4));
    context.lineTo(to.x - size * Math.cos(turn + 0.4), to.y - size * Math.sin(turn + 0.4));
    context.fill();
  }
  context.globalAlpha = 1;
}

/**
 * The paths from all other sensors to one, shown while the room is dragged; the louder, the clearer.
 * @param {CanvasRenderingContext2D} context @param {View} view @param {Traced} traced @param {number} receiver
 * @param {Colours} colours
 */
export function drawWays(context, view, traced, receiver, colours) {
  context.setLineDash([5, 5]);
  context.lineWidth = 1.25;
  for (const path of traced.paths) {
    if (path.receiver !== receiver || path.emitter === receiver) continue;
    context.globalAlpha = Math.min(0.8, 0.15 + Math.max(0, path.level_db) / 50);
    polyline(context, view, path.corners);
    context.strokeStyle = sensorColour(colours, path.emitter);
    context.stroke();
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/**
 * @param {CanvasRenderingContext2D} context @param {View} view @param {Traced} traced
 * @param {{sensor: number, blind: number[]}} looks The selected sensor, and the blind sensors.
 * @param {Colours} colours
 */
export function drawRobot(context, view, traced, { sensor: looked, blind }, colours) {
  const { sensors } = traced;
  const middle = middleOf(traced);
  const at = view.px(middle.x, middle.y);
  context.fillStyle = colours.robot;
  context.beginPath();
  context.arc(at.x, at.y, traced.body_radius_m * view.scale, 0, 2 * Math.PI);
  context.fill();
  const few = sensors.length <= 24;
  const radius = traced.body_radius_m * view.scale;
  const room = numberRoom(traced, radius - NUMBER_IN);
  sensors.forEach(([x, y, heading], k) => {
    const spot = view.px(x, y);
    const colour = sensorColour(colours, k);
    const isBlind = blind.includes(k);
    if (few) {
      context.globalAlpha = isBlind ? 0.1 : 0.25;
      context.fillStyle = colour;
      context.beginPath();
      context.moveTo(spot.x, spot.y);
      context.arc(spot.x, spot.y, BEAM_M * view.scale, -heading - HALF_BEAM_RAD, -heading + HALF_BEAM_RAD);
      context.closePath();
      context.fill();
      context.globalAlpha = 1;
    }
    drawSensor(context, spot, colour, { looked: k === looked, isBlind }, colours);
    // Numbers stand inside the ring, where no sound goes.
    const far = NUMBER_IN + (k === looked ? 5 : 0) + (isBlind ? 4 : 0);
    const inside = { x: spot.x - far * Math.cos(heading), y: spot.y + far * Math.sin(heading) };
    if (room > 6 || k === looked) {
      context.fillStyle = colours.ink;
      context.font = `${k === looked ? "bold " : ""}${room > 14 || k === looked ? 12 : 10}px system-ui, sans-serif`;
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.fillText(String(k + 1), inside.x, inside.y);
    }
  });
}

/** @param {Traced} traced @param {number} radius In pixels. @returns {number} The room for a number there. */
function numberRoom({ sensors }, radius) {
  if (sensors.length < 2) return radius;
  const [[, , one], [, , other]] = sensors;
  const turn = Math.abs(Math.atan2(Math.sin(other - one), Math.cos(other - one)));
  return radius * turn;
}

/** @param {CanvasRenderingContext2D} context @param {import("./view.js").Spot} spot @param {string} colour
 *  @param {{looked: boolean, isBlind: boolean}} how @param {Colours} colours */
function drawSensor(context, spot, colour, { looked, isBlind }, colours) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(spot.x, spot.y, 4, 0, 2 * Math.PI);
  context.fill();
  if (isBlind) {
    // Blind sensors are crossed out, as on a sign.
    context.strokeStyle = colours.wrong;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(spot.x, spot.y, 8, 0, 2 * Math.PI);
    context.moveTo(spot.x - 5.6, spot.y + 5.6);
    context.lineTo(spot.x + 5.6, spot.y - 5.6);
    context.stroke();
  }
  if (looked) {
    context.strokeStyle = colours.ink;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(spot.x, spot.y, isBlind ? 11 : 7, 0, 2 * Math.PI);
    context.stroke();
  }
}

/** @param {Traced} traced @returns {import("./view.js").Spot} The middle of the robot: behind each of its sensors. */
function middleOf({ sensors, body_radius_m }) {
  const [x, y, heading] = sensors[0];
  return { x: x - body_radius_m * Math.cos(heading), y: y - body_radius_m * Math.sin(heading) };
}
