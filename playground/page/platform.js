// @ts-check
/**
 * The source of the engine when the page is a folder on a server: two files beside the page. The page in one file has
 * `platform-single.js` instead.
 */

/** @returns {Worker} A new worker that runs `worker.js`. */
export function newWorker() {
  return new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
}

/** @returns {Promise<WebAssembly.Module>} The compiled engine. */
export async function loadEngine() {
  const answer = await fetch(new URL("./eeruf.wasm", import.meta.url));
  if (!answer.ok) throw new Error(`eeruf.wasm: the server says ${answer.status}; expected the file beside the page`);
  return WebAssembly.compile(await answer.arrayBuffer());
}
