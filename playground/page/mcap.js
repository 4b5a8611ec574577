// @ts-check
/**
 * Readings as an MCAP file (mcap.dev/spec) for Foxglove and similar programs: one message in JSON for each reading.
 * Chunks, index and check sums are optional in the format. Without them a file is a sequence of records, each a letter,
 * its length and its fields; a library would be larger than this code.
 */

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const HEADER = 1;
const FOOTER = 2;
const SCHEMA = 3;
const CHANNEL = 4;
const MESSAGE = 5;
const DATA_END = 15;

/** The fields of a message. Times in microseconds; sensors from 0. */
const READING = {
  type: "object",
  title: "eeruf.Reading",
  properties: {
    method: { type: "string" },
    sensor: { type: "integer" },
    period: { type: "integer" },
    phase: { type: "integer" },
    t_echo_us: { type: ["number", "null"] },
    reference_us: { type: ["number", "null"] },
    verdict: { type: "string" },
    wrong: { type: "boolean" },
    cause: { type: "string" },
    emitter: { type: ["integer", "null"] },
  },
};

/** Little-endian fields, one after the other. */
class Fields {
  constructor() {
    /** @type {number[]} */
    this.bytes = [];
  }

  /** @param {number | bigint} value @param {number} size In bytes. */
  whole(value, size) {
    for (let k = 0, rest = BigInt(value); k < size; k++, rest >>= 8n) this.bytes.push(Number(rest & 255n));
    return this;
  }

  /** @param {Uint8Array | number[]} bytes */
  raw(bytes) {
    for (const byte of bytes) this.bytes.push(byte);
    return this;
  }

  /** @param {string} text */
  text(text) {
    const bytes = new TextEncoder().encode(text);
    return this.whole(bytes.length, 4).raw(bytes);
  }

  /** @param {number} letter @param {Fields} fields */
  record(letter, fields) {
    return this.whole(letter, 1).whole(fields.bytes.length, 8).raw(fields.bytes);
  }
}

/**
 * @param {{method: string, readings: import("./run.js").Reading[]}[]} runs Each becomes a channel.
 * @returns {Uint8Array} The file.
 */
export function mcapOf(runs) {
  const file = new Fields().raw(MAGIC).record(HEADER, new Fields().text("").text("eeruf"));
  file.record(SCHEMA, new Fields().whole(1, 2).text(READING.title).text("jsonschema").text(JSON.stringify(READING)));
  runs.forEach(({ method }, channel) => {
    file.record(
      CHANNEL,
      new Fields().whole(channel, 2).whole(1, 2).text(`/readings/${method}`).text("json").whole(0, 4),
    );
  });
  const messages = runs.flatMap(({ method, readings }, channel) =>
    readings.map((reading) => ({ method, channel, reading })),
  );
  messages.sort((a, b) => a.reading.heard - b.reading.heard);
  messages.forEach(({ method, channel, reading }, sequence) => {
    const { sensor, period, phase, t_echo_us, reference_us, verdict, wrong, cause, way } = reading;
    const body = {
      method,
      sensor,
      period,
      phase,
      t_echo_us,
      reference_us,
      verdict,
      wrong,
      cause,
      emitter: way?.emitter ?? null,
    };
    const time = BigInt(Math.round(1e9 * reading.heard));
    file.record(
      MESSAGE,
      new Fields()
        .whole(channel, 2)
        .whole(sequence, 4)
        .whole(time, 8)
        .whole(time, 8)
        .raw(new TextEncoder().encode(JSON.stringify(body))),
    );
  });
  file.record(DATA_END, new Fields().whole(0, 4)).record(FOOTER, new Fields().whole(0, 8).whole(0, 8).whole(0, 4));
  return Uint8Array.from(file.raw(MAGIC).bytes);
}
