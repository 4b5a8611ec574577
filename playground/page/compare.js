// @ts-check
/** Part one: the room, the methods side by side, and the clock that all pictures share. */
import { readColours } from "./colours.js";
import { byId } from "./dom.js";
import { Cancelled } from "./engine.js";
import { HandleLayer } from "./handles.js";
import { Panel } from "./panel.js";
import { inPageWords, sceneText } from "./texts.js";
import { boxOf } from "./view.js";

/** Number of the robot's periods that each method runs, and the number of them that are shown. */
const PERIODS = 400;
const SHOWN_PERIODS = 24;
/** The simulation begins when nothing has been dragged for this long. */
const SETTLED_MS = 160;
/** Progress is shown for tasks that take longer. */
const PATIENCE_MS = 400;
/** Number of drags whose median is printed. */
const KEPT_FRAMES = 200;

/** @typedef {import("./state.js").State} State */

export class Comparison {
  /**
   * @param {{quick: import("./engine.js").Desk, slow: import("./engine.js").Desk, methods: import("./methods.js").Method[],
   *   state: () => State, change: (state: State, final: boolean) => void}} page
   */
  constructor(page) {
    this.page = page;
    this.box = boxOf(page.state());
    /** @type {import("./draw-scene.js").Traced | null} */
    this.traced = null;
    this.scene = "";
    this.asked = 0;
    this.at = 0;
    this.playing = false;
    this.before = 0;
    /** @type {number[]} */
    this.frames = [];
    /** @type {Panel[]} */
    this.panels = [];
    this.row = byId("panels", HTMLElement);
    this.says = byId("room-says", HTMLElement);
    this.busy = byId("busy", HTMLElement);
    this.bar = byId("busy-bar", HTMLProgressElement);
    this.clock = byId("clock", HTMLInputElement);
    this.play = byId("play", HTMLButtonElement);
    this.handles = new HandleLayer({
      state: page.state,
      view: () => this.panels[0].view(this.box),
      change: page.change,
    });
    this.play.onclick = () => this.setPlaying(!this.playing);
    this.clock.oninput = () => {
      this.setPlaying(false);
      this.at = (Number(this.clock.value) / 1000) * this.until();
      this.draw();
    };
    byId("busy-cancel", HTMLButtonElement).onclick = () => this.page.slow.cancel();
    new ResizeObserver(() => this.draw()).observe(this.row);
  }

  /** @returns {{method: string, readings: import("./run.js").Reading[]}[]} The readings that the pictures show. */
  runs() {
    return this.panels.map(({ method, readings }) => ({ method, readings }));
  }

  /** @returns {number} Time in seconds up to which readings are shown. */
  until() {
    return SHOWN_PERIODS * 1e-6 * (this.traced?.period_us ?? 60_000);
  }

  /** @param {boolean} playing */
  setPlaying(playing) {
    if (this.playing === playing) return;
    this.playing = playing;
    this.play.textContent = playing ? "Pause" : "Play";
    if (playing) {
      this.before = performance.now();
      requestAnimationFrame((now) => this.#tick(now));
    }
  }

  /** @param {number} now */
  #tick(now) {
    if (!this.playing) return;
    const passed = Math.min(0.1, (now - this.before) / 1000);
    this.before = now;
    // While the room is dragged or computed again, nothing sounds.
    if (this.panels.some((panel) => panel.run)) this.at += passed / this.page.state().slow;
    if (this.at > this.until()) this.at = 0;
    this.draw();
    requestAnimationFrame((then) => this.#tick(then));
  }

  /** Brings the pictures to the state. @param {boolean} [refit] Whether the view may move. */
  sync(refit = true) {
    const state = this.page.state();
    this.#syncPanels(state);
    if (refit && !this.handles.dragging) this.box = boxOf(state);
    const scene = sceneText(state);
    if (scene !== this.scene) {
      this.scene = scene;
      for (const panel of this.panels) panel.clear();
      this.at = 0;
      this.#trace(scene);
    } else {
      this.draw();
    }
    for (const panel of this.panels) panel.describe(state.sensor);
    this.handles.place();
    if (!this.handles.dragging && this.panels.some((panel) => !panel.run)) this.#runSoon();
  }

  /** @param {State} state */
  #syncPanels(state) {
    const { page } = this;
    while (this.panels.length > state.shown.length) this.panels.pop()?.root.remove();
    state.shown.forEach((method, k) => {
      if (!this.panels[k]) {
        const panel = new Panel(page.methods, method, {
          onMethod: (id) =>
            page.change({ ...page.state(), shown: page.state().shown.map((one, n) => (n === k ? id : one)) }, true),
          onRemove: () => page.change({ ...page.state(), shown: page.state().shown.filter((_, n) => n !== k) }, true),
          onSensor: (sensor) => page.change({ ...page.state(), sensor }, true),
        });
        this.panels.push(panel);
        this.row.append(panel.root);
      } else if (this.panels[k].method !== method) {
        this.panels[k].setMethod(method);
      }
      this.panels[k].remove.hidden = state.shown.length < 2;
    });
    // Only if it is elsewhere: an element that is moved loses the focus.
    if (this.handles.root.parentElement !== this.panels[0].stage) this.panels[0].stage.append(this.handles.root);
  }

