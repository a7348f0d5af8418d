// The clock: play, pause, step and speed; robot time beside wall time.

const CLOCK_RATES = [0.5, 1, 2, 5, 10, 20, 50, "max"];

function clockPanel(model, order) {
  const named = (name, value) => element("div", { class: "tl-dial" }, element("dt", {}, name), element("dd", {}, value));
  const [robot, wall, speed] = ["", "", ""].map((text) => element("span", {}, text));
  const play = element("button", { class: "tl-button tl-main tl-play", type: "button", onclick: () => toggle() });
  const step = element(
    "button",
    { class: "tl-button", type: "button", title: "Let 0.1 s of robot time pass", onclick: () => order("step", { seconds: 0.1 }) },
    "Step 0.1 s",
  );
  const rate = element("select", { "aria-label": "Speed of robot time", onchange: () => changeRate() });
  for (const each of CLOCK_RATES)
    rate.append(element("option", { value: each }, each === "max" ? "as fast as possible" : `× ${each}`));
  const turn = element("div", { class: "tl-clock-turn" }, play, step, rate);
  const wallDial = named("Wall time since play", wall);
  const speedDial = named("Speed reached", speed);
  const dials = element("dl", { class: "tl-dials" }, named("Robot time", robot), wallDial, speedDial);
  const panel = element("div", { class: "tl-clock", role: "group", "aria-label": "Clock" }, turn, dials);

  const toggle = () => order(model.get("clock").playing ? "pause" : "play");
  const changeRate = () => order("rate", { rate: rate.value === "max" ? "max" : Number(rate.value) });
  const showTime = () => (robot.textContent = `${figure(model.get("now"), 1)} s`);
  const showWall = () => {
    const { seconds, speed: reached } = model.get("wall");
    wall.textContent = seconds ? `${figure(seconds, 1)} s` : "–";
    speed.textContent = reached ? `× ${figure(reached, reached < 9.95 ? 1 : 0)}` : "–";
  };
  const showState = () => {
    const { turns, playing, rate: wanted } = model.get("clock");
    turn.hidden = wallDial.hidden = speedDial.hidden = !turns;
    play.replaceChildren(clockSign(playing), playing ? "Pause" : "Play");
    step.disabled = playing;
    showRate(rate, wanted);
  };
  return { panel, watch: { now: showTime, wall: showWall, clock: showState } };
}

/** Show a rate that a cell has set, also one that is not among those offered. */
function showRate(select, rate) {
  const options = [...select.options];
  if (!options.some(({ value }) => value === String(rate)))
    select.add(element("option", { value: rate }, `× ${rate}`), options.findIndex(({ value }) => !(Number(value) < rate)));
  select.value = String(rate);
}

/** Two bars while it plays, which would pause it; or else a triangle. */
function clockSign(playing) {
  const namespace = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(namespace, "svg");
  const path = document.createElementNS(namespace, "path");
  svg.setAttribute("viewBox", "0 0 12 12");
  svg.setAttribute("aria-hidden", "true");
  path.setAttribute("d", playing ? "M2 1h3v10H2zM7 1h3v10H7z" : "M2 0.5 11.5 6 2 11.5z");
  svg.append(path);
  return svg;
}
