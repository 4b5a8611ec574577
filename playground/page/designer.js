// @ts-check
/** Part two: your own ring, its shortest period, the proof and the certificate. */
import { readColours } from "./colours.js";
import { byId, element } from "./dom.js";
import { Cancelled } from "./engine.js";
import { LIMITS, MODULES } from "./state.js";
import { ringText } from "./texts.js";
import { drawTiming, inMs, pointedAt, saidAt, timingHeight } from "./timing.js";

/** The numbers of the form: the field of the state, its words, and the unit that is shown. */
const FIELDS = [
  { name: "sensors", label: "Sensors", unit: "", step: "1" },
  { name: "range", label: "They should see up to", unit: "m", step: "0.1" },
  { name: "crosstalk", label: "Neighbours hear each other off walls up to", unit: "m", step: "0.1" },
  { name: "speed", label: "The robot moves at up to", unit: "m/s", step: "0.1" },
  { name: "jitter", label: "A good reading varies by", unit: "µs", step: "10" },
  { name: "tick", label: "Firing times are multiples of", unit: "µs", step: "10" },
];

/** With more sensors than this a search takes a while, and the page shows a note. */
const FEW = 24;
const MANY =
  "So many sensors take a minute or two. “Stop” ends it; a robot that stands (0 m/s) and coarser firing times are quicker.";

export class Designer {
  /**
   * @param {{desk: import("./engine.js").Desk, state: () => import("./state.js").State,
   *   change: (patch: object) => void, designed: (answer: any) => void}} page
   */
  constructor(page) {
    this.page = page;
    /** @type {any} */
    this.answer = null;
    this.cursor = { at: 0, sensor: 0 };
    this.form = byId("ring-form", HTMLFormElement);
    this.module = byId("module", HTMLSelectElement);
    this.layout = byId("layout", HTMLSelectElement);
    this.go = byId("design-go", HTMLButtonElement);
    this.cancel = byId("design-cancel", HTMLButtonElement);
    this.says = byId("design-says", HTMLElement);
    this.result = byId("design-result", HTMLElement);
    this.canvas = byId("timing", HTMLCanvasElement);
    this.time = byId("timing-at", HTMLInputElement);
    this.lane = byId("timing-sensor", HTMLInputElement);
    this.read = byId("timing-read", HTMLElement);
    this.#buildForm();
    this.form.onsubmit = (event) => {
      event.preventDefault();
      this.design();
    };
    this.cancel.onclick = () => this.page.desk.cancel();
    this.canvas.onpointermove = (event) => this.#point(pointedAt(this.canvas, this.#timing(), event));
    this.time.oninput = () => this.#point({ ...this.cursor, at: Number(this.time.value) });
    this.lane.oninput = () => this.#point({ ...this.cursor, sensor: Number(this.lane.value) - 1 });
    byId("watch-own", HTMLButtonElement).onclick = () => this.#watch();
  }

