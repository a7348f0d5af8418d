// The list of goals that were sent, and what became of each.

function goalsPanel(model) {
  const list = element("ol", { class: "tl-goals", "aria-label": "Goals sent" });
  const show = () =>
    list.replaceChildren(
      ...[...model.get("goals")].reverse().map((goal) =>
        element(
          "li",
          { class: `tl-goal tl-${goal.state.replace(/ /g, "-")}` },
          `${goal.number}. (${figure(goal.x)}, ${figure(goal.y)}) ${goal.state}`,
          goal.answer ? element("small", {}, goal.answer) : null,
        ),
      ),
    );
  return { panel: list, watch: { goals: show } };
}
