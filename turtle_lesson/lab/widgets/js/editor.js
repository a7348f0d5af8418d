// The world editor: obstacles are added, selected, dragged, changed by numbers and removed.

const EDITOR_FIELDS = {
  circle: [["x", "m", 0.5], ["y", "m", 0.5], ["radius", "m", 0.1]],
  box: [["x", "m", 0.5], ["y", "m", 0.5], ["width", "m", 0.1], ["height", "m", 0.1], ["angle", "°", 15]],
}; // prettier-ignore
const EDITOR_STEP = { plain: 0.5, fine: 0.1 }; // m

function editorPanel(model, order, box) {
  const desk = obstacleDesk(model, order, () => (showList(), box.changed()));
  box.tools.editor = editorTool(desk);
  box.obstacles = desk.standing;

  const add = (shape) => {
    const made = editorButton(`+ ${shape}`, () => desk.add(shape));
    made.setAttribute("aria-label", `Add a ${shape}`);
    return made;
  };
  const remove = editorButton("Delete", () => desk.remove());
  const worlds = element("select", { "aria-label": "Ready-made world" });
  const load = editorButton("Load", () => (desk.select(-1), order("world", { name: worlds.value })));
  load.setAttribute("aria-label", "Load this world");
  const list = element("ul", { class: "tl-obstacles", "aria-label": "Obstacles" });
  const fields = element("div", { class: "tl-obstacle-fields", role: "group", "aria-label": "The selected obstacle" });
  const hint = element("p", { class: "tl-note" }, "Scans see obstacles once the detector's ", element("code", {}, "source"), " is ", element("code", {}, "world"), ".");
  const panel = element(
    "div",
    { class: "tl-editor", onkeydown: (event) => event.key === "Delete" && event.target.type !== "number" && desk.remove() },
    element("div", { class: "tl-row" }, add("circle"), add("box"), remove),
    element("div", { class: "tl-row" }, worlds, load),
    fields,
    list,
    hint,
  );

  const showList = () => {
    const obstacles = desk.standing();
    const at = [...list.querySelectorAll("button")].indexOf(list.getRootNode().activeElement);
    list.replaceChildren(...obstacles.map((each, number) => obstacleLine(each, number, desk)));
    if (!obstacles.length) list.append(element("li", { class: "tl-note" }, "No obstacles."));
    if (at >= 0) list.querySelectorAll("button")[Math.min(at, obstacles.length - 1)]?.focus();
    showSelectedLine(list, desk.number);
    remove.disabled = !desk.selected;
    showObstacleFields(fields, desk);
  };
  const showWorlds = () => worlds.replaceChildren(...model.get("worlds").map((name) => element("option", { value: name }, name)));
  const arrived = () => (desk.arrived(), showList(), box.changed());
  box.watch(() => (panel.hidden = box.held !== "editor"));
  return { title: "World", aside: "/world/obstacles", panel, watch: { worlds: showWorlds, obstacles: arrived } };
}

function editorButton(word, onclick) {
  return element("button", { class: "tl-button", type: "button", onclick }, word);
}

/** The obstacles, which of them is selected, and where it is being dragged to: what Python has not said yet. */
function obstacleDesk(model, order, changed) {
  let number = -1;
  let dragged = null; // {x, y}
  let wanted = -1; // how many there will be when the added one has arrived
  const known = () => model.get("obstacles");
  const change = (fields, done) => order("obstacle_change", { number, done, ...fields });
  const sendDrag = atRepaint(() => dragged && change(dragged, false));
  const desk = {
    standing: () => known().map((each, at) => (at === number && dragged ? { ...each, ...dragged } : each)),
    get number() {
      return number;
    },
    get selected() {
      return desk.standing()[number];
    },
    select: (at) => ((number = at), (dragged = null), changed()),
    add: (shape) => ((wanted = known().length + 1), order("obstacle_add", { shape })),
    remove: () => desk.selected && order("obstacle_remove", { number }),
    change: (fields) => desk.selected && change(fields, true),
    move: (right, up) => order("obstacle_move", { number, right, up }),
    drag: (place) => ((dragged = place), sendDrag()),
    drop: () => dragged && change(dragged, true),
    arrived: () => {
      if (known().length === wanted) (number = wanted - 1), (wanted = -1);
      number = Math.min(number, known().length - 1);
      if (!desk.held) dragged = null;
    },
    held: false,
  };
  return desk;
}