  /** @param {string} scene */
  async #trace(scene) {
    const began = performance.now();
    try {
      const traced = await this.page.quick.askLatest({ ask: "trace", scene });
      if (scene !== this.scene && !this.handles.dragging) return;
      this.traced = traced;
      this.#say("");
    } catch (error) {
      if (error instanceof Cancelled || scene !== this.scene) return;
      const sentence = error instanceof Error ? error.message : String(error);
      this.#say(inPageWords(sentence, this.page.state()), true);
    }
    this.draw();
    if (!this.handles.dragging) return;
    this.frames.push(performance.now() - began);
    if (this.frames.length > KEPT_FRAMES) this.frames.shift();
    this.#sayFrames();
  }

  /** @returns {number} Time from a change to its picture, in milliseconds: the median of the last ones. */
  frameMs() {
    const sorted = [...this.frames].sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)] ?? NaN;
  }

  #sayFrames() {
    byId("frame", HTMLElement).textContent =
      `Tracing and drawing a change took ${this.frameMs().toFixed(1)} ms (median of the last ${this.frames.length}).`;
  }

  /** @param {string} text @param {boolean} [bad] */
  #say(text, bad = false) {
    const sentence = bad ? `${text.charAt(0).toUpperCase()}${text.slice(1)}.` : text;
    if (this.says.textContent !== sentence) this.says.textContent = sentence;
    this.says.classList.toggle("bad", bad);
  }

  #runSoon() {
    const asked = ++this.asked;
    this.page.slow.cancel();
    setTimeout(() => {
      if (asked === this.asked && !this.handles.dragging) this.#run(asked);
    }, SETTLED_MS);
  }

  /** @param {number} asked */
  async #run(asked) {
    const scene = this.scene;
    const window_us = this.traced?.window_us ?? 36_000;
    const due = this.panels.filter((panel) => !panel.run);
    const patience = setTimeout(() => {
      this.busy.hidden = false;
    }, PATIENCE_MS);
    for (const [k, panel] of due.entries()) {
      const question = { ask: "run", scene, method: panel.method, periods: PERIODS, shown_s: this.until() };
      try {
        const run = await this.page.slow.ask(question, (share) => {
          if (asked !== this.asked) return;
          if (Number.isNaN(share)) this.bar.removeAttribute("value");
          else this.bar.value = (k + share) / due.length;
        });
        if (asked !== this.asked) break;
        panel.show(run, window_us);
      } catch (error) {
        if (asked !== this.asked) break;
        if (error instanceof Cancelled) {
          this.#say("The simulation was stopped; change something to begin again");
          break;
        }
        const sentence = error instanceof Error ? error.message : String(error);
        panel.refuse(inPageWords(sentence, this.page.state()));
      }
      panel.describe(this.page.state().sensor);
      this.draw();
    }
    clearTimeout(patience);
    if (asked === this.asked) {
      this.busy.hidden = true;
      if (!this.playing && this.at === 0) this.at = this.until();
      this.draw();
      document.dispatchEvent(new CustomEvent("ran"));
    }
  }

  draw() {
    if (this.panels.length === 0) return;
    const colours = readColours();
    const state = this.page.state();
    const until = this.until();
    for (const panel of this.panels) {
      panel.draw({ state, box: this.box, traced: this.traced, at: this.at, until, colours });
    }
    this.handles.place();
    if (document.activeElement !== this.clock || this.playing)
      this.clock.value = String(Math.round((1000 * this.at) / until));
    this.clock.setAttribute("aria-valuetext", `${(1000 * this.at).toFixed(0)} ms of ${(1000 * until).toFixed(0)} ms`);
  }
}
