// @ts-check
/** Colours differ without colour vision, and text is legible, in light and dark. */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

const STYLE = readFileSync(new URL("../page/style.css", import.meta.url), "utf8");

/** Linear RGB as seen without one kind of cone: Machado, Oliveira and Fernandes 2009, severity 1. */
const VISIONS = {
  usual: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  tritanopia: [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
};

/** @param {"light" | "dark"} scheme @returns {Record<string, string>} The colours that the style sheet sets. */
function coloursOf(scheme) {
  const block = STYLE.split("}").find((part) => part.includes(`--scheme: ${scheme};`)) ?? "";
  return Object.fromEntries(
    [...block.matchAll(/--([a-z-]+): (#[0-9a-f]{3,6});/g)].map(([, name, colour]) => [name, colour]),
  );
}

/** @param {string} colour @returns {number[]} Linear RGB. */
function linear(colour) {
  const hex = colour.length === 4 ? [...colour.slice(1)].map((digit) => digit + digit).join("") : colour.slice(1);
  return [0, 2, 4].map((at) => {
    const value = parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
}

/** @param {number[]} rgb @returns {number[]} CIE Lab under D65. */
function lab(rgb) {
  const rows = [
    [0.4124564, 0.3575761, 0.1804375],
    [0.2126729, 0.7151522, 0.072175],
    [0.0193339, 0.119192, 0.9503041],
  ];
  const white = [0.95047, 1, 1.08883];
  const f = rows.map((row, k) => {
    const t =
      Math.max(
        0,
        row.reduce((sum, part, n) => sum + part * rgb[n], 0),
      ) / white[k];
    return t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116;
  });
  return [116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])];
}

/** @param {string} one @param {string} other @param {number[][]} vision @returns {number} Difference (CIE 1976). */
function difference(one, other, vision) {
  const [a, b] = [one, other].map((colour) => {
    const rgb = linear(colour);
    return lab(
      vision.map((row) =>
        Math.min(
          1,
          Math.max(
            0,
            row.reduce((sum, part, n) => sum + part * rgb[n], 0),
          ),
        ),
      ),
    );
  });
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** @param {string} one @param {string} other @returns {number} Contrast as WCAG 2 defines it. */
function contrast(one, other) {
  const [high, low] = [one, other]
    .map((colour) => {
      const [r, g, b] = linear(colour);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
    })
    .sort((a, b) => b - a);
  return high / low;
}

for (const scheme of /** @type {const} */ (["light", "dark"])) {
  test(`right and wrong tell apart under every colour vision, ${scheme}`, () => {
    const colours = coloursOf(scheme);
    for (const [name, vision] of Object.entries(VISIONS)) {
      const far = difference(colours.right, colours.wrong, vision);
      assert.ok(far > 20, `${name}: right and wrong differ by ${far.toFixed(1)}`);
    }
  });

  test(`text and marks are legible, ${scheme}`, () => {
    const colours = coloursOf(scheme);
    for (const name of ["ink", "muted", "wrong", "accent"]) {
      assert.ok(contrast(colours[name], colours.paper) >= 4.5, `${name} on paper`);
    }
    for (const name of ["right", "wrong", "rejected", "muted"]) {
      assert.ok(contrast(colours[name], colours.floor) >= 3, `${name} on the floor`);
    }
    assert.ok(contrast(colours["on-accent"], colours.accent) >= 4.5);
  });
}
