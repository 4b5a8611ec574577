// @ts-check
/** The state in the texts that the engine, the program `eeruf` and Python read: a scene and a ring, in TOML. */
import { MODULES, spacingOf } from "./state.js";

/** @param {number} number @returns {string} The number in TOML, without rounding errors of binary fractions. */
function toml(number) {
  return String(Number(number.toFixed(6)));
}

/** @param {number[]} numbers */
function tomlList(numbers) {
  return `[${numbers.map(toml).join(", ")}]`;
}

/** The period of rings that are not designed yet: the paper's first experiment. */
const WATCHED = { period_us: 60_000, t_delta_us: 500, window_us: 36_000 };

/** @param {import("./state.js").State} state @returns {string} The room with the robot, as `eeruf study` reads it. */
export function sceneText(state) {
  const { robot, own } = state;
  const lines = [
    '# Made by the page "Who fools whom?". Lengths in metres, angles in degrees, times in microseconds.',
    "seed = 1",
    "max_order = 4",
    'physics = "plain"',
    "",
  ];
  for (const wall of state.walls) {
    lines.push("[[wall]]", `points_m = [${wall.map(tomlList).join(", ")}]`, 'faces = "both"', "");
  }
  for (const [x, y, radius] of state.poles) {
    lines.push("[[pole]]", `at_m = ${tomlList([x, y])}`, `radius_m = ${toml(radius)}`, "");
  }
  const { period_us, t_delta_us, window_us } = own ?? WATCHED;
  lines.push(
    "[[robot]]",
    `pose = { x_m = ${toml(robot.x)}, y_m = ${toml(robot.y)}, heading_deg = ${toml(robot.heading)} }`,
    `ring = { sensors = ${state.sensors}, spacing_deg = ${toml(spacingOf(state))}, radius_m = ${toml(state.radius)} }`,
    `transducer = "${state.module}"`,
    `period_us = ${period_us}`,
    `t_delta_us = ${t_delta_us}`,
    `window_us = ${window_us}`,
  );
  if (own) {
    const times = `t_fire_a_us = ${tomlList(own.a)}, t_fire_b_us = ${tomlList(own.b)}`;
    lines.push(`schedule = { period_us = ${own.period_us}, ${times} }`);
  }
  return `${lines.join("\n")}\n`;
}

/**
 * Rewrites the engine's error about a scene in the page's words: the engine counts straight walls and poles from 0, as
 * files do; the page counts everything that is dragged as one wall, from 1.
 * @param {string} sentence
 * @param {import("./state.js").State} state
 * @returns {string}
 */
export function inPageWords(sentence, state) {
  const owners = state.walls.flatMap((wall, w) => wall.slice(1).map(() => w + 1));
  const numbers = /\b(wall|pole)(s?) (\d+)(?: and (\d+))?/g;
  return sentence
    .replace(/^robot 1\b/, "the robot")
    .replace(numbers, (_, /** @type {string} */ kind, /** @type {string} */ many, ...given) => {
      const [first, second] = given
        .slice(0, 2)
        .map((index) => (kind === "wall" ? owners[Number(index)] : Number(index) + 1) ?? index);
      if (!many) return `${kind} ${first}`;
      return first === second ? `two parts of ${kind} ${first}` : `${kind}s ${first} and ${second}`;
    });
}

/** @param {import("./state.js").State} state @returns {string} The ring, as `eeruf design` reads it. */
export function ringText(state) {
  const module = MODULES.find((one) => one.id === state.module);
  const lines = [
    `# ${state.sensors} ${module?.name} sensors.`,
    `sensors = ${state.sensors}`,
    `layout = "${state.layout}"`,
    "neighbours = 4",
    `max_range_m = ${toml(state.range)}`,
  ];
  if (module?.retrigger) lines.push(`retrigger_us = ${module.retrigger}`);
  lines.push(
    `crosstalk_range_m = ${toml(state.crosstalk)}`,
    `jitter_us = ${state.jitter}`,
    `speed_m_s = ${toml(state.speed)}`,
    `tick_us = ${state.tick}`,
  );
  return `${lines.join("\n")}\n`;
}

/**
 * @param {import("./state.js").State} state
 * @param {{fire_us: number[][], t_delta_us: number, min_interval_us: number, window_us: number,
 *   found: {value_us: number}}} designed
 * @returns {string} The schedule in Python.
 */
export function pythonText(state, designed) {
  const [a, b] = designed.fire_us.map((times) => `[${times.join(", ")}]`);
  return [
    "import eeruf",
    "",
    "schedule = eeruf.Schedule.from_firing(",
    `    period_us=${designed.found.value_us},`,
    `    t_fire_a_us=${a},`,
    `    t_fire_b_us=${b},`,
    ")",
    "report = schedule.verify(",
    `    t_delta_us=${designed.t_delta_us}, min_interval_us=${designed.min_interval_us}, window_us=${designed.window_us},`,
    `    neighbours=4, layout="${state.layout}",`,
    ")",
    "assert report.ok, report.violations",
    "print(schedule, report)",
    "",
  ].join("\n");
}
