// The dashboard: a card for each panel, in three columns that go below each other where there is little room.

const COLUMNS = [
  ["map", "editor", "goals"],
  ["status", "log"],
  ["scan", "rates", "lights"],
];

/** The panels ({name: panel}) as the elements of a dashboard. */
function dashboard(panels) {
  const columns = COLUMNS.map((names, at) =>
    element("div", { class: `tl-column tl-column-${at + 1}` }, ...names.filter((name) => panels[name]).map((name) => card(name, panels[name]))),
  );
  const above = Object.keys(panels).filter((name) => !COLUMNS.flat().includes(name));
  return element("div", { class: "tl-dashboard" }, ...above.map((name) => card(name, panels[name])), ...columns);
}

/** A panel below its heading, if it has a title; `aside` is a remark beside it, `tools` are its buttons. */
function card(name, { title, aside, tools, panel }) {
  const look = `tl-card tl-card-${name}`;
  if (!title) return element("div", { class: look }, panel);
  const id = `tl-${Math.random().toString(36).slice(2)}`;
  const head = element("header", { class: "tl-card-head" }, element("h3", { id }, title));
  if (aside) head.append(element("span", { class: "tl-aside" }, aside));
  if (tools) head.append(tools);
  return element("section", { class: look, "aria-labelledby": id }, head, panel);
}
