// The topics: how often messages come on each. Every bar is drawn so that its expected rate is at the same mark.

const RATE_MARK = 0.7; // where on the bar the expected rate is
const RATE_SIGNS = {
  "as expected": "good",
  "too slow": "warn",
  "too fast": "warn",
  "not heard": "warn",
  silent: "bad",
};

function ratesPanel(model) {
  const head = element("tr", {}, ...["Topic", "Rate", "Messages a second", "State"].map((text) => element("th", { scope: "col" }, text)));
  const body = element("tbody");
  const more = element("p", { class: "tl-note" });
  const table = element("table", { class: "tl-rates" }, element("thead", { class: "tl-unseen" }, head), body);
  const rows = new Map();

  const show = () => {
    const rates = model.get("rates");
    for (const rate of rates) {
      if (!rows.has(rate.topic)) rows.set(rate.topic, rateRow(rate.topic));
      rows.get(rate.topic).show(rate);
    }
    const wanted = rates.map(({ topic }) => rows.get(topic).row);
    if (wanted.length !== body.children.length || wanted.some((row, at) => row !== body.children[at])) body.replaceChildren(...wanted);
  };
  const showMore = () => {
    const amount = model.get("rates_more");
    more.textContent = amount ? `${amount} more topics are not shown.` : "";
  };
  return { title: "Topics", aside: "messages a second; the mark is what is expected", panel: element("div", {}, table, more), watch: { rates: show, rates_more: showMore } };
}

function rateRow(topic) {
  const bar = element("span", { class: "tl-bar-fill" });
  const mark = element("span", { class: "tl-bar-mark" });
  const hertz = element("td", { class: "tl-hertz" });
  const state = element("td", { class: "tl-state" });
  const row = element(
    "tr",
    {},
    element("th", { scope: "row", title: topic }, topic),
    element("td", { class: "tl-bar-cell" }, element("span", { class: "tl-bar", "aria-hidden": "true" }, bar, mark)),
    hertz,
    state,
  );
  let shown = "";
  const show = (rate) => {
    const { expected, state: word, note } = rate;
    hertz.textContent = figure(rate.hertz ?? NaN, 1);
    hertz.title = expected ? `expected: ${figure(expected, 1)} Hz` : "no rate is expected";
    mark.hidden = !expected;
    mark.style.left = `${100 * RATE_MARK}%`;
    bar.style.width = expected ? `${Math.min(100, (100 * RATE_MARK * (rate.hertz ?? 0)) / expected)}%` : "0";
    row.className = `tl-rate-row tl-rate-${RATE_SIGNS[word] ?? "quiet"}`;
    if (word === shown) return;
    shown = word;
    state.title = note;
    state.replaceChildren(sign(RATE_SIGNS[word] ?? "quiet"), element("span", {}, word));
  };
  return { row, show };
}
