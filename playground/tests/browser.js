// @ts-check
/** Functions that the tests of the page share: a browser, a server for the folder, and the console's messages. */
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { extname, join, normalize } from "node:path";

import { chromium } from "playwright-core";

export const BUILT = new URL("../../target/page/", import.meta.url).pathname;
export const SINGLE = `file://${join(BUILT, "who-fools-whom.html")}`;

/** @type {Record<string, string>} */
const KINDS = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

/** A lecturer's page, which embeds the page in the state that follows `?`. */
export const LECTURE = "/lecture.html";

/** @returns {Promise<{url: string, close: () => void}>} The folder on a server of this machine. */
export async function serve() {
  const server = createServer((request, response) => {
    const { pathname, search } = new URL(request.url ?? "/", "http://page");
    const path = normalize(pathname);
    if (path === LECTURE) {
      const frame = `<iframe src="/#${search.slice(1)}" title="Who fools whom?" width="100%" height="900"></iframe>`;
      const head = '<!doctype html><title>A lecture</title><link rel="icon" href="data:,">';
      response.writeHead(200, { "content-type": "text/html" }).end(head + frame);
      return;
    }
    try {
      const body = readFileSync(join(BUILT, "folder", path === "/" ? "index.html" : path));
      response.writeHead(200, { "content-type": KINDS[extname(path) || ".html"] ?? "text/plain" }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(null)));
  const address = server.address();
  const port = typeof address === "object" ? address?.port : 0;
  return { url: `http://127.0.0.1:${port}/`, close: () => server.close() };
}

/** @returns {Promise<import("playwright-core").Browser>} */
export function launch() {
  // Debian's wrapper and a container's root user both need these.
  return chromium.launch({ executablePath: process.env.PAGE_BROWSER, args: ["--no-sandbox", "--disable-gpu"] });
}

/**
 * Opens the page and waits until the first simulation has run.
 * @param {import("playwright-core").Browser} browser
 * @param {string} url
 * @param {import("playwright-core").BrowserContextOptions} [options]
 */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 900 },
    reducedMotion: "reduce",
    ...options,
  });
  const page = await context.newPage();
  /** @type {string[]} */
  const troubles = [];
  page.on("console", (message) => {
    if (message.type() === "error") troubles.push(message.text());
  });
  page.on("pageerror", (error) => troubles.push(String(error)));
  /** @type {string[]} */
  const requests = [];
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(url);
  await ready(page);
  return { context, page, troubles, requests };
}

/** @param {import("playwright-core").Page} page Waits until every picture shows a run or says why not. */
export async function ready(page) {
  await page.waitForFunction(
    () => {
      const panels = [...document.querySelectorAll(".panel")];
      return panels.length > 0 && panels.every((panel) => !panel.classList.contains("stale"));
    },
    undefined,
    { timeout: 30_000 },
  );
}
