// The map: the world from above, and the goal that a click or a drag sets.

const WORLD = 11.088889;

function mapPanel(model, order) {
  let drag = null; // {x, y, theta} in the world, while the pointer is down
  const { canvas, repaint, close } = sharpCanvas(
    { class: "tl-map", tabindex: 0, role: "application", "aria-label": "Map of the turtle's world. Click to send the turtle there." },
    draw,
  );

  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    const size = Math.min(box.width, box.height);
    return [((event.clientX - box.left) / size) * WORLD, (1 - (event.clientY - box.top) / size) * WORLD];
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button) return;
    canvas.setPointerCapture(event.pointerId);
    const [x, y] = place(event);
    drag = { x, y, theta: null };
    repaint();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const [x, y] = place(event);
    if (Math.hypot(x - drag.x, y - drag.y) > 0.25) drag.theta = Math.atan2(y - drag.y, x - drag.x);
    repaint();
  });
  canvas.addEventListener("pointerup", () => {
    if (!drag) return;
    const [tx, ty] = floats(model.get("pose"));
    const ahead = Math.atan2(drag.y - ty, drag.x - tx);
    const theta = drag.theta ?? (Number.isFinite(ahead) ? ahead : 0);
    order("goal", { x: drag.x, y: drag.y, theta });
    drag = null;
    repaint();
  });

  function draw(context, width, height, colour) {
    const scale = Math.min(width, height) / WORLD;
    context.setTransform(context.getTransform().translate(0, WORLD * scale).scale(scale, -scale));
    grid(context, colour);
    for (const each of model.get("obstacles")) obstacle(context, each, colour);
    trail(context, floats(model.get("trail")), colour);
    const [x, y, theta] = floats(model.get("pose"));
    const goals = model.get("goals");
    const goal = drag ?? goals[goals.length - 1];
    if (goal) flag(context, goal, colour);
    if (Number.isFinite(x)) turtle(context, x, y, theta, colour);
  }

  return { panel: canvas, close, watch: { pose: repaint, trail: repaint, obstacles: repaint, goals: repaint } };
}

function grid(context, colour) {
  context.fillStyle = colour.floor;
  context.fillRect(0, 0, WORLD, WORLD);
  context.strokeStyle = colour.line;
  context.lineWidth = 0.02;
  context.beginPath();
  for (let at = 1; at < WORLD; at++) {
    context.moveTo(at, 0), context.lineTo(at, WORLD), context.moveTo(0, at), context.lineTo(WORLD, at);
  }
  context.stroke();
}

function obstacle(context, { shape, x, y, width, height, angle }, colour) {
  context.save();
  context.translate(x, y);
  context.rotate(angle);
  context.beginPath();
  if (shape === "box") context.rect(-width / 2, -height / 2, width, height);
  else context.ellipse(0, 0, width / 2, height / 2, 0, 0, 2 * Math.PI);
  context.fillStyle = colour.obstacle;
  context.strokeStyle = colour["obstacle-edge"];
  context.lineWidth = 0.04;
  context.fill(), context.stroke();
  context.restore();
}

function trail(context, points, colour) {
  context.beginPath();
  for (let at = 0; at + 1 < points.length; at += 2) context.lineTo(points[at], points[at + 1]);
  context.strokeStyle = colour.trail;
  context.lineWidth = 0.06;
  context.lineJoin = "round";
  context.stroke();
}

function flag(context, { x, y, theta }, colour) {
  context.save();
  context.translate(x, y);
  context.strokeStyle = context.fillStyle = colour.goal;
  context.lineWidth = 0.05;
  context.beginPath(), context.arc(0, 0, 0.2, 0, 2 * Math.PI), context.stroke();
  if (theta != null) {
    context.rotate(theta);
    context.beginPath(), context.moveTo(0, 0), context.lineTo(0.7, 0), context.stroke();
    context.beginPath(), context.moveTo(0.85, 0), context.lineTo(0.6, 0.12), context.lineTo(0.6, -0.12), context.fill();
  }
  context.restore();
}

/** The turtle from above, a metre long, looking along theta: the same drawing as in the plots. */
function turtle(context, x, y, theta, colour) {
  const ellipse = (ex, ey, width, height, turn, fill) => {
    context.beginPath();
    context.ellipse(ex, ey, width / 2, height / 2, (turn * Math.PI) / 180, 0, 2 * Math.PI);
    context.fillStyle = fill;
    context.fill(), context.stroke();
  };
  context.save();
  context.translate(x, y);
  context.rotate(theta);
  context.scale(0.95, 0.95);
  context.lineWidth = 0.018;
  context.strokeStyle = "#0b4636";
  for (const [ex, ey, width, height, turn] of [[0.23, 0.27, 0.3, 0.15, 55], [-0.25, 0.25, 0.24, 0.13, 128]])
    for (const side of [1, -1]) ellipse(ex, side * ey, width, height, side * turn, "#8fd0b5");
  ellipse(0.4, 0, 0.25, 0.21, 0, "#8fd0b5");
  ellipse(-0.02, 0, 0.7, 0.58, 0, "#00785a");
  ellipse(-0.02, 0, 0.57, 0.45, 0, "#009e73");
  context.restore();
}
