// Small signs that tell a state by their shape, so that nobody needs to see their colour.

const SIGNS = {
  good: "M8 1a7 7 0 1 0 0 14A7 7 0 1 0 8 1zM4.6 8.3l2.3 2.3 4.5-5", // a disc with a tick
  bad: "M8 1.2 14.8 8 8 14.8 1.2 8zM5.8 5.8l4.4 4.4M10.2 5.8l-4.4 4.4", // a diamond with a cross
  warn: "M8 1.6 15 14.2H1zM8 6.2v3.6M8 11.6v.6", // a triangle with an exclamation mark
  quiet: "M8 3a5 5 0 1 0 0 10A5 5 0 1 0 8 3z", // an empty ring
  way: "M8 2a6 6 0 1 0 0 12A6 6 0 1 0 8 2zM6.8 5.3 9.5 8l-2.7 2.7", // a ring with an arrow head
  more: "M8 3a5 5 0 1 0 0 10A5 5 0 1 0 8 3zM8 5.6v4.8M5.6 8h4.8", // a ring with a plus
};

/** A sign: "good", "bad", "warn", "quiet", "way" or "more". What it means must stand beside it in words. */
function sign(kind) {
  const [outline, ...inside] = SIGNS[kind].split(/(?<=z)/i);
  const svg = svgElement("svg", { class: `tl-sign tl-sign-${kind}`, viewBox: "0 0 16 16", "aria-hidden": "true" });
  svg.append(svgElement("path", { class: "tl-sign-shape", d: outline }));
  if (inside.length) svg.append(svgElement("path", { class: "tl-sign-mark", d: inside.join("") }));
  return svg;
}

function svgElement(tag, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
