// @ts-check
/** The engine in Node compared with the program `eeruf`, and its answers to bad input. */
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { McapStreamReader } from "@mcap/core";

import { fromHash, toHash } from "../page/link.js";
import { mcapOf } from "../page/mcap.js";
import { methodsOf } from "../page/methods.js";
import { readingsOf } from "../page/run.js";
import { ROOMS, StateError, checkedState, firstState } from "../page/state.js";
import { inPageWords, ringText, sceneText } from "../page/texts.js";
import { askEngine, startEngine } from "../page/wasm.js";

const ROOT = new URL("../../", import.meta.url).pathname;
const PROGRAM = join(ROOT, "target/debug/eeruf");
const compiled = await WebAssembly.compile(readFileSync(join(ROOT, "target/page/folder/eeruf.wasm")));
let progressCalls = 0;
const engine = await startEngine(compiled, () => {
  progressCalls += 1;
});
const folder = mkdtempSync(join(tmpdir(), "eeruf-page-"));

/** @param {object} question */
function ask(question) {
  return JSON.parse(askEngine(engine, question));
}

/** @param {string[]} words @returns {any} The program's output with `--json`. */
function program(...words) {
  return JSON.parse(execFileSync(PROGRAM, [...words, "--json"], { encoding: "utf8", maxBuffer: 1 << 28 }));
}

/** @param {string} name @param {string} text @returns {string} The path of a file with that text. */
function file(name, text) {
  const path = join(folder, name);
  writeFileSync(path, text);
  return path;
}

/** Twenty rings: the project's own, and variants of the page's. */
const RINGS = [
  ...["paper-12", "ring-24", "labmate-8", "hc-sr04-8"].map((name) =>
    readFileSync(join(ROOT, `rings/${name}.toml`), "utf8"),
  ),
  ...[
    {},
    { sensors: 1 },
    { sensors: 2 },
    { sensors: 3 },
    { sensors: 5 },
    { sensors: 7 },
    { sensors: 12 },
    { sensors: 16, tick: 1000 },
    { layout: "ring" },
    { layout: "ring", sensors: 12, tick: 500 },
    { module: "hc_sr04" },
    { speed: 0 },
    { speed: 1.5 },
    { range: 6.2 },
    { crosstalk: 0.5 },
    { jitter: 400, tick: 500 },
  ].map((patch) => ringText({ ...firstState(), .../** @type {object} */ (patch) })),
];

test("for twenty rings the page's design is to the bit that of the program", () => {
  assert.equal(RINGS.length, 20);
  RINGS.forEach((ring, k) => {
    const ours = ask({ ask: "design", ring }).ok;
    // The page's atlas is a part of the program's.
    const atlas = ours.found.from_atlas ? [] : ["--no-atlas"];
    const printed = program("design", "--period-only", file(`ring-${k}.toml`, ring), ...atlas);
    const { seconds, ...theirs } = printed;
    assert.ok(seconds >= 0);
    const { seconds: none, ...found } = ours.found;
    assert.equal(none, 0);
    assert.deepEqual(found, theirs);
    assert.ok(ours.verified);
    if (k % 5 !== 0) return;
    const asked = ["design", "--period-only", join(folder, `ring-${k}.toml`), ...atlas];
    const emitted = ["rust", "c", "arduino", "toml"].map((form) =>
      execFileSync(PROGRAM, [...asked, "--emit", form], { encoding: "utf8" }),
    );
    assert.deepEqual([ours.rust, ours.c, ours.arduino, ours.toml], emitted);
  });
});

