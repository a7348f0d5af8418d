// The fields of a form, drawn from the tree that Python made of a message type.

/** All fields: {panel, inputs: {path: input}, errors: {path: where to say what is wrong}}. */
function formFields(tree, order) {
  const made = { inputs: {}, errors: {}, order };
  return { ...made, panel: element("div", { class: "tl-fields" }, ...tree.map((part) => formPart(part, made, 0))) };
}

function formPart(part, made, depth) {
  if (part.control === "group") return formGroup(part, made, depth);
  if (part.control === "now") return folded(part, depth, "the moment of sending");
  if (part.control === "rows") return formRows(part, made, depth);
  return formField(part, made);
}

/** A group that can be folded: deep ones are to begin with, so that the whole can be seen. */
function folded(part, depth, ...content) {
  const title = element("summary", {}, element("b", {}, part.name), " ", element("small", {}, part.type));
  const inner = element("div", { class: "tl-inner" }, ...content);
  return element("details", { class: "tl-group", "data-path": part.path, open: depth < 2 }, title, inner);
}

const formGroup = (part, made, depth) => folded(part, depth, ...part.parts.map((each) => formPart(each, made, depth + 1)));

function formRows(part, made, depth) {
  const plain = part.parts.every((each) => !["group", "now", "rows"].includes(each.control));
  const rows = part.parts.map((each, row) =>
    element("div", { class: "tl-element" }, formPart(each, made, depth + 1), part.fixed ? null : removal(part, row, made)),
  );
  const add = button("Add a row", () => made.order("add", { path: part.path }), {
    "data-path": `${part.path} add`, disabled: !!part.full, "aria-label": `Add a row to ${part.name}`,
  }); // prettier-ignore
  const foot = element("div", { class: "tl-foot" }, part.fixed ? null : add, element("small", {}, part.full || (rows.length ? "" : "empty")));
  return folded(part, depth, element("div", { class: plain ? "tl-rows tl-plain" : "tl-rows" }, ...rows), foot);
}

const removal = (part, row, made) =>
  button("×", () => made.order("remove", { path: part.path, row }), {
    class: "tl-button tl-remove", title: "Remove this row", "aria-label": `Remove row ${row} of ${part.name}`,
    "data-path": `${part.path} remove ${row}`,
  }); // prettier-ignore

/** One field with its label, its help, and a place for what is wrong. */
function formField(part, made) {
  const [id, help] = [freshId(), freshId()];
  const error = element("span", { class: "tl-bad", id: `${help}e` });
  const common = { id, "data-path": part.path, "aria-describedby": `${help} ${help}e` };
  const input =
    part.control === "checkbox"
      ? element("input", { ...common, type: "checkbox" })
      : element("input", { ...common, type: "text", spellcheck: "false", autocomplete: "off", inputmode: part.control === "number" ? "decimal" : null });
  const send = () => made.order("edit", { path: part.path, text: part.control === "checkbox" ? input.checked : input.value });
  input.addEventListener("input", send);
  made.inputs[part.path] = input;
  made.errors[part.path] = error;
  const label = element("label", { for: id }, ...breakable(part.name), " ", element("small", {}, part.type));
  const side = element("span", { class: "tl-side" }, element("small", { id: help }, part.help), error);
  return element("div", { class: "tl-field" }, label, element("span", { class: "tl-entry" }, input), side);
}
