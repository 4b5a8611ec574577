// @ts-check
/** The colours of the pictures, as the style sheet sets them for light and dark. */

/** @typedef {{paper: string, floor: string, ink: string, muted: string, faint: string, right: string, wrong: string,
 *   rejected: string, listening: string, robot: string, sensors: string[]}} Colours */

/** Ten colours of sensors, as in the project's pictures; every tenth sensor has the same. */
const ON_LIGHT = [
  "#1f6fb4",
  "#c65f0a",
  "#24803f",
  "#b0338f",
  "#7d4f33",
  "#0f7f92",
  "#6a4cb8",
  "#857106",
  "#c22a3b",
  "#5a606b",
];
const ON_DARK = [
  "#6cb2ee",
  "#f4a259",
  "#69c584",
  "#e887cf",
  "#c79a7e",
  "#4fcfe3",
  "#ac94ee",
  "#d9c04a",
  "#f27c88",
  "#aab1bd",
];

/** @returns {Colours} The present colours. */
export function readColours() {
  const style = getComputedStyle(document.documentElement);
  const of = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
  return {
    paper: of("paper"),
    floor: of("floor"),
    ink: of("ink"),
    muted: of("muted"),
    faint: of("faint"),
    right: of("right"),
    wrong: of("wrong"),
    rejected: of("rejected"),
    listening: of("listening"),
    robot: of("robot"),
    sensors: of("scheme") === "dark" ? ON_DARK : ON_LIGHT,
  };
}

/** @param {Colours} colours @param {number} sensor From 0. */
export function sensorColour(colours, sensor) {
  return colours.sensors[sensor % colours.sensors.length];
}