test("of a ring whose search takes long the page's atlas answers, as the program's does, at once", () => {
  const patch = { module: "hc_sr04", layout: "ring", sensors: 20, crosstalk: 2.5, jitter: 100, speed: 0, tick: 1000 };
  const ring = ringText({ ...firstState(), .../** @type {object} */ (patch) });
  const before = progressCalls;
  const ours = ask({ ask: "design", ring }).ok;
  assert.deepEqual([ours.found.from_atlas, ours.found.nodes, ours.verified], [true, 0, true]);
  assert.equal(progressCalls, before);
  const printed = program("design", "--period-only", file("atlas.toml", ring));
  assert.deepEqual([ours.found.schedule, printed.from_atlas], [printed.schedule, true]);
  // Rings that are searched within a key press are not in it.
  assert.equal(ask({ ask: "design", ring: ring.replace("sensors = 20", "sensors = 8") }).ok.found.from_atlas, false);
});

test("the page's certificate is to the letter that of the program", () => {
  const ring = RINGS[0];
  const certificate = ask({ ask: "certificate", ring }).ok;
  assert.match(certificate.says, /^65000 us is the shortest period/);
  const path = join(folder, "certificate");
  const asked = ["design", "--period-only", "--no-atlas", file("certified.toml", ring)];
  execFileSync(PROGRAM, [...asked, "--certificate", path], { stdio: "pipe" });
  assert.equal(certificate.text, readFileSync(path, "utf8"));
  // The page's checker accepts the page's certificate.
  const [checker, given] = [file("check_period.py", certificate.checker), file("ring.certificate", certificate.text)];
  assert.equal(execFileSync("python3", [checker, given], { encoding: "utf8" }).trim(), certificate.says);
});

/** Compares our figures with those of the program. @param {any} ours @param {any} theirs @param {string} where */
function sameFigures(ours, theirs, where) {
  const shared = Object.keys(ours).filter((name) => name in theirs);
  assert.ok(shared.length >= 15, `${where}: ${shared.join(" ")}`);
  for (const name of shared) assert.deepEqual(ours[name], theirs[name], `${where}, ${name}`);
}

const SCENES = Object.values(ROOMS).map((room) => sceneText({ ...firstState(), ...room }));

test("in each room the figures of the methods are to the bit those of the program", () => {
  SCENES.forEach((scene, k) => {
    const methods = ["sequential", "conventional", "comparison", "eeruf", "eeruf_best", "flow"];
    const theirs = program(
      "study",
      file(`scene-${k}.toml`, scene),
      "--periods",
      "400",
      "--method",
      methods.join(","),
    ).methods;
    for (const method of methods) {
      const ours = ask({ ask: "run", scene, method, periods: 400, shown_s: 1.44 }).ok;
      sameFigures(ours.summary, theirs[method], `room ${k}, ${method}`);
    }
  });
});

test("with all effects of the default physics the figures are to the bit those of the program", () => {
  for (const name of ["alcove", "typical-alcove", "wall", "two-hc-sr04"]) {
    const path = join(ROOT, `scenes/${name}.toml`);
    const theirs = program("study", path, "--periods", "60", "--method", "conventional,eeruf").methods;
    for (const method of ["conventional", "eeruf"]) {
      const ours = ask({ ask: "run", scene: readFileSync(path, "utf8"), method, periods: 60, shown_s: 1.44 }).ok;
      sameFigures(ours.summary, theirs[method], `${name}, ${method}`);
    }
  }
});

test("in each room the critical paths are to the bit those of the program", () => {
  SCENES.forEach((scene, k) => {
    const theirs = program("paths", file(`scene-${k}.toml`, scene));
    const ours = ask({ ask: "trace", scene }).ok.paths.filter(
      (/** @type {any} */ path) => path.emitter !== path.receiver,
    );
    assert.ok(ours.length > 5);
    assert.equal(ours.length, theirs.order.length);
    ours.forEach((/** @type {any} */ path, /** @type {number} */ n) => {
      assert.deepEqual(
        [path.emitter, path.receiver, path.order],
        [theirs.emitter[n], theirs.receiver[n], theirs.order[n]],
      );
      assert.deepEqual([path.length_m, path.level_db], [theirs.length_m[n], theirs.level_db[n]]);
      // The corners belong to a path of that length.
      const length = path.corners
        .slice(1)
        .reduce(
          (/** @type {number} */ sum, /** @type {number[]} */ [x, y], /** @type {number} */ c) =>
            sum + Math.hypot(x - path.corners[c][0], y - path.corners[c][1]),
          0,
        );
      assert.ok(Math.abs(length - path.length_m) < 1e-9);
    });
  });
});

