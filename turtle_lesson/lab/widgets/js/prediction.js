// A question and the guess, recorded before something is run.

function predictionPanel(model, order) {
  const id = freshId();
  const send = (value) => order("guess", { value });
  const ways = { choice: choiceGuess, number: numberGuess, point: pointGuess };
  const way = ways[model.get("kind")](model, send, id);
  const body = element("fieldset", { class: "tl-guess" }, element("legend", { id }, model.get("question")), way.control);
  const closed = element("p", { class: "tl-note" }, "The outcome is known. Run this cell again to guess anew.");
  const show = () => {
    way.show(model.get("guess"));
    body.disabled = !model.get("is_open");
    closed.hidden = model.get("is_open");
  };
  const panel = element("div", { class: "tl-prediction" }, body, closed);
  return { panel, watch: { guess: show, is_asking: show }, close: way.close };
}

function choiceGuess(model, send) {
  const buttons = model.get("choices").map((text) => button(text, () => send(text), { "aria-pressed": "false" }));
  const show = (guess) => buttons.forEach((each, at) => each.setAttribute("aria-pressed", String(model.get("choices")[at] === guess)));
  return { control: element("div", { class: "tl-choices" }, ...buttons), show };
}

function numberGuess(model, send, id) {
  const input = element("input", { type: "text", inputmode: "decimal", size: 8, "aria-labelledby": id });
  const form = element(
    "form",
    { class: "tl-choices", onsubmit: (event) => (event.preventDefault(), send(input.value)) },
    input,
    model.get("unit"),
    element("button", { type: "submit", class: "tl-button" }, "Record"),
  );
  const show = (guess) => {
    if (guess != null) input.value = figure(guess, 3).replace(/\.?0+$/, "");
  };
  return { control: form, show };
}

function pointGuess(model, send, id) {
  const world = model.get("world");
  let at = null;
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const within = (value) => Math.min(world, Math.max(0, value));
  const label = element("span", { "aria-live": "polite" });
  const move = (x, y) => {
    at = [within(x), within(y)];
    label.textContent = `(${figure(at[0])}, ${figure(at[1])}) m`;
    repaint();
  };
  const { canvas, repaint, close } = sharpCanvas(
    { class: "tl-guess-map", tabindex: 0, role: "application", "aria-labelledby": id, "aria-description": "Arrow keys move the mark, Enter records it" },
    (context, width, height, colour) => drawGuess(context, width / world, world, at, colour),
  );
  canvas.addEventListener("click", (event) => {
    const frame = canvas.getBoundingClientRect();
    move(((event.clientX - frame.left) / frame.width) * world, (1 - (event.clientY - frame.top) / frame.height) * world);
    if (model.get("is_open")) send(at);
  });
  canvas.addEventListener("keydown", (event) => {
    if (step[event.key]) {
      const [x, y] = at ?? [world / 2, world / 2];
      const far = event.shiftKey ? 0.1 : 0.5;
      move(x + step[event.key][0] * far, y + step[event.key][1] * far);
    } else if (event.key === "Enter" && at) send(at);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  const show = (guess) => guess && move(...guess);
  return { control: element("div", { class: "tl-choices" }, canvas, label), show, close };
}

function drawGuess(context, scale, world, at, colour) {
  context.fillStyle = colour.floor;
  context.fillRect(0, 0, world * scale, world * scale);
  context.strokeStyle = colour.line;
  context.beginPath();
  for (let metre = 1; metre < world; metre++) {
    context.moveTo(metre * scale, 0), context.lineTo(metre * scale, world * scale);
    context.moveTo(0, metre * scale), context.lineTo(world * scale, metre * scale);
  }
  context.stroke();
  context.strokeStyle = colour.wall;
  context.lineWidth = 2;
  context.strokeRect(1, 1, world * scale - 2, world * scale - 2);
  if (!at) return;
  context.strokeStyle = colour.goal;
  context.lineWidth = 3;
  context.beginPath(), context.arc(at[0] * scale, (world - at[1]) * scale, 8, 0, 2 * Math.PI), context.stroke();
}

export default { render: (context) => mount(context, "prediction", "Prediction", predictionPanel) };
