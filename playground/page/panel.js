// @ts-check
/** One method at work: the room with its sound, its figures, and the readings of the selected sensor. */
import { drawChart } from "./chart.js";
import { element } from "./dom.js";
import { drawFoolers, drawRobot, drawRoom, drawWays } from "./draw-scene.js";
import { drawBeliefs, drawSound } from "./draw-sound.js";
import { foolersOf, foolersSentence, percent, readingsOf, sentenceOf } from "./run.js";
import { View, contextOf } from "./view.js";

/** Largest distance of a press that chooses a sensor, in pixels. */
const NEAR_PX = 26;

/**
 * @typedef {object} Moment The contents of the pictures at a moment.
 * @property {import("./state.js").State} state
 * @property {import("./view.js").Box} box
 * @property {import("./draw-scene.js").Traced | null} traced
 * @property {number} at Simulated time in seconds.
 * @property {number} until Time up to which readings are shown.
 * @property {import("./colours.js").Colours} colours
 */

export class Panel {
  /**
   * @param {import("./methods.js").Method[]} methods
   * @param {string} method
   * @param {{onMethod: (method: string) => void, onRemove: () => void, onSensor: (sensor: number) => void}} when
   */
  constructor(methods, method, when) {
    this.methods = methods;
    this.method = method;
    /** @type {import("./run.js").Reading[]} */
    this.readings = [];
    /** @type {any} */
    this.run = null;
    /** @type {Moment | null} */
    this.last = null;
    this.select = /** @type {HTMLSelectElement} */ (element("select", { "aria-label": "Firing method" }));
    for (const one of methods) this.select.append(element("option", { value: one.id }, one.name));
    this.select.onchange = () => when.onMethod(this.select.value);
    this.remove = element("button", { type: "button", class: "quiet", "aria-label": "Take this method away" }, "✕");
    this.remove.onclick = when.onRemove;
    this.does = element("p", { class: "does" });
    this.canvas = /** @type {HTMLCanvasElement} */ (element("canvas", { class: "room", role: "img" }));
    this.stage = element("div", { class: "stage" }, this.canvas);
    this.verdict = element("p", { class: "verdict" });
    this.figures = element("dl", { class: "figures" });
    this.title = element("h3");
    this.foolers = element("p", { class: "foolers" });
    this.chart = /** @type {HTMLCanvasElement} */ (element("canvas", { class: "chart", role: "img" }));
    this.root = element(
      "article",
      { class: "panel" },
      element("header", {}, this.select, this.remove),
      this.does,
      this.stage,
      this.verdict,
      this.figures,
      this.title,
      this.chart,
      this.foolers,
    );
    this.canvas.onclick = (event) => {
      const sensor = this.#sensorAt(event);
      if (sensor !== null) when.onSensor(sensor);
    };
    this.setMethod(method);
  }

  /** @param {string} method */
  setMethod(method) {
    this.method = method;
    this.select.value = method;
    this.does.textContent = this.methods.find((one) => one.id === method)?.does ?? "";
    this.clear();
  }

  /** Forgets the readings, because the room has changed. */
  clear() {
    this.run = null;
    this.readings = [];
    this.root.classList.add("stale");
  }

  /** @param {any} run The engine's answer. @param {number} window_us */
  show(run, window_us) {
    this.run = run;
    this.readings = readingsOf(run, window_us);
    this.root.classList.remove("stale");
    const { summary, blind, tally } = run;
    this.verdict.textContent = capital(`${sentenceOf(run)}.`);
    this.verdict.classList.toggle("bad", (summary.wrong_of_accepted ?? 0) > 0.05);
    const figures = [
      ["wrong of believed", summary.wrong_of_accepted === null ? "–" : percent(summary.wrong_of_accepted)],
      ["not believed", percent(summary.rejected)],
      ["good ones lost", summary.good_lost === null ? "–" : percent(summary.good_lost)],
      ["blind", `${blind.length} of ${tally.length}`],
      ["believed a second", summary.readings_per_s.toFixed(1)],
    ];
    this.figures.replaceChildren(
      ...figures.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))),
    );
  }

  /** @param {string} sentence The reason why the method does not run. */
  refuse(sentence) {
    this.clear();
    this.root.classList.remove("stale");
    this.verdict.textContent = `This method cannot run here: ${sentence}.`;
    this.figures.replaceChildren();
  }

  /** @param {Moment} moment */
  draw(moment) {
    this.last = moment;
    const { state, box, traced, at, until, colours } = moment;
    const { context, width, height } = contextOf(this.canvas);
    const view = new View(box, width, height);
    drawRoom(context, view, state, colours);
    if (traced) {
      if (this.run) drawFoolers(context, view, foolersOf(this.run, state.sensor), colours);
      else drawWays(context, view, traced, state.sensor, colours);
      drawRobot(context, view, traced, { sensor: state.sensor, blind: this.run?.blind ?? [] }, colours);
      const sound = { traced, readings: this.readings, at };
      drawSound(context, view, sound, colours);
      drawBeliefs(context, view, sound, colours);
    }
    const own = this.readings.filter((reading) => reading.sensor === state.sensor);
    const chart = contextOf(this.chart);
    const farthest = this.#farthest(own, traced);
    const frame = { width: chart.width, height: chart.height, until, farthest };
    drawChart(chart.context, frame, { readings: own, sound_m_s: traced?.sound_m_s ?? 343, at }, colours);
  }

  /** Describes the pictures in words for screen readers. @param {number} sensor */
  describe(sensor) {
    this.foolers.textContent = this.run ? foolersSentence(this.run, sensor) : "";
    this.title.textContent = `What sensor ${sensor + 1} reads`;
    const name = this.methods.find((one) => one.id === this.method)?.name;
    this.canvas.setAttribute("aria-label", `The room under the method ${name}. ${this.verdict.textContent}`);
    this.chart.setAttribute(
      "aria-label",
      `Range over time as sensor ${sensor + 1} reads it under ${name}. ${this.foolers.textContent}`,
    );
  }

  /** Positions of things on the page, in its pixels. @param {import("./view.js").Box} box */
  view(box) {
    return new View(box, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  /** @param {import("./run.js").Reading[]} own @param {import("./draw-scene.js").Traced | null} traced */
  #farthest(own, traced) {
    const us = own.flatMap((reading) => [reading.t_echo_us ?? 0, reading.reference_us ?? 0]);
    return Math.max(0.5, 1.15 * 0.5e-6 * Math.max(0, ...us) * (traced?.sound_m_s ?? 343));
  }

  /** @param {MouseEvent} event @returns {number | null} */
  #sensorAt(event) {
    if (!this.last?.traced) return null;
    const view = this.view(this.last.box);
    const near = this.last.traced.sensors.map(([x, y], k) => {
      const at = view.px(x, y);
      return { k, far: Math.hypot(at.x - event.offsetX, at.y - event.offsetY) };
    });
    near.sort((a, b) => a.far - b.far);
    return near.length > 0 && near[0].far < NEAR_PX ? near[0].k : null;
  }
}

/** @param {string} text */
function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