test("bad input is one sentence that names the thing, the value and what is expected", () => {
  const wall = "[[wall]]\npoints_m = [[1, -1], [1, 1]]\n";
  const robot = "[[robot]]\npose = { x_m = 0, y_m = 0 }\nring = { sensors = 8, spacing_deg = 15, radius_m = 0.3 }\n";
  const crossed = `${wall}faces = "both"\n[[wall]]\npoints_m = [[0.5, 0], [2, 0]]\nfaces = "both"\n${robot}`;
  const cases = [
    [{ ask: "trace", scene: crossed }, "walls 0 and 1 cross at (1.0000, 0.0000); end one of them there"],
    [{ ask: "trace", scene: robot.replace("sensors = 8", "sensors = 65") }, "robot 1 has 65 sensors; expected 1 to 64"],
    [{ ask: "trace", scene: wall }, "0 robots; expected 1 to 64"],
    [
      {
        ask: "run",
        scene: readFileSync(join(ROOT, "scenes/lab.toml"), "utf8"),
        method: "eeruf",
        periods: 1,
        shown_s: 1,
      },
      "2 robots; expected one",
    ],
    [
      { ask: "run", scene: robot, method: "eruf", periods: 1, shown_s: 1 },
      /^no method `eruf`; expected simultaneous, /,
    ],
    [{ ask: "run", scene: robot, method: "eeruf", periods: 0, shown_s: 1 }, "0 periods; expected 1 to 100000"],
    [{ ask: "design", ring: "sensors = 0" }, "line 1: 0 sensors; expected 1 to 64"],
    [{ ask: "design", ring: 'sensors = "many"' }, /^line 1: sensors: string "many"; expected a whole number/],
    [{ ask: "sing" }, /^unknown variant `sing`/],
  ];
  for (const [question, sentence] of cases) {
    const { error } = ask(/** @type {object} */ (question));
    if (sentence instanceof RegExp) assert.match(error, sentence);
    else assert.equal(error, sentence);
  }
  const inWall = `${wall.replaceAll("1,", "0.1,")}faces = "both"\n${robot}`;
  assert.match(ask({ ask: "trace", scene: inWall }).error, /touches wall 0; expected it to stand free at its pose/);
});

test("readings saved as MCAP are read back by MCAP's own library, in order of time", () => {
  const runs = ["conventional", "flow"].map((method) => ({
    method,
    readings: readingsOf(ask({ ask: "run", scene: SCENES[0], method, periods: 20, shown_s: 1 }).ok, 36_000),
  }));
  const reader = new McapStreamReader();
  reader.append(mcapOf(runs));
  const topics = new Map();
  const messages = [];
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type === "Message")
      messages.push({ ...record, body: JSON.parse(new TextDecoder().decode(record.data)) });
  }
  assert.ok(reader.done());
  assert.deepEqual([...topics.values()], ["/readings/conventional", "/readings/flow"]);
  assert.equal(messages.length, runs[0].readings.length + runs[1].readings.length);
  assert.ok(messages.every(({ logTime }, k) => k === 0 || messages[k - 1].logTime <= logTime));
  const ours = messages
    .filter(({ channelId }) => channelId === 0)
    .map(({ body }) => [body.sensor, body.period, body.t_echo_us, body.wrong]);
  const given = runs[0].readings.map(({ sensor, period, t_echo_us, wrong }) => [sensor, period, t_echo_us, wrong]);
  assert.deepEqual(new Set(ours.map(String)), new Set(given.map(String)));
});

