// The goal pad and the dashboard: panels side by side, all drawn from the same model.

const PANELS = { clock: clockPanel, map: mapPanel, goals: goalsPanel };

function render({ model, el }) {
  const { order, close } = connect(model);
  const spoken = element("div", { class: "tl-words", role: "status", "aria-live": "polite" });
  const speak = () => (spoken.textContent = model.get("words"));
  const panels = model.get("panels").map((name) => PANELS[name](model, order));
  const root = element("div", { class: "tl-root" }, ...panels.map(({ panel }) => panel), spoken);
  el.append(root);

  const watched = [["words", speak]];
  for (const { watch } of panels) watched.push(...Object.entries(watch));
  for (const [name, show] of watched) model.on(`change:${name}`, show), show();
  return () => {
    for (const [name, show] of watched) model.off(`change:${name}`, show);
    for (const panel of panels) panel.close?.();
    close();
  };
}

export default { render };
