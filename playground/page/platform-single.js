// @ts-check
/**
 * The source of the engine when the page is one file on a disk: texts within the page. The folder for a server has
 * `platform.js` instead.
 */

/** @param {string} id @returns {string} The contents of a script element that is not run. */
function embedded(id) {
  return document.getElementById(id)?.textContent ?? "";
}

/** @returns {Worker} A new worker that runs `worker.js`. */
export function newWorker() {
  const url = URL.createObjectURL(new Blob([embedded("worker-source")], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  return worker;
}

/** @returns {Promise<WebAssembly.Module>} The compiled engine. */
export async function loadEngine() {
  const packed = Uint8Array.from(atob(embedded("engine-packed").trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
