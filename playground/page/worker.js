// @ts-check
/**
 * The worker: holds the engine and answers one question at a time. It receives the compiled engine first, then
 * questions `{id, question}`; it answers `{id, text}` or `{id, crash}`, and reports progress as `{id, share, nodes}`.
 */
import { askEngine, startEngine } from "./wasm.js";

/** Least time between two reports of progress, in milliseconds. */
const SAID_EVERY_MS = 50;

/** @type {Promise<import("./wasm.js").Engine> | undefined} */
let engine;
/** @type {WebAssembly.Module | undefined} */
let compiled;
let asking = 0;
let saidAt = 0;

/** @param {number} share @param {number} nodes */
function sayProgress(share, nodes) {
  const now = performance.now();
  if (now - saidAt < SAID_EVERY_MS) return;
  saidAt = now;
  postMessage({ id: asking, share, nodes });
}

self.onmessage = async ({ data }) => {
  if (data.engine) {
    compiled = data.engine;
    return;
  }
  try {
    engine ??= startEngine(/** @type {WebAssembly.Module} */ (compiled), sayProgress);
    const ready = await engine;
    asking = data.id;
    saidAt = performance.now();
    postMessage({ id: data.id, text: askEngine(ready, data.question) });
  } catch (error) {
    // The state of the engine's memory is unknown now: the next question gets a new engine.
    engine = undefined;
    postMessage({ id: data.id, crash: String(error) });
  }
};
