// @ts-check
/** The page: one state, and the three parts that show it. */
import { Comparison } from "./compare.js";
import { byId, element, wantsLittleMotion } from "./dom.js";
import { Designer } from "./designer.js";
import { Desk, openDesks } from "./engine.js";
import { Lesson } from "./lesson.js";
import { fromHash, toHash } from "./link.js";
import { methodsOf } from "./methods.js";
import { Paste } from "./paste.js";
import { ROOMS, StateError, checkedState, firstState } from "./state.js";
import { TakeHome } from "./take-home.js";

/** @typedef {import("./state.js").State} State */

const MAX_SHOWN = 4;

/** @returns {State} The state in the link, or the first state and a sentence that says why. */
function stateFromLink() {
  try {
    return fromHash(location.hash) ?? firstState();
  } catch (error) {
    if (!(error instanceof StateError)) throw error;
    say(`${error.message}. Shown is the first example instead.`);
    return firstState();
  }
}

/** @param {string} text */
function say(text) {
  byId("page-says", HTMLElement).textContent = text;
}

async function start() {
  let state = stateFromLink();
  const { quick, slow } = openDesks();
  const searches = new Desk(quick.compiled);
  const methods = methodsOf(await quick.ask({ ask: "methods" }));
  const known = (/** @type {State} */ given) => {
    const shown = given.shown.filter((id) => methods.some((method) => method.id === id));
    return shown.length > 0 ? { ...given, shown } : { ...given, shown: firstState().shown };
  };
  state = known(state);

  /** @param {State} next @param {boolean} final */
  const change = (next, final) => {
    try {
      state = known(checkedState(next));
      say("");
    } catch (error) {
      if (!(error instanceof StateError)) throw error;
      say(`${error.message}.`);
      // Take back what was dragged.
      if (final) comparison.sync();
      return;
    }
    comparison.sync(final);
    if (final) sync();
  };
  const comparison = new Comparison({ quick, slow, methods, state: () => state, change });
  const takeHome = new TakeHome({ state: () => state, link: () => location.href, runs: () => comparison.runs() });
  const designer = new Designer({
    desk: searches,
    state: () => state,
    designed: (answer) => takeHome.show(answer),
    change: (patch) => change({ ...state, .../** @type {Partial<State>} */ (patch) }, true),
  });
  const paste = new Paste(new Desk(quick.compiled));
  new Lesson({ state: () => state, change, play: () => comparison.setPlaying(true) });

  /** Updates everything but the pictures. */
  function sync() {
    history.replaceState(null, "", `#${toHash(state)}`);
    designer.sync();
    if (!designer.answer && takeHome.designed) takeHome.show(null);
    else takeHome.sync();
    byId("slow", HTMLInputElement).value = String(Math.round(100 * Math.log10(state.slow)));
    byId("slow-says", HTMLElement).textContent = `${Math.round(state.slow)} times slower than real`;
    const sensor = byId("look", HTMLInputElement);
    sensor.max = String(state.sensors);
    if (document.activeElement !== sensor) sensor.value = String(state.sensor + 1);
    byId("add-method", HTMLButtonElement).disabled = state.shown.length >= Math.min(MAX_SHOWN, methods.length);
    byId("own-says", HTMLElement).hidden = state.own === null;
    byId("rooms", HTMLSelectElement).value = roomOf(state);
  }

  tools(() => state, change, methods);
  addEventListener("hashchange", () => {
    // Links to parts of the page hold no state; the present one stays.
    if (location.hash.includes("s=")) state = known(stateFromLink());
    comparison.sync();
    sync();
  });
  for (const query of ["(prefers-color-scheme: dark)", "(prefers-contrast: more)"]) {
    matchMedia(query).addEventListener("change", () => {
      comparison.draw();
      designer.draw();
      paste.draw();
    });
  }
  byId("theme", HTMLButtonElement).onclick = () => {
    const dark = getComputedStyle(document.documentElement).getPropertyValue("--scheme").trim() === "dark";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
    comparison.draw();
    designer.draw();
    paste.draw();
  };
  new ResizeObserver(() => designer.draw()).observe(byId("design-result", HTMLElement));
  new ResizeObserver(() => paste.draw()).observe(byId("paste-result", HTMLElement));
  sync();
  comparison.sync();
  if (!wantsLittleMotion()) comparison.setPlaying(true);
}

