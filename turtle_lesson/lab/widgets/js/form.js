// A form for messages or requests: its fields, what sends them, and what came back.

function formPanel(model, order) {
  const isTopic = model.get("kind") === "topic";
  const head = element(
    "div",
    { class: "tl-head" },
    element("h3", {}, `${isTopic ? "Publish on" : "Call"} ${model.get("name")}`),
    element("small", {}, model.get("type_name")),
  );
  const fields = formFields(model.get("fields"), order);
  if (!model.get("fields").length) fields.panel.append(element("p", { class: "tl-note" }, "Nothing to fill in: this type has no fields."));
  const actions = isTopic ? publishing(model, order) : calling(model, order);
  const line = terminalLine(model);
  const unheard = element("p", { class: "tl-note" });
  const panel = element("div", {}, head, fields.panel, actions.panel, unheard, line.panel);

  const showValues = () => {
    const values = model.get("values");
    for (const [path, input] of Object.entries(fields.inputs)) {
      if (!(path in values)) continue;
      if (input.type === "checkbox") input.checked = values[path];
      else if (input !== document.activeElement && input.value !== values[path]) input.value = values[path];
    }
  };
  const showErrors = () => {
    const errors = model.get("errors");
    for (const [path, input] of Object.entries(fields.inputs)) {
      input.setAttribute("aria-invalid", path in errors ? "true" : "false");
      fields.errors[path].textContent = errors[path] ?? "";
    }
  };
  const showUnheard = () => (unheard.textContent = model.get("unheard"));
  const watch = { values: showValues, errors: showErrors, unheard: showUnheard };
  return { panel, watch: combined(watch, actions.watch, line.watch) };
}

/** Several functions for one trait become one. */
function combined(...several) {
  const all = {};
  for (const watch of several)
    for (const [name, show] of Object.entries(watch)) {
      const before = all[name];
      all[name] = before ? () => (before(), show()) : show;
    }
  return all;
}

const isSound = (model) => !Object.keys(model.get("errors")).length;

function publishing(model, order) {
  const once = button("Publish once", () => order("publish"), { class: "tl-button tl-main" });
  const repeat = button("", () => order(model.get("running") ? "stop" : "repeat"), { class: "tl-button tl-repeat" });
  const rate = element("input", { type: "number", step: "any", min: 0.01, max: 100 });
  rate.addEventListener("change", () => rate.value && order("rate", { rate: Number(rate.value) }));
  const count = element("small");
  const reset = button("Reset", () => order("reset"), { title: "Reset all fields to their defaults" });
  const times = element("label", { class: "tl-amount" }, rate, "times a second");
  const panel = element("div", { class: "tl-actions" }, once, element("span", { class: "tl-pair" }, repeat, times), reset, count);
  const show = () => {
    repeat.textContent = model.get("running") ? "Stop" : "Publish repeatedly";
    repeat.classList.toggle("tl-running", model.get("running"));
    once.disabled = !isSound(model);
    repeat.disabled = !isSound(model) && !model.get("running");
  };
  const showRate = () => rate !== document.activeElement && (rate.value = model.get("rate"));
  const showCount = () => (count.textContent = `${model.get("published") || "none"} published`);
  return { panel, watch: { running: show, errors: show, rate: showRate, published: showCount } };
}

function calling(model, order) {
  const call = button("Call", () => order("call"), { class: "tl-button tl-main" });
  const stop = button("Stop waiting", () => order("stop"));
  const reset = button("Reset", () => order("reset"), { title: "Reset all fields to their defaults" });
  const actions = element("div", { class: "tl-actions" }, call, stop, reset);
  const answer = element("pre", { class: "tl-answer", "aria-label": "Answer", tabindex: 0 });
  const answered = element("div", { class: "tl-answered", hidden: true }, element("small", {}, "Answer"), answer);
  const panel = element("div", {}, actions, answered);
  const show = () => {
    call.disabled = model.get("running") || !isSound(model);
    stop.disabled = !model.get("running");
  };
  const showAnswer = () => ((answer.textContent = model.get("answer")), (answered.hidden = !model.get("answer")));
  return { panel, watch: { running: show, errors: show, answer: showAnswer } };
}

/** The same for the terminal, with a button that copies it. */
function terminalLine(model) {
  const code = element("pre", { class: "tl-line" });
  const copy = button("Copy", async () => {
    try {
      await navigator.clipboard.writeText(model.get("line"));
    } catch {
      // no permission, or no secure page: marked, so that Ctrl-C copies it
      getSelection().selectAllChildren(code);
      return;
    }
    copy.textContent = "Copied";
    setTimeout(() => (copy.textContent = "Copy"), 1500);
  }); // prettier-ignore
  const row = element("div", { class: "tl-terminal" }, code, copy);
  const panel = element("div", { class: "tl-same" }, element("small", {}, "The same in a terminal"), row);
  const show = () => {
    code.textContent = model.get("line") || "(correct the fields first)";
    copy.disabled = !model.get("line");
  };
  return { panel, watch: { line: show } };
}

export default { initialize: handOut, render: (context) => mount(context, "form", `Form for ${context.model.get("name")}`, formPanel) };
