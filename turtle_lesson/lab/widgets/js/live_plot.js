// Curves that go on: drawn on a canvas, with their names and last numbers beside their ends.

// As in live_plot.py; names of the style sheet's colours, which differ in a dark page.
const CURVES = [
  ["c1", []], ["c2", [9, 4]], ["c3", [3, 3]], ["c4", [12, 4, 3, 4]], ["c5", []], ["c6", [9, 4]], ["ink", [3, 3]], ["grey", []],
]; // prettier-ignore
const EDGE = { left: 58, right: 100, top: 16, bottom: 40 };

function plotPanel(model) {
  const { canvas, repaint, close } = sharpCanvas({ class: "tl-plot", role: "img" }, draw);
  const notes = element("ul", { class: "tl-notes" });
  const panel = element("div", {}, canvas, notes);
  let said = "";
  let room = EDGE.right; // for the labels; it only grows, so that the picture stays where it is

  const showCurves = () => {
    const missing = model.get("curves").filter((curve) => curve.note);
    const text = JSON.stringify(missing.map((curve) => [curve.topic, curve.note]));
    if (text !== said)
      notes.replaceChildren(...missing.map(({ name, topic, note }) => element("li", {}, element("b", {}, topic.endsWith(name) ? topic : `${topic}/${name}`), ` ${note}`)));
    said = text;
    repaint();
  };
  const showLabel = () => canvas.setAttribute("aria-label", model.get("label"));

  function draw(context, width, height, colour) {
    context.font = "600 12px system-ui, sans-serif";
    for (const { name, last } of model.get("curves")) room = Math.max(room, 46 + context.measureText(`${name} ${last}`).width);
    const area = { ...EDGE, right: Math.min(room, 0.3 * width), width, height };
    const curves = readPoints(floats(model.get("points")));
    const until = model.get("now"), since = until - model.get("seconds");
    const [low, high, step] = niceRange(curves);
    const x = (time) => area.left + ((time - since) / (until - since)) * (width - area.left - area.right);
    const y = (value) => height - area.bottom - ((value - low) / (high - low)) * (height - area.top - area.bottom);
    context.font = "12px system-ui, sans-serif";
    valueAxis(context, area, y, low, high, step, colour);
    timeAxis(context, area, x, since, until, model.get("anchor"), colour);
    curves.forEach((points, index) => curveLine(context, area, points, x, y, index, colour));
    endLabels(context, area, curves, model.get("curves"), y, colour);
  }
  const watch = { points: repaint, now: repaint, seconds: repaint, curves: showCurves, label: showLabel };
  return { panel, watch, close };
}

/** One flat array of [time, number, time, number, …] for each curve. */
function readPoints(all) {
  const curves = [];
  for (let at = 0; at < all.length; at += 1 + 2 * all[at]) curves.push(all.subarray(at + 1, at + 1 + 2 * all[at]));
  return curves;
}

/** A range of round numbers that holds all values, and the step of its grid. */
function niceRange(curves) {
  let [low, high] = [Infinity, -Infinity];
  for (const points of curves)
    for (let at = 1; at < points.length; at += 2)
      if (Number.isFinite(points[at])) (low = Math.min(low, points[at])), (high = Math.max(high, points[at]));
  if (low > high) return [0, 1, 0.25];
  const least = Math.max(1e-6, Math.abs(high) * 1e-3, high - low ? 0 : 1); // a constant is a line in the middle
  if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
  const rough = (high - low) / 4;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].find((each) => each * power >= rough) * power;
  return [Math.floor(low / step) * step, Math.ceil(high / step) * step, step];
}

function valueAxis(context, area, y, low, high, step, colour) {
  const digits = Math.max(0, Math.min(8, Math.ceil(1e-9 - Math.log10(step)) + (/^25/.test(step.toExponential().replace(".", "")) ? 1 : 0)));
  context.textAlign = "right", context.textBaseline = "middle";
  for (let value = low; value <= high + step / 2; value += step) {
    const at = Math.round(y(value)) + 0.5;
    context.strokeStyle = colour.line, context.lineWidth = 1;
    context.beginPath(), context.moveTo(area.left, at), context.lineTo(area.width - area.right, at), context.stroke();
    context.fillStyle = colour.grey;
    context.fillText(Math.abs(value) < 1e5 ? figure(value, digits) : value.toPrecision(3), area.left - 8, at);
  }
} // prettier-ignore