  #buildForm() {
    for (const { id, name } of MODULES) this.module.append(element("option", { value: id }, name));
    /** @type {Record<string, HTMLInputElement>} */
    this.inputs = {};
    for (const { name, label, unit, step } of FIELDS) {
      const [least, most] = LIMITS[/** @type {keyof typeof LIMITS} */ (name)];
      const input = /** @type {HTMLInputElement} */ (
        element("input", {
          type: "number",
          id: `ring-${name}`,
          min: String(least),
          max: String(most),
          step,
          required: "",
          inputmode: "decimal",
        })
      );
      input.onchange = () => this.#take(name, input);
      this.inputs[name] = input;
      byId("ring-fields", HTMLElement).append(
        element("label", { for: `ring-${name}` }, label),
        element("span", { class: "field" }, input, unit),
      );
    }
    this.module.onchange = () => {
      const { range, jitter, crosstalk } = MODULES.find((module) => module.id === this.module.value) ?? MODULES[0];
      this.page.change({ module: this.module.value, range, jitter, crosstalk, own: null });
    };
    this.layout.onchange = () => this.page.change({ layout: this.layout.value, own: null });
  }

  /** @param {string} name @param {HTMLInputElement} input */
  #take(name, input) {
    const [least, most, unit] = LIMITS[/** @type {keyof typeof LIMITS} */ (name)];
    const value = Number(input.value);
    const wholes = name === "sensors" || name === "jitter" || name === "tick";
    if (
      input.value === "" ||
      !(value >= Number(least) && value <= Number(most)) ||
      (wholes && !Number.isInteger(value))
    ) {
      const label = FIELDS.find((field) => field.name === name)?.label;
      const given = input.value === "" ? "nothing" : input.value;
      this.#say(
        `${label}: ${given} is given; expected a ${wholes ? "whole " : ""}number from ${least} to ${most} ${unit}`,
        true,
      );
      input.setAttribute("aria-invalid", "true");
      return false;
    }
    input.removeAttribute("aria-invalid");
    this.#say("");
    if (value !== this.page.state()[/** @type {"sensors"} */ (name)]) {
      const { sensor } = this.page.state();
      const ring = name === "sensors" || name === "tick" || name === "range" || name === "crosstalk";
      this.page.change({
        [name]: value,
        ...(name === "sensors" ? { sensor: Math.min(sensor, value - 1) } : {}),
        ...(ring ? { own: null } : {}),
      });
    }
    return true;
  }

  /** @param {string} text @param {boolean} [bad] */
  #say(text, bad = false) {
    this.says.textContent = text;
    this.says.classList.toggle("bad", bad);
  }

  /** Shows the state in the form, and hides a result of another ring. */
  sync() {
    const state = this.page.state();
    this.module.value = state.module;
    this.layout.value = state.layout;
    for (const { name } of FIELDS) {
      const input = /** @type {Record<string, HTMLInputElement>} */ (this.inputs)[name];
      if (document.activeElement !== input && !input.hasAttribute("aria-invalid")) {
        input.value = String(state[/** @type {"sensors"} */ (name)]);
      }
    }
    if (this.answer && this.answer.ring !== ringText(state)) {
      this.answer = null;
      this.result.hidden = true;
      this.#say("The ring has changed: press the button for its period.");
    }
  }

  async design() {
    const valid = FIELDS.every(({ name }) =>
      this.#take(name, /** @type {Record<string, HTMLInputElement>} */ (this.inputs)[name]),
    );
    if (!valid) return;
    const { desk } = this.page;
    desk.cancel();
    const ring = ringText(this.page.state());
    this.go.disabled = true;
    this.cancel.hidden = false;
    this.result.hidden = true;
    this.answer = null;
    this.#say("Searching …");
    const many = this.page.state().sensors > FEW ? ` ${MANY}` : "";
    try {
      const answer = await desk.ask({ ask: "design", ring }, (_, nodes) =>
        this.#say(`Searching: ${nodes.toLocaleString("en")} cases so far …${many}`),
      );
      this.answer = { ...answer, ring };
      this.#show();
      this.page.designed(this.answer);
      this.#say("");
      await this.#find(ring);
      await this.#certify(ring);
    } catch (error) {
      const cancelled = error instanceof Cancelled;
      this.#say(cancelled ? "Stopped." : `${error instanceof Error ? error.message : error}`, !cancelled);
    } finally {
      this.go.disabled = false;
      this.cancel.hidden = true;
    }
  }

  /** Finds changes that would make the period shorter. @param {string} ring */
  async #find(ring) {
    const list = byId("faster", HTMLElement);
    const { value_us } = this.answer.found;
    list.replaceChildren(element("li", {}, "…"));
    /** @type {{need: string, period_us: number | null, proven: boolean}[]} */
    const all = await this.page.desk.ask({ ask: "faster", ring });
    const lines = all.map(({ need, period_us, proven }) => {
      const unknown = proven ? "no shorter" : "not found out";
      const shorter = period_us !== null && period_us < value_us;
      const verdict = shorter ? `${inMs(period_us)}${proven ? "" : " or less"}` : unknown;
      return element("li", {}, `${need}: `, element("strong", {}, verdict));
    });
    list.replaceChildren(...lines);
  }

  /** @param {string} ring */
  async #certify(ring) {
    const line = byId("certificate", HTMLElement);
    if (!this.answer.found.proven) {
      line.textContent = "";
      return;
    }
    line.textContent = "The certificate is being written …";
    try {
      const { says, nodes, text, checker } = await this.page.desk.ask({ ask: "certificate", ring });
      line.replaceChildren(
        `Certificate: ${says}, in ${nodes.toLocaleString("en")} cases. This page does not check it. Download `,
        this.#download("ring.certificate", text),
        " and the checker, which shares nothing with the search, ",
        this.#download("check_period.py", checker),
        ": ",
        element("code", {}, "python3 check_period.py ring.certificate"),
      );
    } catch (error) {
      line.textContent = `No certificate: ${error instanceof Error ? error.message : error}.`;
    }
  }

  /** @param {string} name @param {string} text @returns {HTMLElement} A link that saves the text as a file. */
  #download(name, text) {
    return element("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name }, name);
  }

  #show() {
    const { found } = this.answer;
    this.result.hidden = false;
    byId("period", HTMLElement).textContent = inMs(found.value_us);
    byId("proof", HTMLElement).textContent = found.proven
      ? `proven${found.from_atlas ? ", from the atlas" : ""}: no schedule with these guarantees is shorter`
      : `not proven: it may be as short as ${inMs(found.bound_us)}; eeruf design searches for longer`;
    byId("reason", HTMLElement).textContent = `Not shorter because of ${found.reason}.`;
    byId("facts", HTMLElement).replaceChildren(
      ...this.#facts().map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))),
    );
    this.cursor = { at: 0, sensor: 0 };
    this.time.max = String(2 * found.value_us);
    this.time.step = String(Math.max(1, Math.round(found.value_us / 500)));
    this.lane.max = String(this.answer.fire_us[0].length);
    this.#point(this.cursor);
  }

  /** @returns {[string, string][]} */
  #facts() {
    const {
      found,
      fire_us,
      window_us,
      range_m,
      speed_m_s,
      max_t_delta_us,
      t_delta_us,
      kept_interval_us,
      min_interval_us,
    } = this.answer;
    const rate = 1e6 / found.value_us;
    const sensors = fire_us[0].length;
    return [
      [
        "readings a second, each sensor",
        `${rate.toFixed(1)} (one by one: ${(1e6 / (window_us * sensors)).toFixed(1)})`,
      ],
      ["a sensor listens for", `${inMs(window_us)}, ${range_m.toFixed(2)} m`],
      [
        "good readings may differ by",
        `${max_t_delta_us === null ? "any amount" : inMs(max_t_delta_us)} (needed: ${inMs(t_delta_us)})`,
      ],
      [
        "neighbours fire apart by",
        kept_interval_us === null ? "any time" : `${inMs(kept_interval_us)} (needed: ${inMs(min_interval_us)})`,
      ],
      ["the robot may move at", max_t_delta_us === null ? "any speed" : `${speed_m_s.toFixed(2)} m/s`],
    ];
  }

  /** @returns {import("./timing.js").Timing} */
  #timing() {
    const { found, window_us, fire_us } = this.answer;
    return { period_us: found.value_us, window_us, fire_us };
  }

  /** @param {{at: number, sensor: number}} cursor */
  #point(cursor) {
    if (!this.answer) return;
    const last = this.answer.fire_us[0].length - 1;
    this.cursor = { at: cursor.at, sensor: Math.min(last, Math.max(0, cursor.sensor || 0)) };
    this.time.value = String(this.cursor.at);
    this.lane.value = String(this.cursor.sensor + 1);
    this.read.textContent = saidAt(this.#timing(), this.cursor.sensor, this.cursor.at);
    this.draw();
  }

  /** Redraws the diagram, as after a change of size or colours. */
  draw() {
    if (!this.answer || this.result.hidden) return;
    this.canvas.style.height = `${timingHeight(this.answer.fire_us[0].length) / 16}rem`;
    drawTiming(this.canvas, this.#timing(), this.cursor, readColours());
  }

  #watch() {
    const { found, fire_us, window_us, t_delta_us } = this.answer;
    const [a, b] = fire_us;
    this.page.change({ own: { period_us: found.value_us, a, b, t_delta_us, window_us } });
    document.getElementById("why")?.scrollIntoView();
  }
}
