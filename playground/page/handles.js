// @ts-check
/**
 * Handles of things that can be dragged in the room: corners of walls, whole walls, poles, the robot and its heading.
 * Each is a button on top of the picture: arrow keys move it, Delete removes a wall or pole.
 */
import { element } from "./dom.js";
import { toMillimetre } from "./state.js";

/** @typedef {import("./state.js").State} State */
/**
 * @typedef {object} Handle
 * @property {string} kind The class of its button.
 * @property {string} name Its description for screen readers.
 * @property {number} x
 * @property {number} y
 * @property {(state: State, x: number, y: number) => void} move Changes a copy of the state.
 * @property {(state: State) => void} [remove]
 */

const STEP_M = 0.02;
const LONG_STEP_M = 0.1;
/** A corner that is dropped this near to another becomes one with it. */
const SNAP_M = 0.04;

/** @param {State} state @returns {Handle[]} */
export function handlesOf(state) {
  /** @type {Handle[]} */
  const handles = [];
  const seen = new Set();
  state.walls.forEach((wall, w) => {
    wall.forEach(([x, y], k) => {
      const key = `${x},${y}`;
      if (seen.has(key)) return;
      seen.add(key);
      handles.push({
        kind: "corner",
        name: `Wall ${w + 1}, corner ${k + 1}`,
        x,
        y,
        move: (copy, toX, toY) => moveCorners(copy, [x, y], [toX, toY]),
        remove: (copy) => removeCorner(copy, [x, y]),
      });
    });
    const [[x0, y0], [x1, y1]] = wall;
    const middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    handles.push({
      kind: "wall",
      name: `Wall ${w + 1}`,
      x: middle[0],
      y: middle[1],
      move: (copy, toX, toY) => {
        copy.walls[w] = wall.map(([x, y]) => [toMillimetre(x + toX - middle[0]), toMillimetre(y + toY - middle[1])]);
      },
      remove: (copy) => copy.walls.splice(w, 1),
    });
  });
  state.poles.forEach(([x, y, radius], p) => {
    handles.push({
      kind: "pole",
      name: `Pole ${p + 1}`,
      x,
      y,
      move: (copy, toX, toY) => {
        copy.poles[p] = [toMillimetre(toX), toMillimetre(toY), radius];
      },
      remove: (copy) => copy.poles.splice(p, 1),
    });
  });
  const { robot, radius } = state;
  handles.push({
    kind: "robot",
    name: "Robot",
    x: robot.x,
    y: robot.y,
    move: (copy, toX, toY) => {
      copy.robot.x = toMillimetre(toX);
      copy.robot.y = toMillimetre(toY);
    },
  });
  const turn = (robot.heading * Math.PI) / 180;
  const arm = 0.45 * radius;
  handles.push({
    kind: "heading",
    name: "Heading of the robot",
    x: robot.x + arm * Math.cos(turn),
    y: robot.y + arm * Math.sin(turn),
    move: (copy, toX, toY) => {
      const heading = (Math.atan2(toY - robot.y, toX - robot.x) * 180) / Math.PI;
      copy.robot.heading = Math.round(10 * heading) / 10;
    },
  });
  return handles;
}

/** @param {State} state @param {[number, number]} from @param {[number, number]} to All corners there go together. */
function moveCorners(state, from, to) {
  let [x, y] = [toMillimetre(to[0]), toMillimetre(to[1])];
  const others = state.walls.flat().filter(([cx, cy]) => cx !== from[0] || cy !== from[1]);
  const near = others.find(([cx, cy]) => Math.hypot(cx - x, cy - y) < SNAP_M);
  if (near) [x, y] = near;
  for (const wall of state.walls) {
    wall.forEach(([cx, cy], k) => {
      if (cx === from[0] && cy === from[1]) wall[k] = [x, y];
    });
  }
}

/** @param {State} state @param {[number, number]} at */
function removeCorner(state, at) {
  state.walls = state.walls.map((wall) => wall.filter(([x, y]) => x !== at[0] || y !== at[1]));
  state.walls = state.walls.filter((wall) => wall.length >= 2);
}

