// The goal pad and the dashboard: panels side by side, all drawn from the same model.

const PANELS = {
  clock: clockPanel,
  map: mapPanel,
  goals: goalsPanel,
  status: statusPanel,
  log: logPanel,
  scan: scanPanel,
  rates: ratesPanel,
  lights: lightsPanel,
};

function render({ model, el }) {
  const { order, close } = connect(model);
  const spoken = element("div", { class: "tl-words", role: "status", "aria-live": "polite" });
  const speak = () => (spoken.textContent = model.get("words"));
  const names = model.get("panels");
  const panels = names.map((name) => PANELS[name](model, order));
  const shown = names.includes("status")
    ? [dashboard(Object.fromEntries(names.map((name, at) => [name, panels[at]])))]
    : panels.map(({ panel }) => panel);
  const root = element("div", { class: "tl-root" }, ...shown, spoken);
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
