// The nodes and services that the system needs: there or not, told by shape and word.

const LIGHT_SIGNS = { present: "good", missing: "bad", several: "warn", extra: "more" };

function lightsPanel(model) {
  const list = element("ul", { class: "tl-lights" });
  const show = () => list.replaceChildren(...model.get("lights").map(lightItem));
  return { title: "Nodes and services", panel: list, watch: { lights: show } };
}

function lightItem({ name, kind, state, words }) {
  const known = state === "extra" && words === "present" ? "also there" : words;
  const what = kind === "service" ? `service, ${known}` : known;
  return element(
    "li",
    { class: `tl-light tl-light-${state}` },
    sign(LIGHT_SIGNS[state]),
    element("span", { class: "tl-light-name" }, name),
    element("span", { class: "tl-light-words" }, what),
  );
}
