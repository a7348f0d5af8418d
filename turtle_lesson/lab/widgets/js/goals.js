// The goals: the tool that sets one on the map, fields that do the same, and what became of those that were sent.

const GOAL_SIGNS = { reached: "good", "not reached": "bad", refused: "bad", busy: "quiet", "on its way": "way" };
const CURSOR_STEP = 0.5; // m
const DRAG_LEAST = 0.25; // m: a shorter drag counts as a click

const degrees = (radians) => (radians * 180) / Math.PI;
const radians = (degrees) => (degrees * Math.PI) / 180;
/** Hundredths are enough for a place, and what is shown is then what was sent. */
const cents = (value) => Math.round(value * 100) / 100;
/** The same direction, from -180° to 180°. */
const turned = (theta) => Math.atan2(Math.sin(theta), Math.cos(theta));

function goalsPanel(model, order, box) {
  const form = goalForm((goal) => order("goal", goal));
  const send = (goal) => (form.show(goal), order("goal", goal));
  box.tools.goals = goalTool(model, send, form);
  const progress = goalProgress(model);
  const list = element("ol", { class: "tl-goals", "aria-label": "Goals sent, the newest first", tabindex: 0 });
  const panel = element("div", { class: "tl-goals-panel" }, form.panel, progress.panel, list);

  const showGoals = () => {
    const goals = [...model.get("goals")].reverse();
    const more = (goals.at(-1)?.number ?? 1) - 1; // they are numbered from 1
    list.replaceChildren(...goals.map(goalLine));
    if (more) list.append(element("li", { class: "tl-note" }, `and ${more} earlier`));
    if (!goals.length) list.append(element("li", { class: "tl-note" }, "No goal sent yet."));
    progress.show();
  };
  box.watch(() => (panel.hidden = box.held !== "goals"));
  return { title: "Goals", aside: "/navigate_to", panel, watch: { goals: showGoals, pose: progress.show, now: progress.show } };
}

/** On the map: a click sends, a drag sets the heading; arrows move a cursor, Enter sends. `form` shows the same numbers. */
function goalTool(model, send, form) {
  let draft = null; // {x, y, theta}: theta is null as long as the direction of travel will do
  const ahead = ({ x, y }) => {
    const [fromX, fromY] = floats(model.get("pose"));
    return Number.isFinite(fromX) && Math.hypot(x - fromX, y - fromY) > 0.01 ? Math.atan2(y - fromY, x - fromX) : 0;
  };
  const whole = ({ x, y, theta }) => ({ x, y, theta: turned(theta ?? ahead({ x, y })) });
  const set = (wanted) => {
    draft = wanted;
    if (draft) form.show(whole(draft));
  };
  const finish = () => {
    if (draft) send(whole(draft));
    draft = null;
  };
  const start = () => {
    const [x, y] = floats(model.get("pose"));
    const half = (value) => Math.round(value / CURSOR_STEP) * CURSOR_STEP;
    return { x: half(Number.isFinite(x) ? x : 5.5), y: half(Number.isFinite(y) ? y : 5.5), theta: null };
  };
  const within = (value) => cents(Math.min(Math.max(value, 0), WORLD));
  const key = ({ key, shiftKey }) => {
    if (key === "Escape" || key === "Enter") {
      if (!draft) return key === "Enter" && (set(start()), true);
      key === "Enter" ? finish() : (draft = null);
      return true;
    }
    const [right, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key] ?? [0, 0];
    if (!right && !up) return false;
    const from = draft ?? start();
    if (shiftKey) set({ ...from, theta: whole(from).theta - radians(15 * right - up) });
    else set({ ...from, x: within(from.x + right * CURSOR_STEP), y: within(from.y + up * CURSOR_STEP) });
    return true;
  };
  return {
    name: "Send goals",
    hint: "Click to send the turtle there, drag to set its heading. Keys: arrows, Shift+←→ turns by 15° (↑↓ by 1°), Enter sends, Esc cancels.",
    press: (x, y) => set({ x: within(x), y: within(y), theta: null }),
    move: (x, y) => draft && Math.hypot(x - draft.x, y - draft.y) > DRAG_LEAST && set({ ...draft, theta: Math.atan2(y - draft.y, x - draft.x) }),
    release: finish,
    cancel: () => (draft = null),
    key,
    says: () => (draft ? `Goal at ${goalPlace(whole(draft))}, ${figure(degrees(whole(draft).theta), 0)} degrees` : ""),
    draw: (context, colour, pixel) => {
      if (!draft) return;
      const goal = whole(draft);
      drawFlag(context, goal, colour, pixel, true);
      drawLabel(context, goal.x, goal.y, `${goalPlace(goal)}, ${figure(degrees(goal.theta), 0)}°`, colour, pixel);
    },
  };
}

