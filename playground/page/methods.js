// @ts-check
/**
 * The firing methods that the page can show, in the order of its menus. A method is shown only if the engine knows it;
 * methods that only the engine knows come last, with the engine's own description.
 */

/** @typedef {{id: string, name: string, does: string, byDefault?: boolean}} Method */

/** @type {Method[]} */
const TABLE = [
  { id: "sequential", name: "One by one", does: "Each sensor waits until the one before has listened to the end." },
  { id: "simultaneous", name: "All at once", does: "All sensors fire together, once a period." },
  {
    id: "conventional",
    name: "Constant waits",
    byDefault: true,
    does: "Neighbours fire a little apart, every period alike. Every echo is believed.",
  },
  {
    id: "comparison",
    name: "Constant waits, compared",
    does: "Every period alike; a reading is believed if it repeats the one before.",
  },
  { id: "dither", name: "Random waits", does: "Every wait is drawn anew; a reading is believed if it repeats." },
  {
    id: "eeruf",
    name: "EERUF: alternating waits",
    byDefault: true,
    does: "Every wait alternates between two values; a reading is believed if it repeats the one before.",
  },
  { id: "eeruf_best", name: "EERUF, shortest period", does: "The same guarantees at the shortest proven period." },
  {
    id: "multi_echo",
    name: "EERUF, several echoes",
    does: "Sensors that report several echoes of a firing: the earliest that repeats is believed.",
  },
  {
    id: "flow",
    name: "Flow",
    byDefault: true,
    does: "One sensor after the other, with random gaps and as much quiet around each as it has needed.",
  },
];

/** Methods left out of the menus. */
const LEFT_OUT = ["sequential_votes", "sequential_median", "far_groups", "median", "eeruf_immediate", "adaptive"];

/** @param {{id: string, does: string}[]} known The methods that the engine knows. @returns {Method[]} */
export function methodsOf(known) {
  const rows = TABLE.filter((method) => known.some((one) => one.id === method.id));
  const listed = [...TABLE.map((method) => method.id), ...LEFT_OUT];
  const others = known.filter((one) => !listed.includes(one.id));
  return [...rows, ...others.map(({ id, does }) => ({ id, name: id.replaceAll("_", " "), does }))];
}
