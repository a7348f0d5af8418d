// What the small widgets share: how they are put on the page, what they say, and the end of their world.

/** Put on the page what build(model, order) makes: {panel, watch: {trait: function}, close}. Returns how to take it away. */
function mount({ model, el }, name, label, build) {
  const { order, close } = connect(model);
  const words = element("div", { class: "tl-said", role: "status", "aria-live": "polite" });
  const ended = element("p", { class: "tl-note", hidden: true }, "This world has ended. Run the cell again to see the new one.");
  const built = build(model, order);
  const root = element("section", { class: `tl-root tl-small tl-${name}`, "aria-label": label }, built.panel, ended, words);
  keepKeys(root);
  el.append(root);

  const showEnd = () => {
    ended.hidden = !model.get("ended");
    built.panel.inert = model.get("ended");
  };
  const watched = [["words", () => (words.textContent = model.get("words"))], ["ended", showEnd], ...Object.entries(built.watch)];
  for (const [trait, show] of watched) model.on(`change:${trait}`, show), show();
  return () => {
    for (const [trait, show] of watched) model.off(`change:${trait}`, show);
    built.close?.();
    close();
    root.remove();
  };
}

/** A button with a word on it. */
function button(word, onclick, attributes = {}) {
  return element("button", { type: "button", class: "tl-button", onclick, ...attributes }, word);
}

/** A name for an element that a label or a description points to. */
const freshId = () => `tl-${Math.random().toString(36).slice(2)}`;

/** A name that may go on in the next line after an underscore or a slash. */
const breakable = (name) => name.split(/(?<=[_/])/).flatMap((part, at) => (at ? [element("wbr"), part] : [part]));
