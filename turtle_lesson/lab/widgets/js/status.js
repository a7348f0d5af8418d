// The status: a strip of the last 30 seconds for each number, all on the same axis of time.

const STATUS_WINDOW = 30;
const STATUS_COLUMNS = 6; // time, x, y, heading, speed, battery
const STATUS_STEP = 0.1; // seconds after which the curves move on where no status comes
const STATUS_EDGE = 4; // pixels left free above and below a curve
const STATUS_RIGHT = 34; // and beside it, for the highest and the lowest value

const STRIPS = [
  { name: "x", unit: "m", column: 1, least: 2 },
  { name: "y", unit: "m", column: 2, least: 2 },
  { name: "heading", unit: "°", column: 3, scale: 180 / Math.PI, digits: 0, range: [-180, 180], wraps: true },
  { name: "speed", unit: "m/s", column: 4, least: 1, from: 0, filled: true },
  { name: "battery", unit: "%", column: 5, digits: 1, range: [0, 100], filled: true },
];

function statusPanel(model) {
  const strips = STRIPS.map(makeStrip);
  const note = element("p", { class: "tl-note", role: "note" });
  const axis = element("div", { class: "tl-strip-axis", "aria-hidden": "true" });
  for (const text of ["30 s ago", "20 s", "10 s", "now"]) axis.append(element("span", {}, text));
  axis.style.marginRight = `${STATUS_RIGHT}px`;
  const panel = element("div", { class: "tl-status" }, ...strips.flatMap(({ parts }) => parts), axis, note);

  let shown = NaN;
  const show = () => {
    shown = model.get("now");
    const rows = statusRows(model);
    for (const strip of strips) strip.show(rows);
  };
  const goOn = () => Math.abs(model.get("now") - shown) < STATUS_STEP || show();
  const showNote = () => (note.textContent = model.get("status_note"));
  const close = () => strips.forEach((strip) => strip.close());
  return { title: "Status", aside: "/robot/status", panel, close, watch: { status: show, status_tip: show, now: goOn, status_note: showNote } };
}

/** The statuses of the window, in the order in which they came: age, x, y, heading, speed, battery of each. */
function statusRows(model) {
  const all = [...floats(model.get("status")), ...floats(model.get("status_tip"))];
  const now = model.get("now") - model.get("status_from");
  const rows = [];
  for (let at = 0; at < all.length; at += STATUS_COLUMNS)
    if (now - all[at] <= STATUS_WINDOW) rows.push(now - all[at], ...all.slice(at + 1, at + STATUS_COLUMNS));
  return rows;
}

function makeStrip(strip) {
  let points = [];
  const value = element("span", { class: "tl-strip-value" });
  const name = element("span", { class: "tl-strip-name" }, strip.name);
  const look = { class: `tl-strip tl-strip-${strip.name}`, "aria-hidden": "true" };
  const { canvas, repaint, close } = sharpCanvas(look, (context, width, height, colour) =>
    drawStrip(context, width, height, colour, strip, points),
  );
  const show = (rows) => {
    points = stripPoints(rows, strip);
    const last = rows.length ? rows[rows.length - STATUS_COLUMNS + strip.column] * (strip.scale ?? 1) : NaN;
    value.replaceChildren(figure(last, strip.digits ?? 2), element("small", {}, strip.unit));
    repaint();
  };
  return { parts: [name, canvas, value], show, close };
}

/** The points of one strip: [age, value], in the order in which they came. */
function stripPoints(rows, { column, scale = 1 }) {
  const points = [];
  for (let at = 0; at < rows.length; at += STATUS_COLUMNS) points.push([rows[at], rows[at + column] * scale]);
  return points;
}

/** From the lowest to the highest value that a strip shows: whole numbers, so that it seldom changes. */
function stripRange({ range, least, from }, points) {
  if (range) return range;
  const values = points.map(([, value]) => value).filter(Number.isFinite);
  if (!values.length) return [from ?? 0, (from ?? 0) + least];
  let low = from ?? Math.floor(Math.min(...values));
  let high = Math.ceil(Math.max(...values));
  if (from == null && high - low < least) low = Math.floor((low + high - least) / 2);
  return [low, Math.max(high, low + least)];
}

function drawStrip(context, width, height, colour, strip, points) {
  const [low, high] = stripRange(strip, points);
  const right = width - STATUS_RIGHT;
  const acrossOf = (age) => right * (1 - age / STATUS_WINDOW);
  const upOf = (value) => height - STATUS_EDGE - ((value - low) / (high - low)) * (height - 2 * STATUS_EDGE);
  context.strokeStyle = colour.line;
  context.lineWidth = 1;
  context.beginPath();
  for (const age of [30, 20, 10, 0]) line(context, Math.round(acrossOf(age)) + 0.5, 0, null, height);
  for (const value of [low, high]) line(context, 0, Math.round(upOf(value)) + 0.5, right, null);
  context.stroke();
  context.fillStyle = colour.grey;
  context.font = "10px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.fillText(figure(high, 0), right + 5, upOf(high) + 2);
  context.fillText(figure(low, 0), right + 5, upOf(low) - 2);
  context.strokeStyle = context.fillStyle = colour[strip.name];
  for (const run of stripRuns(points, strip)) drawRun(context, run, acrossOf, upOf, strip.filled);
}

function line(context, x, y, toX, toY) {
  context.moveTo(x, y);
  context.lineTo(toX ?? x, toY ?? y);
}

/** A strip's points in pieces: a curve ends where no status came for a second, and where a heading passes 180°. */
function stripRuns(points, { wraps }) {
  const runs = [];
  let last = null;
  for (const point of points) {
    if (!Number.isFinite(point[1])) last = null;
    else {
      const broken = !last || last[0] - point[0] > 1 || (wraps && Math.abs(last[1] - point[1]) > 180);
      if (broken) runs.push([]);
      runs[runs.length - 1].push(point);
      last = point;
    }
  }
  return runs;
}

function drawRun(context, run, acrossOf, upOf, filled) {
  const path = new Path2D();
  for (const [age, value] of run) path.lineTo(acrossOf(age), upOf(value));
  context.lineWidth = 1.75;
  context.lineJoin = context.lineCap = "round";
  context.stroke(path);
  if (!filled) return;
  path.lineTo(acrossOf(run[run.length - 1][0]), upOf(0));
  path.lineTo(acrossOf(run[0][0]), upOf(0));
  context.globalAlpha = 0.14;
  context.fill(path);
  context.globalAlpha = 1;
}
