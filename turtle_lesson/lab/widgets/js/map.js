// The map: the world from above. What the pointer and the keys do on it is up to the tool that they hold.

const WORLD = 11.088889; // side of turtlesim's square world, m
const MAP_EDGES = { left: 26, right: 10, top: 10, bottom: 24 }; // pixels around it, for the ticks
const TRAIL_BANDS = 10; // the older, the paler

/**
 * What the panels of one view share beside the model: the tools for the map, by the name of their panel.
 *
 * A tool has {name, hint, press(x, y), move(x, y), release(x, y), cancel(), key(event), draw(context, colour, pixel)}, of
 * places in metres; `pixel` is the size of a pixel in metres, `key` says whether it has used the key, and `says()`, where
 * there is one, what is then read out.
 */
function makeToolbox() {
  const watchers = [];
  const box = {
    tools: {},
    held: "goals",
    get tool() {
      return box.tools[box.held];
    },
    hold(name) {
      box.tool?.cancel();
      box.held = name;
      box.changed();
    },
    changed: () => watchers.forEach((watcher) => watcher()),
    watch: (watcher) => watchers.push(watcher),
  };
  return box;
}

function mapPanel(model, order, box) {
  const hint = element("p", { class: "tl-map-hint", id: `tl-${Math.random().toString(36).slice(2)}` });
  const { canvas, repaint, close } = sharpCanvas(
    { class: "tl-map", tabindex: 0, role: "application", "aria-label": "Map of the turtle's world", "aria-describedby": hint.id },
    draw,
  );
  const spoken = element("span", { class: "tl-unseen", role: "status", "aria-live": "polite" });
  const switches = element("div", { class: "tl-switch", role: "group", "aria-label": "What the map is for" });
  const showTool = () => {
    const tools = Object.entries(box.tools);
    switches.hidden = tools.length < 2;
    if (switches.children.length !== tools.length)
      switches.replaceChildren(
        ...tools.map(([name, tool]) => element("button", { type: "button", onclick: () => box.hold(name) }, tool.name)),
      );
    tools.forEach(([name], at) => switches.children[at].setAttribute("aria-pressed", String(name === box.held)));
    hint.textContent = box.tool?.hint ?? "";
    repaint();
  };
  box.watch(showTool);
  followMapPointer(canvas, box, repaint);
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !box.tool?.key(event)) return;
    event.preventDefault(); // or the page would scroll
    event.stopPropagation(); // or Jupyter would take the key for a shortcut
    spoken.textContent = box.tool.says?.() ?? "";
    repaint();
  });
  for (const name of ["focus", "blur"]) canvas.addEventListener(name, repaint);

  function draw(context, width, height, colour) {
    const { left, top, scale } = mapFrame(width, height);
    context.translate(left, top + WORLD * scale);
    drawTicks(context, scale, colour);
    context.scale(scale, -scale);
    drawWorld(context, model, box, colour, 1 / scale);
    if (box.tool) box.tool.draw(context, colour, 1 / scale);
  }

  const watch = Object.fromEntries(["pose", "trail", "tail", "scanned_from", "obstacles", "goals"].map((name) => [name, repaint]));
  const panel = element("div", { class: "tl-map-panel" }, canvas, spoken, hint);
  return { title: "Map", tools: switches, panel, close, watch };
}

/** Where the world is on a canvas of this size: its left and top edge in pixels, and pixels a metre. */
function mapFrame(width, height) {
  const { left, right, top, bottom } = MAP_EDGES;
  return { left, top, scale: Math.min(width - left - right, height - top - bottom) / WORLD };
}

/** Hand the pointer's doings to the tool: one pointer at a time, that begins within the world. */
function followMapPointer(canvas, box, repaint) {
  let pointer = null;
  const place = (event) => {
    const frame = canvas.getBoundingClientRect();
    const { left, top, scale } = mapFrame(frame.width, frame.height);
    return [(event.clientX - frame.left - left) / scale, WORLD - (event.clientY - frame.top - top) / scale];
  };
  const inside = (at) => at >= 0 && at <= WORLD;
  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = place(event);
    if (event.button || pointer !== null || !inside(x) || !inside(y)) return;
    pointer = event.pointerId;
    canvas.setPointerCapture(pointer);
    canvas.focus({ preventScroll: true });
    box.tool?.press(x, y);
    event.preventDefault();
    repaint();
  });
  const on = (name, action) =>
    canvas.addEventListener(name, (event) => {
      if (event.pointerId !== pointer) return;
      if (name !== "pointermove") pointer = null;
      action(...place(event));
      repaint();
    });
  on("pointermove", (x, y) => box.tool?.move(x, y));
  on("pointerup", (x, y) => box.tool?.release(x, y));
  on("pointercancel", () => box.tool?.cancel());
}

// -- drawing: below, the context's units are metres, y upwards --------------------------------------------------------