const goalPlace = ({ x, y }) => `(${figure(x)}, ${figure(y)}) m`;

/** Three fields and a button; show(goal) fills them. */
function goalForm(send) {
  const fields = { x: numberField("x", "m", 0.5), y: numberField("y", "m", 0.5), theta: numberField("heading", "°", 15) };
  const values = () => ({ x: fields.x.value, y: fields.y.value, theta: radians(fields.theta.value) });
  const enter = (event) => event.key === "Enter" && event.target.type === "number" && (event.preventDefault(), send(values()));
  const panel = element(
    "div",
    { class: "tl-goal-form", role: "group", "aria-label": "Goal", onkeydown: enter },
    ...Object.values(fields).map(({ label }) => label),
    element("button", { class: "tl-button tl-main", type: "button", onclick: () => send(values()) }, "Send"),
  );
  const show = ({ x, y, theta }) => {
    fields.x.value = figure(x).replace("−", "-");
    fields.y.value = figure(y).replace("−", "-");
    fields.theta.value = String(Math.round(degrees(theta)));
  };
  show({ x: 8, y: 8, theta: 0 });
  return { panel, show };
}

/** A labelled field for a number; an empty one is NaN. */
function numberField(name, unit, step, attributes = {}) {
  const input = element("input", { type: "number", step, ...attributes });
  const label = element("label", { class: "tl-number" }, element("span", {}, name, unit ? element("small", {}, ` ${unit}`) : null), input);
  return {
    label,
    input,
    get value() {
      return input.value === "" ? NaN : Number(input.value);
    },
    set value(value) {
      input.value = value;
    },
  };
}

/** How far it still is to the goal that the turtle is on its way to. */
function goalProgress(model) {
  const words = element("p");
  const bar = element("div", { class: "tl-way", role: "progressbar", "aria-label": "Way to the goal" }, element("i"));
  const panel = element("div", { class: "tl-goal-progress" }, words, bar);
  const show = () => {
    const goal = model.get("goals").find(({ state }) => state === "on its way");
    const [x, y, theta] = floats(model.get("pose"));
    const left = goal ? Math.hypot(goal.x - x, goal.y - y) : NaN;
    const done = goal?.away ? Math.min(Math.max(1 - left / goal.away, 0), 1) : 0;
    words.textContent = goal ? goalNews(goal, left, goal.theta - theta, model.get("now")) : "No goal on its way.";
    words.classList.toggle("tl-note", !goal);
    bar.firstChild.style.width = `${100 * done}%`;
    bar.setAttribute("aria-valuenow", Math.round(100 * done));
  };
  return { panel, show };
}

function goalNews(goal, left, turn, now) {
  const rest = Number.isFinite(left) ? `${figure(left)} m and ${figure(Math.abs(degrees(turned(turn))), 0)}° to go` : "no pose heard";
  return `Goal ${goal.number}: ${rest}, ${figure(Math.max(now - goal.sent, 0), 1)} s`;
}

function goalLine(goal) {
  const place = `(${figure(goal.x)}, ${figure(goal.y)}), ${figure(degrees(turned(goal.theta)), 0)}°`;
  return element(
    "li",
    { class: `tl-goal tl-goal-${goal.state.replaceAll(" ", "-")}` },
    sign(GOAL_SIGNS[goal.state] ?? "warn"),
    element("span", { class: "tl-goal-place" }, `${goal.number}`, element("span", {}, place)),
    element("strong", {}, goal.state),
    goal.answer ? element("small", {}, goal.answer) : null,
  );
}