/**
 * The tools above the pictures.
 * @param {() => State} state @param {(state: State, final: boolean) => void} change
 * @param {import("./methods.js").Method[]} methods
 */
function tools(state, change, methods) {
  const rooms = byId("rooms", HTMLSelectElement);
  rooms.append(...Object.entries(ROOMS).map(([id, room]) => element("option", { value: id }, room.name)));
  rooms.onchange = () => {
    const room = ROOMS[rooms.value];
    if (room)
      change({ ...state(), ...structuredClone({ walls: room.walls, poles: room.poles, robot: room.robot }) }, true);
    else rooms.value = roomOf(state());
  };
  byId("add-wall", HTMLButtonElement).onclick = () => {
    const { robot, walls } = state();
    const [x, y] = freeSpot(state());
    change(
      {
        ...state(),
        walls: [
          ...walls,
          [
            [x - 0.25, y],
            [x + 0.25, y],
          ],
        ],
        robot,
      },
      true,
    );
  };
  byId("add-pole", HTMLButtonElement).onclick = () => {
    const [x, y] = freeSpot(state());
    change({ ...state(), poles: [...state().poles, [x, y, 0.03]] }, true);
  };
  byId("add-method", HTMLButtonElement).onclick = () => {
    const { shown } = state();
    const next =
      methods.find((method) => method.byDefault && !shown.includes(method.id)) ??
      methods.find((method) => !shown.includes(method.id));
    if (next) change({ ...state(), shown: [...shown, next.id] }, true);
  };
  byId("slow", HTMLInputElement).oninput = (event) => {
    const value = Number(/** @type {HTMLInputElement} */ (event.target).value);
    change({ ...state(), slow: Math.round(10 ** (value / 100)) }, true);
  };
  byId("look", HTMLInputElement).oninput = (event) => {
    const value = Number(/** @type {HTMLInputElement} */ (event.target).value) - 1;
    if (Number.isInteger(value) && value >= 0 && value < state().sensors) change({ ...state(), sensor: value }, true);
  };
  byId("forget-own", HTMLButtonElement).onclick = () => change({ ...state(), own: null }, true);
  byId("reset", HTMLButtonElement).onclick = () => change(firstState(), true);
}

/** @param {State} state @returns {string} The room of the menu with these walls and poles; empty for one's own. */
function roomOf({ walls, poles }) {
  const seen = JSON.stringify([walls, poles]);
  return Object.keys(ROOMS).find((id) => JSON.stringify([ROOMS[id].walls, ROOMS[id].poles]) === seen) ?? "";
}

/** @param {State} state @returns {[number, number]} A free place beside or in front of the robot. */
function freeSpot({ robot, radius, walls, poles }) {
  const points = [...walls.flat(), ...poles.map(([x, y]) => [x, y])];
  let best = { far: -1, at: /** @type {[number, number]} */ ([robot.x + radius + 0.4, robot.y]) };
  for (let k = 0; k < 24; k++) {
    const turn = (k * Math.PI) / 12;
    for (const reach of [0.3, 0.5]) {
      const [x, y] = [robot.x + (radius + reach) * Math.cos(turn), robot.y + (radius + reach) * Math.sin(turn)];
      const far = Math.min(2, ...points.map(([px, py]) => Math.hypot(px - x, py - y)));
      if (far > best.far) best = { far, at: [Math.round(100 * x) / 100, Math.round(100 * y) / 100] };
    }
  }
  return best.at;
}

start().catch((error) => {
  say(`The page could not start: ${error instanceof Error ? error.message : error}.`);
});
