// The goal pad and the dashboard: panels side by side, all drawn from the same model.

const PANELS = {
  clock: clockPanel,
  map: mapPanel,
  goals: goalsPanel,
  editor: editorPanel,
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
  const ended = element("p", { class: "tl-ended", hidden: true }, "This world has ended. Run the cell again to see the new one.");
  const names = model.get("panels");
  const box = makeToolbox();
  const panels = names.map((name) => PANELS[name](model, order, box));
  const layout = names.includes("status") ? dashboard : goalPad;
  const shown = layout(Object.fromEntries(names.map((name, at) => [name, panels[at]])));
  const root = element("div", { class: "tl-root", role: "region", "aria-label": model.get("title") }, shown, ended, spoken);
  keepKeys(root);
  el.append(root);
  box.changed();

  const showEnd = () => {
    ended.hidden = !model.get("ended");
    shown.inert = model.get("ended");
  };
  const watched = [["words", speak], ["ended", showEnd]];
  for (const { watch } of panels) watched.push(...Object.entries(watch));
  for (const [name, show] of watched) model.on(`change:${name}`, show), show();
  return () => {
    for (const [name, show] of watched) model.off(`change:${name}`, show);
    for (const panel of panels) panel.close?.();
    close();
    root.remove();
  };
}

export default { initialize: handOut, render };