function timeAxis(context, area, x, since, until, anchor, colour) {
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1200].find((each) => (until - since) / each <= 7) ?? 1200;
  const floor = area.height - area.bottom;
  context.textAlign = "center", context.textBaseline = "top";
  context.fillStyle = colour.grey, context.strokeStyle = colour.line;
  for (let time = Math.ceil((since + anchor) / step) * step; time <= until + anchor + 1e-9; time += step) {
    if (time < 0) continue; // robot time begins at 0
    const at = Math.round(x(time - anchor)) + 0.5;
    context.beginPath(), context.moveTo(at, area.top), context.lineTo(at, floor), context.stroke();
    context.fillText(figure(time, step < 1 ? 1 : 0), at, floor + 6);
  }
  context.fillText("robot time in seconds", (area.left + area.width - area.right) / 2, floor + 23);
} // prettier-ignore

function curveLine(context, area, points, x, y, index, colour) {
  const [name, dashes] = CURVES[index];
  context.save();
  context.beginPath();
  context.rect(area.left, 0, area.width - area.left - area.right + 1, area.height);
  context.clip();
  context.beginPath();
  let gap = true;
  for (let at = 0; at + 1 < points.length; at += 2) {
    if (!Number.isFinite(points[at + 1])) gap = true;
    else if (gap) context.moveTo(x(points[at]), y(points[at + 1])), (gap = false);
    else context.lineTo(x(points[at]), y(points[at + 1]));
  }
  context.setLineDash(dashes);
  Object.assign(context, { strokeStyle: colour[name], lineWidth: 2, lineJoin: "round" });
  context.stroke();
  context.restore();
}

/** Names and last numbers at the right, moved apart where curves end close together. */
function endLabels(context, area, curves, told, y, colour) {
  const labels = told
    .map(({ name, last }, index) => ({ name, last, index, at: y(lastNumber(curves[index] ?? [])) }))
    .filter(({ at }) => Number.isFinite(at))
    .sort((one, other) => one.at - other.at);
  for (let each = 1; each < labels.length; each++) labels[each].at = Math.max(labels[each].at, labels[each - 1].at + 17);
  const over = labels.length ? Math.max(0, labels[labels.length - 1].at - (area.height - area.bottom)) : 0;
  context.textAlign = "left", context.textBaseline = "middle";
  const begin = area.width - area.right + 8;
  for (const { name, last, index, at } of labels) {
    const [hue, dashes] = CURVES[index];
    Object.assign(context, { strokeStyle: colour[hue], fillStyle: colour.ink, lineWidth: 2.5 });
    context.setLineDash(dashes.map((dash) => dash * 0.7));
    context.beginPath(), context.moveTo(begin, at - over), context.lineTo(begin + 20, at - over), context.stroke();
    context.setLineDash([]);
    context.font = "600 12px system-ui, sans-serif";
    const value = ` ${last.replace("-", "−")}`;
    const room = area.right - 38 - context.measureText(value).width;
    context.fillText(shortened(context, name, room) + value, begin + 25, at - over);
  }
} // prettier-ignore

/** A name that fits: its end, which tells most, is kept. */
function shortened(context, name, room) {
  if (context.measureText(name).width <= room) return name;
  let kept = name;
  while (kept.length > 1 && context.measureText(`…${kept}`).width > room) kept = kept.slice(1);
  return `…${kept}`;
}

function lastNumber(points) {
  for (let at = points.length - 1; at > 0; at -= 2) if (Number.isFinite(points[at])) return points[at];
  return NaN;
}

export default { initialize: handOut, render: (context) => mount(context, "live", "Live plot", plotPanel) };
