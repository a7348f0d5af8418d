// The log: what the nodes say on /rosout, the newest line last.

const LOG_LEVELS = ["DEBUG", "INFO", "WARN", "ERROR", "FATAL"];
const LOG_SIGNS = { WARN: "warn", ERROR: "bad", FATAL: "bad" };

function logPanel(model, order) {
  const list = element("ol", { class: "tl-log", tabindex: 0, "aria-label": "Log lines, the newest last", onscroll: () => scrolled() });
  const newest = element("button", { class: "tl-button tl-newest", type: "button", hidden: true, onclick: () => toEnd() }, "Newest ↓");
  const least = element("select", { class: "tl-select", onchange: () => order("log_least", { level: least.value }) });
  for (const level of LOG_LEVELS) least.append(element("option", { value: level }, level === "DEBUG" ? "all" : `${level} and above`));
  const copy = element("button", { class: "tl-button", type: "button", onclick: () => copyLog() }, "Copy");
  const tools = element("div", { class: "tl-log-tools" }, element("label", {}, element("span", {}, "Show "), least), copy);
  const empty = element("p", { class: "tl-note" }, "No line heard yet: lines come while robot time passes.");
  const panel = element("div", { class: "tl-log-panel" }, empty, list, newest);

  const items = new Map(); // the line's number, and its element
  let follows = true; // until the reader scrolls up
  const scrolled = () => {
    follows = list.scrollHeight - list.scrollTop - list.clientHeight < 8;
    newest.hidden = follows;
  };
  const toEnd = () => (list.scrollTop = list.scrollHeight);

  const show = () => {
    const lines = [...model.get("log_old"), ...model.get("log_new")];
    const first = lines.length ? lines[0][0] : 0;
    for (const [number, item] of items) if (number < first) item.remove(), items.delete(number);
    for (const line of lines) if (!items.has(line[0])) items.set(line[0], logItem(line)), list.append(items.get(line[0]));
    empty.hidden = lines.length > 0;
    if (follows) toEnd();
  };
  const showLeast = () => {
    least.value = model.get("log_least");
    list.dataset.least = least.value;
    if (follows) toEnd();
  };
  const copyLog = async () => {
    const shown = [...list.children].filter((item) => item.offsetParent !== null);
    const done = await copyText(shown.map((item) => item.dataset.text).join("\n"));
    copy.textContent = done ? "Copied" : "Not copied";
    setTimeout(() => (copy.textContent = "Copy"), 1500);
  };
  const soon = atRepaint(show); // both pieces change together, and are looked at together
  const sizes = new ResizeObserver(() => follows && toEnd());
  sizes.observe(list);
  return { title: "Log", tools, panel, close: () => sizes.disconnect(), watch: { log_old: soon, log_new: soon, log_least: showLeast } };
}

function logItem([, seconds, level, name, text]) {
  const time = figure(seconds, 2);
  const item = element(
    "li",
    { class: `tl-log-line tl-log-${level}` },
    element("span", { class: "tl-log-time" }, time),
    element("span", { class: "tl-log-level" }, LOG_SIGNS[level] ? sign(LOG_SIGNS[level]) : null, level),
    element("span", { class: "tl-log-text" }, element("span", { class: "tl-log-name" }, name), " ", text),
  );
  item.dataset.text = `${time} s [${level}] [${name}]: ${text}`;
  return item;
}

/** Copy text. Without https a page has no clipboard, so a hidden text field is copied as by hand. */
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = element("textarea", { class: "tl-unseen", "aria-hidden": "true" });
    field.value = text;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    return done;
  }
}