function drawTicks(context, scale, colour) {
  context.fillStyle = colour.grey;
  context.font = "11px system-ui, sans-serif";
  for (let at = 0; at <= 10; at += 2) {
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillText(at, at * scale, 7);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillText(at, -7, -at * scale);
  }
  context.textAlign = "right";
  context.textBaseline = "top";
  context.fillText(scale < 40 ? "m" : "x in m", WORLD * scale, 7);
  context.textBaseline = "middle";
  context.fillText("y", -7, -WORLD * scale + 4);
}

function drawWorld(context, model, box, colour, pixel) {
  drawFloor(context, colour, pixel);
  for (const each of box.obstacles?.() ?? model.get("obstacles")) drawObstacle(context, each, colour, pixel);
  const pose = floats(model.get("pose"));
  drawTrail(context, [floats(model.get("trail")), floats(model.get("tail")), pose.slice(0, 2)], colour, pixel);
  drawHits(context, floats(model.get("scanned_from")), floats(model.get("scan")), colour, pixel);
  if (Number.isFinite(pose[0])) turtle(context, ...pose.slice(0, 3), colour, Math.max(0.95, 38 * pixel));
  drawGoals(context, model.get("goals"), pose, colour, pixel); // above the turtle, which stands on a goal that it has reached
}

/** The floor with a line at each metre, and the walls. */
function drawFloor(context, colour, pixel) {
  context.fillStyle = colour.floor;
  context.fillRect(0, 0, WORLD, WORLD);
  context.beginPath();
  for (let at = 1; at < WORLD; at++) {
    context.moveTo(at, 0), context.lineTo(at, WORLD);
    context.moveTo(0, at), context.lineTo(WORLD, at);
  }
  context.strokeStyle = colour.line;
  context.lineWidth = pixel;
  context.stroke();
  context.strokeStyle = colour.wall;
  context.lineWidth = 2 * pixel;
  context.strokeRect(0, 0, WORLD, WORLD);
}

/** The outline of an obstacle, as a path. */
function outline(context, { shape, x, y, width, height, angle }, margin = 0) {
  context.save();
  context.translate(x, y);
  context.rotate(angle);
  context.beginPath();
  const [across, up] = [width / 2 + margin, height / 2 + margin];
  if (shape === "box") context.rect(-across, -up, 2 * across, 2 * up);
  else context.ellipse(0, 0, across, up, 0, 0, 2 * Math.PI);
  context.restore();
}

function drawObstacle(context, obstacle, colour, pixel) {
  outline(context, obstacle);
  context.fillStyle = colour.obstacle;
  context.strokeStyle = colour["obstacle-edge"];
  context.lineWidth = 1.5 * pixel;
  context.fill();
  context.stroke();
}

