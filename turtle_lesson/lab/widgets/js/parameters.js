// The parameters of a node: a row each.

function parametersPanel(model, order) {
  const list = element("div", { class: "tl-items" });
  const problem = element("p", { class: "tl-note" });
  const now = button("Ask now", () => order("ask"), { title: "A moment of robot time passes, so that the node can answer" });
  const head = element("div", { class: "tl-head" }, element("h3", {}, `Parameters of ${model.get("node_name")}`));
  const trouble = element("div", { class: "tl-trouble" }, problem, now);
  const panel = element("div", {}, head, trouble, list);
  let rows = new Map();

  const showItems = () => {
    const items = model.get("items");
    const shape = (item) => [item.name, item.control, item.low, item.high, item.locked, item.help, item.type].join("\n");
    if (items.map(shape).join("\n\n") !== list.shape) {
      list.shape = items.map(shape).join("\n\n");
      rows = new Map(items.map((item) => [item.name, parameterRow(item, order)]));
      list.replaceChildren(...[...rows.values()].map(({ row }) => row));
    }
    for (const item of items) rows.get(item.name).show(item);
  };
  const showProblem = () => {
    problem.textContent = model.get("problem");
    trouble.hidden = !model.get("problem");
    now.hidden = !model.get("standing");
    list.inert = !!model.get("problem");
  };
  return { panel, watch: { items: showItems, problem: showProblem, standing: showProblem } };
}

/** One parameter: name and type, control, help and what its node said. */
function parameterRow(item, order) {
  const id = freshId();
  const { control, input, range, put } = parameterControl(item, id, (value) => order("set", { name: item.name, value }));
  const state = element("small", { class: "tl-state" });
  const error = element("span", { class: "tl-bad", id: `${id}e`, role: "status" });
  const help = element("small", { id: `${id}h` }, item.help, item.help && item.locked ? " · " : "", item.locked);
  const label = element("label", { for: id }, ...breakable(item.name), " ", element("small", {}, item.type));
  const row = element("div", { class: "tl-item" }, label, element("span", { class: "tl-control" }, control, state), element("span", { class: "tl-side" }, help, error));
  let last = {};
  const show = (now) => {
    // an answer of the node always has its way; a change from elsewhere not against the hand that is just typing
    const busy = [input, range].includes(document.activeElement) && document.hasFocus();
    if (now.answers !== last.answers || (now.value !== last.value && !(busy && input.type === "text" && input.value !== last.value))) put(now.value);
    state.textContent = now.pending ? "asking …" : "";
    error.textContent = now.error;
    input.setAttribute("aria-invalid", now.error ? "true" : "false");
    last = now;
  };
  return { row, show };
}

export default { initialize: handOut, render: (context) => mount(context, "parameters", `Parameters of ${context.model.get("node_name")}`, parametersPanel) };
