// @ts-check
/**
 * Everything that the page shows, as one plain object: the room, the robot with its ring, and the methods compared. A
 * link holds all of it. Lengths in metres, angles in degrees, times in microseconds; sensors from 0.
 */

/**
 * @typedef {object} OwnSchedule A schedule found by `design`, with the requirements that it was verified for.
 * @property {number} period_us
 * @property {number[]} a
 * @property {number[]} b
 * @property {number} t_delta_us
 * @property {number} window_us
 */

/**
 * @typedef {object} State
 * @property {[number, number][][]} walls Polylines.
 * @property {[number, number, number][]} poles Centre and radius.
 * @property {{x: number, y: number, heading: number}} robot
 * @property {number} sensors
 * @property {"line" | "ring"} layout In front, or all the way round.
 * @property {number} spacing Between two sensors of a line.
 * @property {number} radius Of the robot.
 * @property {string} module
 * @property {number} range The range that the sensors need.
 * @property {number} crosstalk Distance up to which a wall may let neighbours hear each other.
 * @property {number} jitter Variation of a good reading on a standing robot.
 * @property {number} speed Speed of the robot, in m/s.
 * @property {number} tick The grid of firing times.
 * @property {OwnSchedule | null} own The schedule to watch instead of the paper's.
 * @property {string[]} shown The methods that are compared.
 * @property {number} sensor The selected sensor.
 * @property {number} slow Factor by which the sound is slower than in reality.
 */

/** The modules that the simulator knows, with their makers' figures. */
export const MODULES = [
  { id: "polaroid_6500", name: "Polaroid 6500", range: 4, retrigger: 0, jitter: 60, crosstalk: 2 },
  { id: "hc_sr04", name: "HC-SR04", range: 4, retrigger: 40_000, jitter: 100, crosstalk: 2.5 },
];

/** @type {Record<string, {name: string, walls: [number, number][][], poles: [number, number, number][],
 *   robot: {x: number, y: number, heading: number}}>} */
export const ROOMS = {
  alcove: {
    name: "Three walls",
    walls: [
      [
        [0.85, 0],
        [0.85, 1.39],
        [-0.85, 1.39],
        [-0.85, 0],
      ],
    ],
    poles: [],
    robot: { x: -0.26, y: 0.17, heading: 94.3 },
  },
  wall: {
    name: "One wall",
    walls: [
      [
        [3, 1.3],
        [-3, 1.3],
      ],
    ],
    poles: [],
    robot: { x: 0, y: 0, heading: 90 },
  },
  corridor: {
    name: "Corridor",
    walls: [
      [
        [-2, 0.75],
        [2.6, 0.75],
      ],
      [
        [-2, -0.75],
        [2.6, -0.75],
      ],
    ],
    poles: [],
    robot: { x: -0.9, y: 0.1, heading: 6 },
  },
  room: {
    name: "Open room with a pole",
    walls: [
      [
        [-1.8, -1.3],
        [1.6, -1.3],
        [1.6, 0.2],
      ],
      [
        [-1.8, 1.4],
        [0.2, 1.4],
      ],
    ],
    poles: [[1.1, 0.9, 0.03]],
    robot: { x: -0.6, y: -0.2, heading: 15 },
  },
  closed: {
    name: "Closed room, where sound lasts",
    walls: [
      [
        [-1.7, -1.2],
        [1.8, -1.2],
        [1.8, 1.3],
        [-1.7, 1.3],
        [-1.7, -1.2],
      ],
    ],
    poles: [
      [0.7, 0.5, 0.03],
      [0.9, -0.4, 0.03],
    ],
    robot: { x: -0.7, y: -0.1, heading: 12 },
  },
};

/** The limits of the page: [least, most, unit]. Rooms may hold 40 straight walls. */
export const LIMITS = {
  sensors: [1, 64, ""],
  spacing: [1, 120, "degrees"],
  radius: [0.02, 1, "m"],
  range: [0.2, 10, "m"],
  crosstalk: [0, 10, "m"],
  jitter: [0, 5000, "us"],
  speed: [0, 10, "m/s"],
  tick: [10, 10_000, "us"],
  slow: [2, 400, "times"],
};
const MAX_WALLS = 40;
const MAX_POLES = 40;
const FARTHEST_M = 20;
const MAX_SHOWN = 4;
const MAX_PERIOD_US = 268_435_456;

/** @returns {State} The state at the beginning: the paper's first experiment. */
export function firstState() {
  const { walls, poles, robot } = structuredClone(ROOMS.alcove);
  return {
    walls,
    poles,
    robot,
    sensors: 8,
    layout: "line",
    spacing: 15,
    radius: 0.3,
    module: "polaroid_6500",
    range: 4,
    crosstalk: 2,
    jitter: 60,
    speed: 0.5,
    tick: 100,
    own: null,
    shown: ["conventional", "eeruf", "flow"],
    sensor: 0,
    slow: 25,
  };
}

/** @param {State} state @returns {number} The angle between two sensors, in degrees. */
export function spacingOf(state) {
  return state.layout === "ring" ? 360 / state.sensors : state.spacing;
}

/** @param {number} metres @returns {number} To a millimetre. */
export function toMillimetre(metres) {
  return Math.round(metres * 1000) / 1000;
}

