// @ts-check
/** A run from the engine, prepared for drawing: one object for each reading, in order of firing. */

/**
 * @typedef {object} Reading
 * @property {number} sensor
 * @property {number} period
 * @property {number} phase
 * @property {number} fired
 * @property {number | null} t_echo_us
 * @property {number | null} reference_us
 * @property {string} verdict
 * @property {boolean} wrong
 * @property {string} cause
 * @property {Way | null} way
 * @property {number} emitted
 * @property {number} heard Time when the echo came; without an echo, the end of the window.
 */

/**
 * @typedef {object} Way
 * @property {number} emitter
 * @property {number} receiver
 * @property {[number, number][]} corners
 * @property {number[]} lengths From the start to each corner.
 */

/** @param {[number, number][]} corners @returns {number[]} Distance of each corner from the start along the way. */
export function lengthsOf(corners) {
  const lengths = [0];
  for (let k = 1; k < corners.length; k++) {
    const [[x0, y0], [x1, y1]] = [corners[k - 1], corners[k]];
    lengths.push(lengths[k - 1] + Math.hypot(x1 - x0, y1 - y0));
  }
  return lengths;
}

/** @param {any} run The engine's answer. @param {number} window_us @returns {Reading[]} */
export function readingsOf(run, window_us) {
  const { readings, paths } = run;
  /** @type {Way[]} */
  const ways = paths.map((/** @type {any} */ path) => ({ ...path, lengths: lengthsOf(path.corners) }));
  const all = readings.sensor.map((/** @type {number} */ sensor, /** @type {number} */ k) => {
    const path = readings.path[k];
    const t_echo_us = readings.t_echo_us[k];
    const fired = readings.fired_s[k];
    return {
      sensor,
      period: readings.period[k],
      phase: readings.phase[k],
      fired,
      t_echo_us,
      reference_us: readings.reference_us[k],
      verdict: readings.verdict[k],
      wrong: readings.wrong[k],
      cause: readings.cause[k],
      way: path === null || ways[path].corners.length < 2 ? null : ways[path],
      emitted: readings.emitted_s[k],
      heard: fired + 1e-6 * (t_echo_us ?? window_us),
    };
  });
  return all.sort((/** @type {Reading} */ a, /** @type {Reading} */ b) => a.fired - b.fired);
}

/** @param {number} share @returns {string} In percent, with as many digits as are worth reading. */
export function percent(share) {
  const value = 100 * share;
  if (value === 0) return "0 %";
  return `${value < 0.1 ? value.toFixed(2) : value.toFixed(1)} %`;
}

/** @param {any} run @returns {string} One sentence: the quality of its beliefs and their cost. */
export function sentenceOf(run) {
  const { summary, blind } = run;
  const wrong =
    summary.wrong_of_accepted === null
      ? "nothing is believed"
      : `${percent(summary.wrong_of_accepted)} of what it believes is wrong`;
  return `${wrong}; ${blind.length === 0 ? "no sensor is" : isAre(blind)} blind`;
}

/** @param {number[]} sensors @returns {string} "sensor 3 is" or "sensors 1, 2 and 8 are". */
function isAre(sensors) {
  const names = sensors.map((sensor) => String(sensor + 1));
  if (names.length === 1) return `sensor ${names[0]} is`;
  return `sensors ${names.slice(0, -1).join(", ")} and ${names[names.length - 1]} are`;
}

/** Words for causes other than the sensor's own echo. */
const FOREIGN = ["crosstalk", "stale", "external"];

/**
 * The senders that fool one sensor: the ways of foreign sound, the commonest first.
 * @param {any} run @param {number} sensor
 * @returns {{emitter: number, order: number, wrong: number, accepted: number, corners: [number, number][]}[]}
 */
export function foolersOf(run, sensor) {
  return run.fooled
    .filter((/** @type {any} */ one) => one.receiver.sensor === sensor && FOREIGN.includes(one.cause) && one.emitter)
    .map((/** @type {any} */ one) => ({
      emitter: one.emitter.sensor,
      order: one.order ?? 0,
      wrong: one.wrong,
      accepted: one.accepted,
      corners: run.paths[one.path]?.corners ?? [],
    }));
}

/** @param {any} run @param {number} sensor @returns {string} A sentence or two: who fools the sensor, and how often. */
export function foolersSentence(run, sensor) {
  const [readings, right, wrong] = run.tally[sensor];
  const believed =
    right + wrong === 0
      ? "nothing is ever believed"
      : `${right + wrong} are believed, ${wrong === 0 ? "none" : wrong} of them wrong`;
  const [first] = foolersOf(run, sensor).sort((a, b) => b.wrong - a.wrong);
  const who = first
    ? ` Most in the way is sensor ${first.emitter + 1}: its sound came first ${first.wrong} times, ${bounces(first.order)}, and was ${first.accepted === 0 ? "never believed" : `believed ${first.accepted} times`}.`
    : " No foreign sound comes before its own echo.";
  return `Of ${readings} readings ${believed}.${who}`;
}

/** @param {number} order */
function bounces(order) {
  if (order === 0) return "straight over";
  return order === 1 ? "by one bounce" : `by ${order} bounces`;
}
