// The clock: play, pause, step and rate; robot time beside wall time.

const CLOCK_RATES = [0.5, 1, 2, 5, 10, 20, 50];

function clockPanel(model, order) {
  const time = element("span", { class: "tl-time" });
  const play = element("button", { class: "tl-button tl-play", type: "button", onclick: () => toggle() });
  const step = element(
    "button",
    { class: "tl-button", type: "button", title: "Let 0.1 s of robot time pass", onclick: () => order("step", { seconds: 0.1 }) },
    "Step",
  );
  const rate = element("select", { class: "tl-rate", "aria-label": "Speed of robot time", onchange: () => changeRate() });
  for (const each of CLOCK_RATES) rate.append(element("option", { value: each }, `×${each}`));
  const panel = element("div", { class: "tl-clock", role: "group", "aria-label": "Clock" }, play, step, rate, time);

  const toggle = () => (model.get("clock").playing ? order("pause") : order("play", { rate: Number(rate.value) }));
  const changeRate = () => model.get("clock").playing && order("play", { rate: Number(rate.value) });
  const showTime = () => (time.textContent = `${figure(model.get("now"), 1)} s of robot time`);
  const showState = () => {
    const { turns, playing, rate: now } = model.get("clock");
    panel.hidden = !turns;
    play.textContent = playing ? "Pause" : "Play";
    play.setAttribute("aria-pressed", playing ? "true" : "false");
    step.disabled = playing;
    if (CLOCK_RATES.includes(now)) rate.value = String(now);
  };
  return { panel, watch: { now: showTime, clock: showState } };
}
