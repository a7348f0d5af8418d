// The fields of a form, drawn from the list that Python made of a message type.

/** All fields: {panel, inputs: {path: input}, errors: {path: where to say what is wrong}}. */
function formFields(fields, order) {
  const panel = element("div", { class: "tl-fields" });
  const made = { panel, inputs: {}, errors: {}, order };
  const groups = { "": panel };
  for (const part of fields) {
    const steps = part.path.split("/");
    const named = { ...part, name: steps.pop() };
    const isGroup = ["group", "now"].includes(part.control);
    groups[steps.join("/")].append(isGroup ? formGroup(named, groups, steps.length) : formField(named, made));
  }
  return made;
}

/** A group that can be folded: deep ones are to begin with, so that the whole can be seen. */
function formGroup(part, groups, depth) {
  const title = element("summary", {}, element("b", {}, part.name), " ", element("small", {}, part.type));
  groups[part.path] = element("div", { class: "tl-inner" }, part.control === "now" ? "the moment of sending, which a line for the terminal cannot know" : "");
  return element("details", { class: "tl-group", open: depth < 2 }, title, groups[part.path]);
}

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
