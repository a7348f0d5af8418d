// Controls for parameters: a checkbox, a slider with its field, or a field alone.

/** A control: {control: what to show, put(value): set it from outside}. `send(value)` is called when it was changed. */
function parameterControl(item, id, send) {
  const common = { id, disabled: !!item.locked, "aria-describedby": `${id}h ${id}e` };
  if (item.control === "checkbox") return checkbox(common, send);
  if (item.control === "slider") return slider(item, common, send);
  return field(item, common, send);
}

function checkbox(common, send) {
  const input = element("input", { ...common, type: "checkbox", onchange: () => send(input.checked) });
  return { control: input, input, put: (value) => (input.checked = value) };
}

function field(item, common, send) {
  const mode = item.control === "number" ? "decimal" : null;
  const input = element("input", { ...common, type: "text", spellcheck: "false", autocomplete: "off", inputmode: mode });
  let last = "";
  const commit = () => input.value !== last && send((last = input.value));
  input.addEventListener("change", commit);
  input.addEventListener("keydown", (event) => event.key === "Enter" && commit());
  return { control: input, input, put: (value) => (last = input.value = value) };
}

/** A slider over the allowed range; over two powers of ten and more it is logarithmic, or small values could not be met. */
function slider(item, common, send) {
  const { low, high } = item;
  const whole = item.type === "integer";
  const log = low > 0 && high / low >= 100;
  const toPlace = (value) => (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  const toValue = (place) => {
    const value = log ? low * (high / low) ** place : low + place * (high - low);
    return Math.min(high, Math.max(low, rounded(value, item, whole)));
  };
  const text = field({ control: "number" }, common, send);
  const words = (value) => `${value}, from ${low} to ${high}`;
  const range = element("input", {
    type: "range", min: 0, max: 1, step: whole && !log ? (item.step || 1) / (high - low) : 0.001, disabled: !!item.locked, "aria-label": item.name,
    oninput: () => {
      text.put(String(toValue(Number(range.value))));
      range.setAttribute("aria-valuetext", words(text.input.value));
    },
    onchange: () => send(String(toValue(Number(range.value)))),
  }); // prettier-ignore
  const put = (value) => {
    text.put(value);
    range.value = toPlace(Math.min(high, Math.max(low, Number(value))));
    range.setAttribute("aria-valuetext", words(value));
  };
  const ends = element("span", { class: "tl-ends", "aria-hidden": "true" }, element("small", {}, brief(low)), element("small", {}, brief(high)));
  const control = element("span", { class: "tl-range" }, element("span", {}, range, ends), text.control);
  return { control, input: text.input, range, put };
}

/** To the node's own step, or to three figures of the range: what a hand can aim at. */
function rounded(value, { low, step }, whole) {
  if (step) return Number((low + Math.round((value - low) / step) * step).toPrecision(12));
  if (whole) return Math.round(value);
  return Number(value.toPrecision(3));
}

const brief = (value) => String(Number(value.toPrecision(4))).replace("-", "−");