/** The layer of buttons on top of a picture. */
export class HandleLayer {
  /**
   * @param {{state: () => State, view: () => import("./view.js").View, change: (state: State, final: boolean) => void}} page
   *   `change` is called while dragging, and once more with `final` at its end.
   */
  constructor(page) {
    this.page = page;
    this.root = element("div", { class: "handles" });
    /** @type {HTMLElement[]} */
    this.buttons = [];
    /** @type {Handle[]} */
    this.handles = [];
    this.dragging = false;
  }

  /** Puts the buttons onto their things. */
  place() {
    const state = this.page.state();
    this.handles = handlesOf(state);
    while (this.buttons.length > this.handles.length) this.buttons.pop()?.remove();
    while (this.buttons.length < this.handles.length) this.#add();
    const view = this.page.view();
    this.handles.forEach((handle, k) => {
      const button = this.buttons[k];
      const at = view.px(handle.x, handle.y);
      button.className = `handle ${handle.kind}`;
      button.style.translate = `${at.x}px ${at.y}px`;
      const heading =
        handle.kind === "heading"
          ? `${state.robot.heading} degrees`
          : `x ${handle.x.toFixed(2)} m, y ${handle.y.toFixed(2)} m`;
      button.setAttribute("aria-label", `${handle.name}, ${heading}`);
    });
  }

  #add() {
    const button = element("button", { type: "button", "aria-roledescription": "movable by arrow keys" });
    const index = this.buttons.length;
    button.onpointerdown = (event) => this.#drag(button, index, event);
    button.onkeydown = (event) => this.#key(index, event);
    this.buttons.push(button);
    this.root.append(button);
  }

  /** @param {HTMLElement} button @param {number} index @param {PointerEvent} event */
  #drag(button, index, event) {
    if (event.button !== 0 || this.dragging) return;
    const handle = this.handles[index];
    const before = this.page.state();
    const view = this.page.view();
    const frame = this.root.getBoundingClientRect();
    const spot = (/** @type {PointerEvent} */ at) => ({ x: at.clientX - frame.left, y: at.clientY - frame.top });
    const grab = view.metres(spot(event));
    const off = { x: handle.x - grab.x, y: handle.y - grab.y };
    this.dragging = true;
    button.setPointerCapture(event.pointerId);
    const moved = (/** @type {PointerEvent} */ at, /** @type {boolean} */ final) => {
      const to = view.metres(spot(at));
      this.#change(before, (copy) => handle.move(copy, to.x + off.x, to.y + off.y), final);
    };
    // Listen on the window: the button disappears with the thing that it moves.
    const listening = new AbortController();
    const on = (/** @type {"pointermove" | "pointerup" | "pointercancel"} */ name, /** @type {boolean} */ final) =>
      addEventListener(
        name,
        (at) => {
          if (at.pointerId !== event.pointerId) return;
          if (final) {
            listening.abort();
            this.dragging = false;
          }
          moved(at, final);
        },
        { signal: listening.signal },
      );
    on("pointermove", false);
    on("pointerup", true);
    on("pointercancel", true);
  }

  /** @param {number} index @param {KeyboardEvent} event */
  #key(index, event) {
    const handle = handlesOf(this.page.state())[index];
    if (!handle) return;
    const step = event.shiftKey ? LONG_STEP_M : STEP_M;
    /** @type {Record<string, [number, number]>} */
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const way = ways[event.key];
    if (way) {
      event.preventDefault();
      const change =
        handle.kind === "heading"
          ? turn(way, event.shiftKey)
          : (/** @type {State} */ copy) => handle.move(copy, handle.x + step * way[0], handle.y + step * way[1]);
      this.#change(this.page.state(), change, true);
    } else if (handle.remove && (event.key === "Delete" || event.key === "Backspace")) {
      event.preventDefault();
      this.#change(this.page.state(), handle.remove, true);
    }
  }

  /** @param {State} before @param {(copy: State) => void} change @param {boolean} final */
  #change(before, change, final) {
    const copy = structuredClone(before);
    change(copy);
    this.page.change(copy, final);
  }
}

/** @param {[number, number]} way @param {boolean} far @returns {(copy: State) => void} */
function turn([x, y], far) {
  const degrees = (far ? 10 : 2) * (y - x);
  return (copy) => {
    copy.robot.heading = Math.round(10 * (((copy.robot.heading + degrees + 540) % 360) - 180)) / 10;
  };
}
