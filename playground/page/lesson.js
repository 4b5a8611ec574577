// @ts-check
/** A lesson in seven steps that moves the scene by itself, for a lecture or a single reader. */
import { byId, wantsLittleMotion } from "./dom.js";
import { ROOMS, firstState } from "./state.js";

/** @typedef {import("./state.js").State} State */
/** @typedef {{title: string, text: string, state: Partial<State>}} Step */

const WALL = { walls: ROOMS.wall.walls, poles: ROOMS.wall.poles };
const ALCOVE = { walls: ROOMS.alcove.walls, poles: ROOMS.alcove.poles, robot: ROOMS.alcove.robot, sensor: 0 };

/** @type {Step[]} */
const STEPS = [
  {
    title: "An echo is a distance",
    text: "A sensor sends a chirp and waits. The wall sends it back, and half of the time that it took is the distance. The dot on the sensor's axis is what the robot believes.",
    state: { ...WALL, robot: { x: 0, y: 0, heading: 90 }, sensors: 1, sensor: 0, shown: ["sequential"], slow: 25 },
  },
  {
    title: "Eight sensors, one by one",
    text: "Each sensor waits until the one before has listened to the end. Nobody is fooled, but a round takes 288 ms: a robot at 1 m/s has gone nearly 30 cm before the same sensor looks again.",
    state: { ...ALCOVE, sensors: 8, shown: ["sequential"], slow: 25 },
  },
  {
    title: "Fired together, they fool each other",
    text: "Now all eight fire within 60 ms, neighbours a little apart. A sensor cannot tell whose sound it hears: where a neighbour's sound arrives first, it takes it for its own echo. Look at sensor 1, and at the way by which it is fooled. Red triangles are false distances that the robot believes.",
    state: { ...ALCOVE, sensors: 8, shown: ["conventional"], slow: 25 },
  },
  {
    title: "Crosstalk repeats as well as the truth",
    text: "Could one compare each reading with the one before? Every period is like the last, so the foreign sound comes at the same moment again. In the second picture only readings that repeat are believed, and it hardly helps: sensor 1 reads the same false distance again and again.",
    state: { ...ALCOVE, sensors: 8, shown: ["conventional", "comparison"], slow: 25 },
  },
  {
    title: "Let the waits alternate, and reject what moves",
    text: "Now every sensor waits a little before it fires, and the wait alternates between two values that differ from sensor to sensor. A sensor's own echo does not care. Foreign sound jumps to and fro, does not repeat, and is rejected: see the crosses that sensor 1 gets below the second picture.",
    state: { ...ALCOVE, sensors: 8, shown: ["comparison", "eeruf"], slow: 25 },
  },
  {
    title: "The price, and how flow pays it",
    text: "Some good readings are rejected too, and a sensor that always hears foreign sound first, as sensors 1 and 8 do here, stays blind. Flow fires one sensor after the other, after random gaps, and gives one that is fooled more quiet before and after its firing: now sensor 1 finds the wall.",
    state: { ...ALCOVE, sensors: 8, sensor: 0, shown: ["eeruf", "flow"], slow: 20 },
  },
  {
    title: "Your turn",
    text: "Drag walls, poles and the robot, press a sensor to see who fools it, and look for a place where EERUF is fooled. Then design your own ring below.",
    state: {
      walls: ROOMS.room.walls,
      poles: ROOMS.room.poles,
      robot: ROOMS.room.robot,
      sensors: 8,
      sensor: 3,
      slow: 25,
    },
  },
];

/** Time for which the scene moves from one step to the next. */
const GLIDE_MS = 700;

export class Lesson {
  /** @param {{state: () => State, change: (state: State, final: boolean) => void, play: () => void}} page */
  constructor(page) {
    this.page = page;
    this.step = -1;
    this.glide = 0;
    this.root = byId("lesson", HTMLElement);
    this.title = byId("lesson-title", HTMLElement);
    this.text = byId("lesson-text", HTMLElement);
    this.back = byId("lesson-back", HTMLButtonElement);
    this.next = byId("lesson-next", HTMLButtonElement);
    byId("lesson-start", HTMLButtonElement).onclick = () => this.go(0);
    byId("lesson-end", HTMLButtonElement).onclick = () => this.end();
    this.back.onclick = () => this.go(this.step - 1);
    this.next.onclick = () => (this.step + 1 < STEPS.length ? this.go(this.step + 1) : this.end());
  }

  end() {
    this.step = -1;
    this.root.hidden = true;
    document.body.classList.remove("in-lesson");
    byId("lesson-start", HTMLButtonElement).focus();
  }

  /** @param {number} step From 0. */
  go(step) {
    this.step = Math.min(STEPS.length - 1, Math.max(0, step));
    const { title, text, state } = STEPS[this.step];
    this.root.hidden = false;
    document.body.classList.add("in-lesson");
    this.title.textContent = `${this.step + 1} of ${STEPS.length}: ${title}`;
    this.text.textContent = text;
    this.back.disabled = this.step === 0;
    this.next.textContent = this.step + 1 < STEPS.length ? "Next" : "Done";
    const { walls, poles, robot, ...rest } = structuredClone({ ...firstState(), ...state });
    this.#glideTo({ walls, poles, robot, ...rest });
    // The last picture is the one that the step adds: on a phone, pictures stand one below the other.
    [...document.querySelectorAll(".panel")].at(-1)?.scrollIntoView({ block: "start" });
    this.title.focus({ preventScroll: true });
    if (!wantsLittleMotion()) this.page.play();
  }

  /** Moves the robot to its next place; walls change at once. @param {State} goal */
  #glideTo(goal) {
    const glide = ++this.glide;
    const from = { ...this.page.state().robot };
    const sameRoom = JSON.stringify(this.page.state().walls) === JSON.stringify(goal.walls);
    if (wantsLittleMotion() || !sameRoom) {
      this.page.change(goal, true);
      return;
    }
    const began = performance.now();
    const move = (/** @type {number} */ now) => {
      if (glide !== this.glide) return;
      const share = Math.min(1, (now - began) / GLIDE_MS);
      const eased = share * share * (3 - 2 * share);
      const between = (/** @type {"x" | "y" | "heading"} */ key) => from[key] + eased * (goal.robot[key] - from[key]);
      const robot = share === 1 ? goal.robot : { x: between("x"), y: between("y"), heading: between("heading") };
      this.page.change({ ...goal, robot }, share === 1);
      if (share < 1) requestAnimationFrame(move);
    };
    requestAnimationFrame(move);
  }
}