test("walls and poles in a sentence are numbered as the page numbers them", () => {
  const state = firstState();
  state.walls.push([
    [0, 1],
    [1, 1],
  ]);
  const said = (/** @type {string} */ sentence) => inPageWords(sentence, state);
  assert.equal(
    said("walls 1 and 3 cross at (0.5, 1); end one of them there"),
    "walls 1 and 2 cross at (0.5, 1); end one of them there",
  );
  assert.equal(said("walls 0 and 2 cross at (0.5, 1)"), "two parts of wall 1 cross at (0.5, 1)");
  assert.equal(said("robot 1 touches wall 3; expected"), "the robot touches wall 2; expected");
  assert.equal(said("robot 1 touches pole 0"), "the robot touches pole 1");
  assert.equal(said("poles 0 and 2 have the same axis"), "poles 1 and 3 have the same axis");
});

test("long tasks say how far they are", () => {
  progressCalls = 0;
  ask({ ask: "run", scene: SCENES[0], method: "conventional", periods: 400, shown_s: 0 });
  assert.ok(progressCalls > 0);
});

test("a link gives back the state that it was made of, and what is wrong with one is a sentence", () => {
  const own = {
    period_us: 60_000,
    a: [0, 1, 2, 3, 4, 5, 6, 7],
    b: [7, 6, 5, 4, 3, 2, 1, 0],
    t_delta_us: 500,
    window_us: 36_000,
  };
  const state = { ...firstState(), poles: /** @type {[number, number, number][]} */ ([[0.1, 0.2, 0.03]]), own };
  assert.deepEqual(fromHash(`#${toHash(state)}`), state);
  assert.equal(fromHash("#why"), null);
  assert.equal(fromHash(""), null);
  for (const bad of ["#s=%%%", "#s=AAAA", `#${toHash(state).slice(0, 40)}`, `#s=${"A".repeat(50_000)}`]) {
    assert.throws(() => fromHash(bad), StateError);
  }
  const wrong = (/** @type {object} */ patch) => {
    try {
      checkedState({ ...state, ...patch });
    } catch (error) {
      return error instanceof StateError ? error.message : String(error);
    }
    return "nothing";
  };
  assert.equal(wrong({ sensors: 65 }), "sensors is 65; expected a number from 1 to 64");
  assert.equal(wrong({ sensors: 7.5 }), "sensors is 7.5; expected a whole number from 1 to 64");
  assert.equal(wrong({ walls: [[[0, 0]]] }), "wall 1 has 1 points; expected at least 2");
  assert.equal(wrong({ robot: { x: null, y: 0, heading: 0 } }), "robot, x is null; expected a number from -20 to 20 m");
  assert.equal(wrong({ own: { ...own, a: [1] } }), "own schedule, a has 1 times; expected 8, one for each sensor");
  // A caller leaves out methods that the engine does not know.
  assert.equal(wrong({ shown: ["magic"] }), "nothing");
  assert.ok(!methodsOf([{ id: "flow", does: "" }]).some((method) => method.id === "magic"));
});

test("a paste gets the program's answer, word for word", () => {
  for (const name of ["six-lines.txt", "blocking-loop.txt", "polled.csv", "toa5.dat"]) {
    const path = join(ROOT, "tests/data/field-cases", name);
    const { ok } = ask({ ask: "paste", text: readFileSync(path, "utf8") });
    const { status, stdout } = spawnSync(PROGRAM, ["logs", path], { encoding: "utf8" });
    assert.equal(status, { "none seen": 0, crosstalk: 1, "cannot tell": 3 }[/** @type {string} */ (ok.verdict)], name);
    // The program breaks lines at the terminal's width.
    const words = (/** @type {string} */ said) => said.split(/\s+/);
    assert.deepEqual(words(stdout.split("\n\n")[0]), words(ok.answer), name);
    assert.ok(ok.sensors.every((/** @type {any} */ sensor) => sensor.points.length > 0), name);
  }
  assert.match(ask({ ask: "paste", text: "hello\nworld\n" }).error, /^No ranges are found in it\./);
});
