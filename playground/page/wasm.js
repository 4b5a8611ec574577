// @ts-check
/** The interface to the engine in WebAssembly: a question and its answer are texts. Knows neither page nor worker. */

/**
 * @typedef {object} Engine
 * @property {WebAssembly.Memory} memory
 * @property {(bytes: number) => number} reserve
 * @property {() => number} ask
 * @property {() => number} answer_at
 */

/**
 * @param {WebAssembly.Module} compiled
 * @param {(share: number, nodes: number) => void} progress Called during long tasks.
 * @returns {Promise<Engine>}
 */
export async function startEngine(compiled, progress) {
  const instance = await WebAssembly.instantiate(compiled, { page: { progress } });
  return /** @type {Engine} */ (/** @type {unknown} */ (instance.exports));
}

/**
 * @param {Engine} engine
 * @param {object} question
 * @returns {string} The answer in JSON: `{"ok": ..}` or `{"error": "a sentence"}`.
 */
export function askEngine(engine, question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const at = engine.reserve(bytes.length);
  new Uint8Array(engine.memory.buffer, at, bytes.length).set(bytes);
  const length = engine.ask();
  // The memory may have grown, which detaches its old buffer.
  return new TextDecoder().decode(new Uint8Array(engine.memory.buffer, engine.answer_at(), length));
}
