// The colours of the 3-D scene, on a light page and on a dark one; from 0 to 1, as the viewer wants them.

const SCENE_COLOURS = {
  light: { top: "#c9dcec", bottom: "#f4f7fa", floor: "#f3f3ee", grid: "#d3d3ca", walls: "#bfc6d0", ambient: 0.6, sun: 0.45 },
  dark: { top: "#0d1218", bottom: "#27313d", floor: "#323a45", grid: "#454f5d", walls: "#5b6675", ambient: 0.6, sun: 0.5 },
};

/** [red, green, blue, opacity] of a colour such as "#0072b2". */
function sceneColour(text) {
  const number = parseInt(text.slice(1), 16);
  return [16, 8, 0].map((shift) => ((number >> shift) & 255) / 255).concat(1);
}

/** Whether the page around a node is dark: then its text is light. */
function isDark(node) {
  const [red, green, blue] = (getComputedStyle(node).color.match(/[\d.]+/g) ?? [0, 0, 0]).map(Number);
  return 0.3 * red + 0.59 * green + 0.11 * blue > 128;
}

/** Give the viewer's scene the colours of a theme. */
function paintScene(viewer, dark) {
  const colours = SCENE_COLOURS[dark ? "dark" : "light"];
  for (const part of ["floor", "grid", "walls"]) viewer.set_property(["lab", part], "color", sceneColour(colours[part]));
  viewer.set_property(["Lights", "AmbientLight", "<object>"], "intensity", colours.ambient);
  viewer.set_property(["Lights", "Sun", "<object>"], "intensity", colours.sun);
  viewer.set_property(["Lights", "FillLight", "<object>"], "intensity", 0.22);
  for (const end of ["top", "bottom"])
    viewer.set_property(["Background"], `${end}_color`, sceneColour(colours[end]).slice(0, 3));
  viewer.set_dirty();
}
