// @ts-check
/** Part three: the table for your own robot in the form that it needs, and a link that holds everything. */
import { byId, element } from "./dom.js";
import { mcapOf } from "./mcap.js";
import { pythonText, ringText, sceneText } from "./texts.js";

/**
 * The forms: the label of the tab, the file's name, and the text. Those with `needs` require a designed ring.
 * @type {{id: string, name: string, file: string, needs: boolean,
 *   text: (state: import("./state.js").State, designed: any) => string}[]}
 */
const FORMS = [
  { id: "rust", name: "Rust", file: "ring.rs", needs: true, text: (_, designed) => designed.rust },
  { id: "c", name: "C", file: "eeruf_schedule.h", needs: true, text: (_, designed) => designed.c },
  { id: "arduino", name: "Arduino", file: "ring.h", needs: true, text: (_, designed) => designed.arduino },
  { id: "python", name: "Python", file: "ring.py", needs: true, text: pythonText },
  { id: "schedule", name: "Schedule", file: "schedule.toml", needs: true, text: (_, designed) => designed.toml },
  { id: "ring", name: "Ring", file: "ring.toml", needs: false, text: (state) => ringText(state) },
  { id: "scene", name: "Room", file: "scene.toml", needs: false, text: (state) => sceneText(state) },
];

/** Instructions for each form. */
const USES = new Map([
  ["rust", "A constant that the compiler checks, for the crate eeruf-core."],
  ["c", "A C99 header that includes nothing but <stdint.h>; after eeruf.h, also the schedule for its ring."],
  ["arduino", "A tab for the library Eeruf: give RING to an EerufSonar. For a whole sketch take the form Ring."],
  ["python", "For the package eeruf: it verifies the schedule again."],
  ["schedule", "For the program: eeruf verify schedule.toml --t-delta-us N, and for a robot in a scene file."],
  [
    "ring",
    'Add your module, as module = "hc-sr04"; then eeruf design ring.toml --program arduino writes the sketch that fires it best.',
  ],
  ["scene", "For the program: eeruf study scene.toml compares all methods in this room."],
]);

export class TakeHome {
  /**
   * @param {{state: () => import("./state.js").State, link: () => string,
   *   runs: () => {method: string, readings: import("./run.js").Reading[]}[]}} page
   */
  constructor(page) {
    this.page = page;
    /** @type {any} */
    this.designed = null;
    this.form = FORMS[FORMS.length - 1];
    this.tabs = byId("form-tabs", HTMLElement);
    this.text = byId("form-text", HTMLElement);
    this.use = byId("form-use", HTMLElement);
    this.says = byId("copy-says", HTMLElement);
    this.buttons = FORMS.map((form) => {
      const tab = /** @type {HTMLButtonElement} */ (
        element(
          "button",
          { type: "button", role: "tab", id: `tab-${form.id}`, "aria-controls": "form-panel" },
          form.name,
        )
      );
      tab.onclick = () => this.#choose(form);
      return tab;
    });
    this.tabs.append(...this.buttons);
    this.tabs.onkeydown = (event) => this.#key(event);
    byId("copy-form", HTMLButtonElement).onclick = () => this.#copy(this.text.textContent ?? "", "The text");
    byId("save-form", HTMLButtonElement).onclick = () => this.#save(this.form.file, this.text.textContent ?? "");
    byId("save-readings", HTMLButtonElement).onclick = () => this.#save("readings.mcap", mcapOf(this.page.runs()));
    byId("copy-link", HTMLButtonElement).onclick = () => this.#copy(this.page.link(), "The link");
    this.sync();
  }

  /** @param {any} designed The result of the designer; null for a ring that is not designed. */
  show(designed) {
    this.designed = designed;
    this.form = designed ? FORMS[0] : FORMS[FORMS.length - 1];
    this.sync();
  }

  sync() {
    if (this.form.needs && !this.designed) this.form = FORMS[FORMS.length - 1];
    this.buttons.forEach((tab, k) => {
      const chosen = FORMS[k] === this.form;
      tab.disabled = FORMS[k].needs && !this.designed;
      tab.setAttribute("aria-selected", String(chosen));
      tab.tabIndex = chosen ? 0 : -1;
    });
    byId("form-panel", HTMLElement).setAttribute("aria-labelledby", `tab-${this.form.id}`);
    this.text.textContent = this.form.text(this.page.state(), this.designed);
    this.use.textContent = USES.get(this.form.id) ?? "";
    byId("needs-design", HTMLElement).hidden = this.designed !== null;
  }

  /** @param {typeof FORMS[number]} form */
  #choose(form) {
    this.form = form;
    this.says.textContent = "";
    this.sync();
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    const open = this.buttons.map((tab, k) => ({ tab, k })).filter(({ tab }) => !tab.disabled);
    const now = open.findIndex(({ k }) => FORMS[k] === this.form);
    const next = open[(now + step + open.length) % open.length];
    this.#choose(FORMS[next.k]);
    next.tab.focus();
  }

  /** @param {string} text @param {string} what */
  async #copy(text, what) {
    try {
      await navigator.clipboard.writeText(text);
      this.says.textContent = `${what} is copied.`;
    } catch {
      this.says.textContent = "This browser lets no page copy; select the text and copy it.";
      if (what === "The link") window.prompt("The link:", text);
    }
  }

  /** @param {string} file @param {string | Uint8Array} contents */
  #save(file, contents) {
    const url = URL.createObjectURL(new Blob([/** @type {BlobPart} */ (contents)]));
    const link = /** @type {HTMLAnchorElement} */ (element("a", { href: url, download: file }));
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
    this.says.textContent = `${file} is saved.`;
  }
}
