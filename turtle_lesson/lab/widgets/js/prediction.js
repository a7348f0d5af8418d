// A question and the guess, recorded before something is run.

function predictionPanel(model, order) {
  const id = freshId();
  const send = (value) => order("guess", { value });
  const ways = { choice: choiceGuess, number: numberGuess, point: pointGuess };
  const way = ways[model.get("kind")](model, send, id);
  const body = element("fieldset", { class: "tl-guess" }, element("legend", { id }, model.get("question")), way.control);
  const closed = element("p", { class: "tl-note" }, "The outcome is known. Run this cell again to make a new guess.");
  const show = () => {
    way.show(model.get("guess"));
    body.disabled = !model.get("is_open");
    closed.hidden = model.get("is_open");
  };
  const panel = element("div", { class: "tl-prediction" }, body, closed);
  return { panel, watch: { guess: show, is_open: show, turtle: show, goal: show }, close: way.close };
}

function choiceGuess(model, send) {
  const buttons = model.get("choices").map((text) => button(text, () => send(text), { "aria-pressed": "false" }));
  const show = (guess) => buttons.forEach((each, at) => each.setAttribute("aria-pressed", String(model.get("choices")[at] === guess)));
  return { control: element("div", { class: "tl-choices" }, ...buttons), show };
}

function numberGuess(model, send, id) {
  const record = () => send(input.value);
  const enter = (event) => event.key === "Enter" && record(); // in Jupyter, Enter submits no form
  const input = element("input", { type: "text", size: 12, "aria-labelledby": id, onkeydown: enter });
  const form = element("div", { class: "tl-choices" }, input, model.get("unit"), button("Record", record));
  const show = (guess) => {
    if (guess != null) input.value = figure(guess, 3).replace(/\.?0+$/, "");
  };
  return { control: form, show };
}

const GUESS_MARGIN = 24; // pixels left of the map and below it, for the figures

function pointGuess(model, send, id) {
  const world = model.get("world");
  let at = null;
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const within = (value) => Math.min(world, Math.max(0, value));
  const label = element("span", { "aria-live": "polite" });
  const move = (x, y) => {
    at = [within(x), within(y)];
    label.textContent = `your guess: (${figure(at[0])}, ${figure(at[1])}) m`;
    repaint();
  };
  const known = () => {
    const [turtleAt, goal] = [model.get("turtle"), model.get("goal")];
    const place = ([x, y]) => `(${figure(x)}, ${figure(y)}) m`;
    return [turtleAt && `the turtle: ${place(turtleAt)}`, goal && `its goal, the flag: ${place([goal.x, goal.y])}`].filter(Boolean);
  };
  const help = "Arrow keys move the mark, with Shift in small steps; Enter records it";
  const { canvas, repaint, close } = sharpCanvas(
    { class: "tl-guess-map", tabindex: 0, role: "application", "aria-labelledby": id, "aria-describedby": `${id}-key`, "aria-description": help },
    (context, width, height, colour) => drawGuess(context, (width - GUESS_MARGIN) / world, model, at, colour),
  );
  canvas.addEventListener("click", (event) => {
    if (!model.get("is_open")) return;
    const frame = canvas.getBoundingClientRect();
    const scale = (frame.width - GUESS_MARGIN) / world;
    move((event.clientX - frame.left - GUESS_MARGIN) / scale, world - (event.clientY - frame.top) / scale);
    send(at);
  });
  canvas.addEventListener("keydown", (event) => {
    if (!model.get("is_open")) return;
    if (steps[event.key]) {
      const [x, y] = at ?? [world / 2, world / 2];
      const far = event.shiftKey ? 0.1 : 0.5;
      move(x + steps[event.key][0] * far, y + steps[event.key][1] * far);
    } else if (event.key === "Enter" && at) send(at);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  const show = (guess) => {
    keyLines.replaceChildren(...known().map((line) => element("span", {}, line)));
    guess ? move(...guess) : repaint();
  };
  const keyLines = element("div", { id: `${id}-key`, class: "tl-guess-key" });
  label.textContent = "your guess: click, or use the arrow keys and Enter";
  return { control: element("div", { class: "tl-choices" }, canvas, element("div", { class: "tl-guess-key" }, keyLines, label)), show, close };
}

function drawGuess(context, scale, model, at, colour) {
  const side = model.get("world") * scale;
  const pixel = 1 / scale;
  context.translate(GUESS_MARGIN, 0);
  drawGuessFigures(context, scale, side, colour);
  context.translate(0, side);
  context.scale(scale, -scale);
  drawFloor(context, colour, pixel);
  if (model.get("turtle")) turtle(context, ...model.get("turtle"), colour);
  if (model.get("goal")) drawFlag(context, model.get("goal"), colour, pixel);
  if (!at) return;
  context.strokeStyle = colour.accent;
  context.lineWidth = 3 * pixel;
  context.beginPath(), context.arc(...at, 8 * pixel, 0, 2 * Math.PI), context.stroke();
}

function drawGuessFigures(context, scale, side, colour) {
  context.fillStyle = colour.grey;
  context.font = "11px system-ui, sans-serif";
  for (let metre = 0; metre <= 10; metre += 2) {
    context.textAlign = metre ? "center" : "left";
    context.textBaseline = "top";
    context.fillText(metre === 10 ? "10 m" : metre, metre * scale, side + 6);
    context.textAlign = "right";
    context.textBaseline = metre ? "middle" : "bottom";
    context.fillText(metre, -6, side - metre * scale);
  }
}

export default { initialize: handOut, render: (context) => mount(context, "prediction", "Prediction", predictionPanel) };