/** An error in a state: one sentence. */
export class StateError extends Error {}

/** @param {string} name @param {unknown} value @param {number} least @param {number} most @param {string} [unit] */
function number(name, value, least, most, unit = "") {
  if (typeof value === "number" && value >= least && value <= most) return value;
  throw new StateError(`${name} is ${shown(value)}; expected a number from ${least} to ${most} ${unit}`.trim());
}

/** @param {string} name @param {unknown} value @param {number} least @param {number} most */
function whole(name, value, least, most) {
  if (Number.isInteger(number(name, value, least, most))) return /** @type {number} */ (value);
  throw new StateError(`${name} is ${shown(value)}; expected a whole number from ${least} to ${most}`);
}

/** @template {string} T @param {string} name @param {unknown} value @param {readonly T[]} allowed @returns {T} */
function oneOf(name, value, allowed) {
  const found = allowed.find((one) => one === value);
  if (found !== undefined) return found;
  throw new StateError(`${name} is ${shown(value)}; expected ${allowed.join(", ")}`);
}

/** @param {string} name @param {unknown} value @param {number} most @returns {unknown[]} */
function list(name, value, most) {
  if (Array.isArray(value) && value.length <= most) return value;
  const given = Array.isArray(value) ? `a list of ${value.length}` : shown(value);
  throw new StateError(`${name} is ${given}; expected a list of at most ${most}`);
}

/** @param {unknown} value */
function shown(value) {
  const text = JSON.stringify(value) ?? "missing";
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}

/** @param {string} name @param {unknown} value @returns {[number, number]} */
function point(name, value) {
  const [x, y] = list(name, value, 2);
  return [number(`${name}, x`, x, -FARTHEST_M, FARTHEST_M, "m"), number(`${name}, y`, y, -FARTHEST_M, FARTHEST_M, "m")];
}

/**
 * @param {any} given Anything, from a link or from a form.
 * @returns {State} The checked state, without any other properties. Throws `StateError`.
 */
export function checkedState(given) {
  if (typeof given !== "object" || given === null)
    throw new StateError(`The link holds ${shown(given)}; expected a state`);
  const walls = list("walls", given.walls, MAX_WALLS).map((wall, k) => {
    const points = list(`wall ${k + 1}`, wall, MAX_WALLS + 1).map((at, n) =>
      point(`wall ${k + 1}, point ${n + 1}`, at),
    );
    if (points.length < 2) throw new StateError(`wall ${k + 1} has ${points.length} points; expected at least 2`);
    return points;
  });
  const straight = walls.reduce((sum, wall) => sum + wall.length - 1, 0);
  if (straight > MAX_WALLS) throw new StateError(`${straight} straight walls; expected at most ${MAX_WALLS}`);
  const poles = list("poles", given.poles, MAX_POLES).map((pole, k) => {
    const [x, y, radius] = list(`pole ${k + 1}`, pole, 3);
    const [px, py] = point(`pole ${k + 1}`, [x, y]);
    return /** @type {[number, number, number]} */ ([px, py, number(`pole ${k + 1}, radius`, radius, 0.001, 1, "m")]);
  });
  const [x, y] = point("robot", [given.robot?.x, given.robot?.y]);
  const sensors = whole("sensors", given.sensors, 1, 64);
  /** @param {keyof typeof LIMITS} name */
  const within = (name) => {
    const [least, most, unit] = LIMITS[name];
    return number(name, given[name], Number(least), Number(most), String(unit));
  };
  return {
    walls,
    poles,
    robot: { x, y, heading: number("heading", given.robot?.heading, -3600, 3600, "degrees") },
    sensors,
    layout: oneOf("layout", given.layout, ["line", "ring"]),
    spacing: within("spacing"),
    radius: within("radius"),
    module: oneOf(
      "module",
      given.module,
      MODULES.map((module) => module.id),
    ),
    range: within("range"),
    crosstalk: within("crosstalk"),
    jitter: whole("jitter", given.jitter, 0, 5000),
    speed: within("speed"),
    tick: whole("tick", given.tick, 10, 10_000),
    own: given.own ? ownSchedule(given.own, sensors) : null,
    // The caller of the engine leaves out methods that the engine does not know.
    shown: list("shown", given.shown, MAX_SHOWN).map(String),
    sensor: whole("sensor", given.sensor, 0, sensors - 1),
    slow: within("slow"),
  };
}

/** @param {any} given @param {number} sensors @returns {OwnSchedule} */
function ownSchedule(given, sensors) {
  const time = (/** @type {string} */ name) => whole(`own schedule, ${name}`, given[name], 0, MAX_PERIOD_US);
  const times = (/** @type {string} */ name) => {
    const all = list(`own schedule, ${name}`, given[name], 64);
    if (all.length !== sensors) {
      throw new StateError(`own schedule, ${name} has ${all.length} times; expected ${sensors}, one for each sensor`);
    }
    return all.map((us, k) => whole(`own schedule, ${name}, sensor ${k + 1}`, us, 0, MAX_PERIOD_US));
  };
  return {
    period_us: time("period_us"),
    a: times("a"),
    b: times("b"),
    t_delta_us: time("t_delta_us"),
    window_us: time("window_us"),
  };
}
