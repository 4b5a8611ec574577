// @ts-check
/**
 * The marks of a reading, the same in all pictures: a dot is believed and right, a triangle is believed and wrong, a
 * cross is rejected, a ring is not yet compared. They differ in shape, so colour is not needed.
 */

/** @typedef {"right" | "wrong" | "rejected" | "first"} Mark */

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Mark} mark
 * @param {number} x @param {number} y @param {number} size Half its width.
 * @param {import("./colours.js").Colours} colours
 */
export function drawMark(context, mark, x, y, size, colours) {
  context.lineWidth = Math.max(1.5, size * 0.4);
  context.beginPath();
  if (mark === "right") {
    context.arc(x, y, size * 0.9, 0, 2 * Math.PI);
  } else if (mark === "wrong") {
    context.moveTo(x, y - size * 1.3);
    context.lineTo(x + size * 1.25, y + size * 0.95);
    context.lineTo(x - size * 1.25, y + size * 0.95);
    context.closePath();
  } else if (mark === "rejected") {
    context.moveTo(x - size, y - size);
    context.lineTo(x + size, y + size);
    context.moveTo(x - size, y + size);
    context.lineTo(x + size, y - size);
    context.strokeStyle = colours.rejected;
    context.stroke();
    return;
  } else {
    context.arc(x, y, size * 0.7, 0, 2 * Math.PI);
    context.strokeStyle = colours.rejected;
    context.stroke();
    return;
  }
  context.fillStyle = mark === "right" ? colours.right : colours.wrong;
  context.fill();
  context.lineWidth = 1;
  context.strokeStyle = colours.floor;
  context.stroke();
}

/**
 * @param {{verdict: string, wrong: boolean, t_echo_us: number | null}} reading
 * @returns {Mark | null} Null for no echo.
 */
export function markOf(reading) {
  if (reading.t_echo_us === null) return null;
  if (reading.verdict === "accepted") return reading.wrong ? "wrong" : "right";
  return reading.verdict === "rejected" ? "rejected" : "first";
}