/** On the map: press on an obstacle selects it, a drag moves it; keys do the same with the selected one. */
function editorTool(desk) {
  let grip = null; // where the pointer holds the obstacle, from its middle
  const letGo = () => ((grip = null), (desk.held = false));
  const key = ({ key, shiftKey }) => {
    const count = desk.standing().length;
    if (key === "Enter" || key === " ") return count > 0 && (desk.select((desk.number + 1) % count), true);
    if (key === "Escape") return desk.select(-1), true;
    if (!desk.selected) return false;
    if (key === "Delete" || key === "Backspace") return desk.remove(), true;
    const [right, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key] ?? [0, 0];
    if (!right && !up) return false;
    const step = shiftKey ? EDITOR_STEP.fine : EDITOR_STEP.plain;
    desk.move(right * step, up * step);
    return true;
  };
  return {
    name: "Edit the world",
    hint: "Drag an obstacle to move it. Keys: Enter selects the next one, arrows move it by 0.5 m (with Shift by 0.1 m), Delete removes it.",
    press: (x, y) => {
      const at = desk.standing().findLastIndex((each) => covers(each, x, y));
      desk.select(at);
      if (at < 0) return;
      grip = [x - desk.selected.x, y - desk.selected.y];
      desk.held = true;
    },
    move: (x, y) => grip && desk.drag({ x: cents(x - grip[0]), y: cents(y - grip[1]) }),
    release: () => (letGo(), desk.drop()),
    cancel: letGo,
    key,
    draw: (context, colour, pixel) => desk.selected && drawSelected(context, desk.selected, colour, pixel),
  };
}

/** Whether an obstacle, with a little margin for fingers, is at this place. */
function covers({ shape, x, y, width, height, angle }, atX, atY) {
  const [dx, dy] = [atX - x, atY - y];
  const along = dx * Math.cos(angle) + dy * Math.sin(angle);
  const across = dy * Math.cos(angle) - dx * Math.sin(angle);
  const [right, up] = [width / 2 + 0.1, height / 2 + 0.1];
  return shape === "box" ? Math.abs(along) <= right && Math.abs(across) <= up : Math.hypot(along / right, across / up) <= 1;
}

function drawSelected(context, obstacle, colour, pixel) {
  outline(context, obstacle, 5 * pixel);
  context.setLineDash([6 * pixel, 4 * pixel]);
  context.strokeStyle = colour.accent;
  context.lineWidth = 2 * pixel;
  context.stroke();
  context.setLineDash([]);
}

function obstacleLine({ shape, x, y }, number, desk) {
  const choose = editorButton(`${number + 1}. ${shape} at (${figure(x)}, ${figure(y)}) m`, () => desk.select(number));
  choose.setAttribute("aria-pressed", String(number === desk.number));
  return element("li", {}, choose);
}

/** Scroll the list, and not the page, to a line that was just selected. */
function showSelectedLine(list, number) {
  const line = list.children[number];
  if (line && list.dataset.selected !== String(number)) list.scrollTop = line.offsetTop - list.offsetTop - list.clientHeight / 2;
  list.dataset.selected = number;
}

/** Fields for the numbers of the selected obstacle. They are made anew only when another kind or one is selected. */
function showObstacleFields(place, desk) {
  const { selected, number } = desk;
  const key = selected ? `${number} ${selected.shape}` : "";
  if (place.dataset.shown !== key) {
    place.dataset.shown = key;
    place.fields = selected ? EDITOR_FIELDS[selected.shape].map((field) => obstacleField(field, desk)) : [];
    place.replaceChildren(...place.fields.map(({ label }) => label));
    if (!selected) place.append(element("p", { class: "tl-note" }, "Select an obstacle to change it."));
  }
  for (const { read, input } of place.fields) if (input.getRootNode().activeElement !== input) input.value = read(selected);
}

function obstacleField([name, unit, step], desk) {
  const field = numberField(name, unit, step, { onchange: () => desk.change({ [name]: write(field.value) }) });
  const write = (value) => (name === "angle" ? radians(value) : value);
  const read = (each) => cents(name === "radius" ? each.width / 2 : name === "angle" ? degrees(each.angle) : each[name]);
  return { label: field.label, input: field.input, read };
}
