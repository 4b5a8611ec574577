// @ts-check
/** Part four: a pasted log, the answer of `eeruf logs`, and its ranges over time. */
import { gridStep } from "./chart.js";
import { readColours, sensorColour } from "./colours.js";
import { byId, element } from "./dom.js";
import { Cancelled, Refused } from "./engine.js";
import { contextOf } from "./view.js";

/** @typedef {{name: string, is_concerned: boolean, readings: number, points: [number, number][]}} Sensor */
/** @typedef {{verdict: string, answer: string, form: string, sensors: Sensor[], guesses: string[], damage: string[],
 *   is_timed: boolean}} Pasted */

/** Largest number of letters; a longer log is a file for the program. */
const MOST = 1 << 20;

export class Paste {
  /** @param {import("./engine.js").Desk} desk */
  constructor(desk) {
    this.desk = desk;
    /** @type {Pasted | null} */
    this.found = null;
    this.text = byId("paste-text", HTMLTextAreaElement);
    this.says = byId("paste-says", HTMLElement);
    this.canvas = byId("paste-chart", HTMLCanvasElement);
    byId("paste-go", HTMLButtonElement).onclick = () => this.#look();
  }

  async #look() {
    const text = this.text.value;
    byId("paste-result", HTMLElement).hidden = true;
    this.found = null;
    if (text.trim() === "") {
      this.says.textContent = "Nothing is pasted yet.";
      return;
    }
    if (text.length > MOST) {
      this.says.textContent = "That is more than 1 MB; the program reads it: eeruf logs FILE.";
      return;
    }
    this.says.textContent = "Reading …";
    try {
      this.#show(await this.desk.askLatest({ ask: "paste", text }));
    } catch (error) {
      if (error instanceof Cancelled) return;
      if (!(error instanceof Refused)) throw error;
      this.says.textContent = error.message;
    }
  }

  /** @param {Pasted} found */
  #show(found) {
    this.found = found;
    const [first, ...lines] = found.answer.split("\n");
    const readings = found.sensors.reduce((sum, sensor) => sum + sensor.readings, 0);
    this.says.textContent = `Read as ${found.form}: ${readings} readings of ${found.sensors.length} sensors.`;
    byId("paste-answer", HTMLElement).textContent = first;
    const list = (/** @type {string} */ id, /** @type {string[]} */ texts) =>
      byId(id, HTMLElement).replaceChildren(...texts.map((text) => element("li", {}, text)));
    list(
      "paste-steps",
      lines.map((line) => line[0].toUpperCase() + line.slice(1)),
    );
    list("paste-guesses", [...found.guesses.map((guess) => `Guessed ${guess}`), ...found.damage]);
    list(
      "paste-sensors",
      found.sensors.map(({ name, is_concerned }) => `${name}${is_concerned ? " (may be fooled)" : ""}`),
    );
    byId("paste-result", HTMLElement).hidden = false;
    this.draw();
  }

  /** Draws ranges over time; sensors that may be fooled have larger marks. */
  draw() {
    if (!this.found || this.found.sensors.length === 0) return;
    const { sensors, is_timed } = this.found;
    const { context, width, height } = contextOf(this.canvas);
    const colours = readColours();
    const points = sensors.flatMap((sensor) => sensor.points);
    const until = points.reduce((most, [at]) => Math.max(most, at), 1e-3);
    const farthest = points.reduce((most, [, range]) => Math.max(most, range), 0.1);
    const x = (/** @type {number} */ at) => 38 + (at / until) * (width - 46);
    const y = (/** @type {number} */ range) => height - 20 - (range / farthest) * (height - 28);
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = colours.muted;
    context.textAlign = "right";
    for (let m = 0; m <= farthest; m += gridStep(farthest, 3)) context.fillText(`${Number(m.toFixed(2))} m`, 33, y(m) + 4);
    context.textAlign = "center";
    for (let at = 0; at <= until; at += gridStep(until, 5))
      context.fillText(`${Number(at.toFixed(2))}${is_timed ? " s" : ""}`, Math.min(x(at), width - 20), height - 5);
    sensors.forEach((sensor, index) => {
      context.fillStyle = sensorColour(colours, index);
      const size = sensor.is_concerned ? 4 : 2;
      for (const [at, range] of sensor.points) context.fillRect(x(at) - size / 2, y(range) - size / 2, size, size);
    });
    [...byId("paste-sensors", HTMLElement).children].forEach((item, index) => {
      /** @type {HTMLElement} */ (item).style.borderInlineStart = `0.8em solid ${sensorColour(colours, index)}`;
    });
    this.canvas.setAttribute(
      "aria-label",
      `Ranges of ${sensors.map((sensor) => sensor.name).join(", ")} up to ${farthest.toFixed(2)} m.`,
    );
  }
}
