// @ts-check
/** The page's side of the workers: asks questions, receives progress, cancels. */
import { loadEngine, newWorker } from "./platform.js";

/** The error of a question that was cancelled or overtaken by a later one. */
export class Cancelled extends Error {}

/** The engine's objection to a question: one sentence. */
export class Refused extends Error {}

/** @typedef {{question: object, resolve: (answer: any) => void, reject: (error: Error) => void,
 *   onProgress?: (share: number, nodes: number) => void}} Job */

/** One worker, which answers questions in turn. */
export class Desk {
  /** @param {Promise<WebAssembly.Module>} compiled */
  constructor(compiled) {
    this.compiled = compiled;
    /** @type {Job[]} */
    this.waiting = [];
    /** @type {Job | null} */
    this.asked = null;
    /** @type {Worker | null} */
    this.worker = null;
    this.id = 0;
  }

  /**
   * @param {object} question
   * @param {(share: number, nodes: number) => void} [onProgress] `share` is NaN where it is not known.
   * @returns {Promise<any>} The engine's answer; rejects with `Refused` or `Cancelled`.
   */
  ask(question, onProgress) {
    return new Promise((resolve, reject) => {
      this.waiting.push({ question, resolve, reject, onProgress });
      this.#next();
    });
  }

  /** Asks like `ask`, but replaces all questions that still wait. */
  askLatest(/** @type {object} */ question) {
    for (const job of this.waiting.splice(0)) job.reject(new Cancelled("overtaken"));
    return this.ask(question);
  }

  /** Ends all questions at once; the next one gets a new worker. */
  cancel() {
    const jobs = this.waiting.splice(0);
    if (this.asked) {
      jobs.push(this.asked);
      this.worker?.terminate();
      this.worker = null;
      this.asked = null;
      this.id += 1;
    }
    for (const job of jobs) job.reject(new Cancelled("cancelled"));
  }

  async #next() {
    if (this.asked || this.waiting.length === 0) return;
    const job = /** @type {Job} */ (this.waiting.shift());
    this.asked = job;
    const id = ++this.id;
    try {
      this.worker ??= await this.#start();
    } catch (error) {
      this.asked = null;
      job.reject(new Refused(`The engine did not start: ${error instanceof Error ? error.message : error}`));
      return;
    }
    // The question may have been cancelled while the engine was loading.
    if (this.asked === job) this.worker.postMessage({ id, question: job.question });
    else this.#next();
  }

  async #start() {
    const compiled = await this.compiled;
    const worker = newWorker();
    worker.postMessage({ engine: compiled });
    worker.onmessage = ({ data }) => {
      if (worker === this.worker) this.#heard(data);
    };
    worker.onerror = (event) => {
      if (worker === this.worker) this.#heard({ id: this.id, crash: event.message });
    };
    return worker;
  }

  /** @param {{id: number, text?: string, crash?: string, share?: number, nodes?: number}} said */
  #heard(said) {
    const job = this.asked;
    if (!job || said.id !== this.id) return;
    if (said.share !== undefined) {
      job.onProgress?.(said.share, said.nodes ?? NaN);
      return;
    }
    this.asked = null;
    if (said.text === undefined) {
      job.reject(new Refused(`The engine stopped, which is a fault of ours: ${said.crash}`));
    } else {
      const answer = JSON.parse(said.text);
      if ("error" in answer) job.reject(new Refused(answer.error));
      else job.resolve(answer.ok);
    }
    this.#next();
  }
}

/** @returns {{quick: Desk, slow: Desk}} A desk for answers during a drag, and one for simulations and searches. */
export function openDesks() {
  const compiled = loadEngine();
  // Each question reports the failure.
  compiled.catch(() => {});
  return { quick: new Desk(compiled), slow: new Desk(compiled) };
}
