// @ts-check
/** A link that holds the whole state, in the part that no server sees: `#s=` and JSON in base64url. */
import { StateError, checkedState } from "./state.js";

/** Largest length of the text; no state needs as much. */
const MAX_LENGTH = 40_000;

/** @param {import("./state.js").State} state @returns {string} The part of the link after `#`. */
export function toHash(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return `s=${btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/**
 * @param {string} hash With or without `#`.
 * @returns {import("./state.js").State | null} The state, or null if there is none in it. Throws `StateError`.
 */
export function fromHash(hash) {
  const text = hash
    .replace(/^#/, "")
    .split("&")
    .find((part) => part.startsWith("s="))
    ?.slice(2);
  if (!text) return null;
  if (text.length > MAX_LENGTH) {
    throw new StateError(`The link holds ${text.length} letters; expected at most ${MAX_LENGTH}`);
  }
  let given;
  try {
    const letters = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    given = JSON.parse(new TextDecoder().decode(Uint8Array.from(letters, (letter) => letter.charCodeAt(0))));
  } catch {
    throw new StateError("The link is cut short or changed; expected one that this page made");
  }
  return checkedState(given);
}