/** The parts of the trail, old to new and ever less pale; it breaks where the turtle was put elsewhere. */
function drawTrail(context, parts, colour, pixel) {
  const numbers = parts.flatMap((part) => [...part]);
  const count = numbers.length / 2;
  context.strokeStyle = colour.trail;
  context.lineWidth = 2.5 * pixel;
  context.lineJoin = "round";
  context.lineCap = "butt"; // or the bands would overlap in dots
  for (let band = 0; band < TRAIL_BANDS; band++) {
    const from = Math.floor((band * (count - 1)) / TRAIL_BANDS);
    const until = Math.floor(((band + 1) * (count - 1)) / TRAIL_BANDS);
    context.globalAlpha = 0.15 + (0.75 * (band + 1)) / TRAIL_BANDS;
    context.beginPath();
    for (let at = from, drawing = false; at <= until; at++) {
      const [x, y] = [numbers[2 * at], numbers[2 * at + 1]];
      if (!Number.isFinite(x)) drawing = false;
      else drawing ? context.lineTo(x, y) : context.moveTo(x, y), (drawing = true);
    }
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** The goal that the turtle is on its way to, with a line that leads there; or else the one where it last went. */
function drawGoals(context, goals, [x, y], colour, pixel) {
  const current = goals.find(({ state }) => state === "on its way");
  const goal = current ?? goals.findLast(({ state }) => state === "reached" || state === "not reached");
  if (!goal) return;
  if (current && Number.isFinite(x)) {
    context.setLineDash([5 * pixel, 5 * pixel]);
    context.strokeStyle = colour.goal;
    context.globalAlpha = 0.6;
    context.lineWidth = 1.5 * pixel;
    context.beginPath(), context.moveTo(x, y), context.lineTo(goal.x, goal.y), context.stroke();
    context.setLineDash([]);
  }
  context.globalAlpha = current ? 1 : 0.8;
  drawFlag(context, goal, colour, pixel);
  context.globalAlpha = 1;
}

/** A flag on the goal, the ring within which it counts as reached, and an arrow for the heading. */
function drawFlag(context, { x, y, theta }, colour, pixel, ghost = false) {
  context.save();
  context.translate(x, y);
  context.strokeStyle = context.fillStyle = colour.goal;
  context.lineWidth = 1.5 * pixel;
  context.lineCap = context.lineJoin = "round";
  if (ghost) context.setLineDash([4 * pixel, 4 * pixel]);
  context.beginPath(), context.arc(0, 0, 0.2, 0, 2 * Math.PI), context.stroke();
  context.setLineDash([]);
  if (theta != null) drawHeading(context, theta, pixel);
  if (!ghost) {
    context.strokeStyle = colour.ink;
    context.beginPath(), context.moveTo(0, 0), context.lineTo(0, 0.87), context.stroke();
    fillShape(context, [[0, 0.87], [0.44, 0.71], [0, 0.55]]);
  }
  context.restore();
}

function drawHeading(context, theta, pixel) {
  context.save();
  context.rotate(theta);
  context.lineWidth = 2.5 * pixel;
  context.beginPath(), context.moveTo(0.2, 0), context.lineTo(0.62, 0), context.stroke();
  fillShape(context, [[0.82, 0], [0.56, 0.13], [0.56, -0.13]]);
  context.restore();
}

function fillShape(context, corners) {
  context.beginPath();
  for (const corner of corners) context.lineTo(...corner);
  context.closePath();
  context.fill();
}

/** A dot where a beam of the laser met something. */
function drawHits(context, [x, y, theta], [angle, step, reach, ...ranges], colour, pixel) {
  if (x === undefined) return;
  context.fillStyle = colour.laser;
  ranges.forEach((range, beam) => {
    if (!(range > 0 && range < reach - 1e-3)) return;
    const turn = theta + angle + beam * step;
    const [across, up] = [x + range * Math.cos(turn), y + range * Math.sin(turn)];
    context.fillRect(across - 1.5 * pixel, up - 1.5 * pixel, 3 * pixel, 3 * pixel);
  });
}

/** A short text on the map: on a card, so that it can be read above everything. */
function drawLabel(context, x, y, text, colour, pixel) {
  context.save();
  context.translate(x, y);
  context.scale(pixel, -pixel);
  context.font = "12px system-ui, sans-serif";
  const width = context.measureText(text).width + 14;
  const metres = width * pixel;
  const left = x + metres / 2 > WORLD ? -width : x - metres / 2 < 0 ? 0 : -width / 2;
  const top = y > WORLD - 1.6 ? 34 : -54;
  context.fillStyle = colour.floor;
  context.strokeStyle = colour.line;
  context.lineWidth = 1;
  context.beginPath(), context.roundRect(left, top, width, 22, 6), context.fill(), context.stroke();
  context.fillStyle = colour.ink;
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillText(text, left + 7, top + 11.5);
  context.restore();
}

// -- the turtle, the same as in the plots: a metre long, looking along x; ellipses are x, y, width, height, degrees ---

const TURTLE = {
  tail: [[-0.33, 0.055], [-0.49, 0], [-0.33, -0.055]],
  legs: [[0.23, 0.27, 0.3, 0.15, 55], [-0.25, 0.25, 0.24, 0.13, 128]],
  head: [0.4, 0, 0.25, 0.21, 0],
  eye: [0.455, 0.058, 0.042, 0.042, 0],
  body: [-0.02, 0, 0.7, 0.58, 0],
  back: [-0.02, 0, 0.57, 0.45, 0],
  colours: { skin: "#8fd0b5", rim: "#00785a", shell: "#009e73", outline: "#0b4636", plates: "#d8f3e6" },
}; // prettier-ignore

function turtle(context, x, y, theta, colour, length = 0.95) {
  const { tail, legs, head, eye, body, back, colours } = TURTLE;
  context.save();
  context.translate(x, y);
  context.rotate(theta);
  context.scale(length, length);
  context.lineWidth = 0.018;
  context.lineJoin = context.lineCap = "round";
  context.strokeStyle = colours.outline;
  context.fillStyle = colours.skin;
  fillShape(context, tail), context.stroke();
  for (const leg of legs) for (const side of [1, -1]) oval(context, leg, colours.skin, side), context.stroke();
  oval(context, head, colours.skin), context.stroke();
  for (const side of [1, -1]) oval(context, eye, colours.outline, side);
  oval(context, body, colours.rim), context.stroke();
  oval(context, back, colours.shell);
  drawPlates(context, back, colours.plates);
  context.restore();
}

function oval(context, [x, y, width, height, degrees], colour, side = 1) {
  context.beginPath();
  context.ellipse(x, side * y, width / 2, height / 2, (side * degrees * Math.PI) / 180, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
}

/** The plates of the shell: a hexagon along the back, and a line from each of its corners to the rim. */
function drawPlates(context, [middle, , width, height], colour) {
  const corners = [0, 1, 2, 3, 4, 5].map((sixth) => [Math.cos((sixth * Math.PI) / 3), Math.sin((sixth * Math.PI) / 3)]);
  const at = ([across, up], part) => [middle + (part * across * width) / 2, (part * up * height) / 2];
  context.beginPath();
  corners.forEach((corner, number) => (number ? context.lineTo(...at(corner, 0.51)) : context.moveTo(...at(corner, 0.51))));
  context.closePath();
  for (const corner of corners) context.moveTo(...at(corner, 0.51)), context.lineTo(...at(corner, 1));
  context.strokeStyle = colour;
  context.stroke();
}
