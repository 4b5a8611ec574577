// Runs eeruf.py's tests in MicroPython's WebAssembly build:
// node run.mjs FOLDER_OF_MICROPYTHON line-faults.txt ring-golden.txt [corpus.txt], the last in place of the lines kept
import { readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [folder, faults, golden, corpus = golden] = process.argv.slice(2);
const { loadMicroPython } = await import(pathToFileURL(resolve(folder, "micropython.mjs")));
const micropython = await loadMicroPython({ heapsize: 4 * 1024 * 1024 });
const sources = ["eeruf.py", "line_faults.py"];
for (const name of [...sources, "test_corpus.py", "test_line_faults.py", "test_modules.py"]) {
  micropython.FS.writeFile(`/${name}`, readFileSync(join(here, name)));
}
micropython.FS.writeFile("/corpus.txt", readFileSync(corpus));
micropython.FS.writeFile("/line-faults.txt", readFileSync(faults));
try {
  micropython.runPython(`
import sys
sys.path.append("/")
import test_corpus, test_line_faults, test_modules
print(sys.implementation.name, ".".join(str(n) for n in sys.implementation.version[:3]))
with open("/corpus.txt") as corpus:
    test_corpus.main(corpus.read())
test_modules.settings()
with open("/line-faults.txt") as faults:
    print(len(test_line_faults.check(faults.read())), "faults of a line")
`);
} catch (error) {
  // Without the source of the build, which is one line of 100 kB.
  console.error(error.message);
  process.exit(1);
}
