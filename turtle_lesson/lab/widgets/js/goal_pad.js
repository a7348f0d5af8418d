// The goal pad: the clock above, the map, and beside it the goals, or the editor in their place.

function goalPad({ clock, map, goals, editor }) {
  const side = element("div", { class: "tl-pad-side" }, card("goals", goals), editor ? card("editor", editor) : null);
  return element("div", { class: "tl-dashboard tl-pad" }, card("clock", clock), card("map", map), side);
}
