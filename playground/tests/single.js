/** Makes the page as one file: style, scripts and engine within it. `node single.js PAGE ENGINE OUT` */
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const [page, engine, out] = process.argv.slice(2);
const instead = ({ resolveDir }) => ({ path: `${resolveDir}/platform-single.js` });
const plugins = [{ name: "platform", setup: (bundler) => bundler.onResolve({ filter: /\/platform\.js$/ }, instead) }];

/** Bundles a module and its imports as a classic script: browsers load no modules from a disk. */
async function script(entry) {
  const options = { bundle: true, format: "iife", charset: "utf8", write: false, plugins };
  const { text } = (await build({ entryPoints: [`${page}/${entry}`], ...options })).outputFiles[0];
  // The content of a script element ends at the first end tag, and HTML comments begin in it too.
  if (/<\/script|<!--/.test(text)) throw new Error(`${entry} holds </script or <!--, which ends it in HTML`);
  return text;
}
const html = readFileSync(`${page}/index.html`, "utf8");
const parts = {
  [html.split('"').find((part) => part.startsWith("default-src"))]:
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; img-src data:",
  '<link rel="stylesheet" href="style.css">': `<style>\n${readFileSync(`${page}/style.css`, "utf8")}</style>`,
  '<script type="module" src="main.js"></script>': `<script type="text/plain" id="engine-packed">${gzipSync(readFileSync(engine), { level: 9 }).toString("base64")}</script>
<script type="text/plain" id="worker-source">${await script("worker.js")}</script>
<script>${await script("main.js")}</script>`,
};
const put = (text, [from, to]) => {
  if (!text.includes(from)) throw new Error(`index.html: no ${from}`);
  return text.replace(from, () => to);
};
writeFileSync(out, Object.entries(parts).reduce(put, html));
