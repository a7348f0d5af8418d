// Driving by hand: a stick for the pointer, and keys.

const KEYS = {
  ArrowUp: [1, 0], KeyW: [1, 0],
  ArrowDown: [-1, 0], KeyS: [-1, 0],
  ArrowLeft: [0, 1], KeyA: [0, 1],
  ArrowRight: [0, -1], KeyD: [0, -1],
}; // prettier-ignore
const SIGN_EVERY = 80; // ms: Python stops the turtle after 300 without a sign

function teleopPanel(model, order) {
  const knob = element("div", { class: "tl-knob" });
  const pad = element(
    "div",
    {
      class: "tl-stick",
      tabindex: 0,
      role: "application",
      "aria-label": "Stick. Hold the arrow keys or W, A, S, D to drive; space stops.",
    },
    element("span", { class: "tl-arrow tl-up", "aria-hidden": "true" }, "▲"),
    element("span", { class: "tl-arrow tl-down", "aria-hidden": "true" }, "▼"),
    element("span", { class: "tl-arrow tl-left", "aria-hidden": "true" }, "↺"),
    element("span", { class: "tl-arrow tl-right", "aria-hidden": "true" }, "↻"),
    knob,
  );
  const hand = stickHand(order, (place) => put(place));
  const put = ({ forward, turn }) => {
    knob.style.left = `${50 - 36 * turn}%`;
    knob.style.top = `${50 - 36 * forward}%`;
  };
  followPointer(pad, hand);
  const forgetKeys = followKeys(pad, hand, order, model);

  const forward = speedRow("forward", "m/s", model, order);
  const turn = speedRow("turn", "rad/s", model, order);
  const unheard = element("p", { class: "tl-unheard", role: "status" });
  const count = element("span", { class: "tl-grey" });
  const stop = button("Stop", () => (hand.release(), order("stop")), { class: "tl-button tl-stop" });
  const head = element("div", { class: "tl-head" }, element("h3", {}, `Teleop on ${model.get("topic")}`), count);
  const sides = element("div", { class: "tl-speeds" }, forward.row, turn.row, stop, unheard);
  const panel = element("div", {}, head, element("div", { class: "tl-drive" }, pad, sides));

  const showSent = () => {
    const sent = model.get("sent");
    count.textContent = sent.count ? `${sent.count} sent` : "nothing sent yet";
    forward.show(sent.linear), turn.show(sent.angular);
  };
  const showLimits = () => (forward.showLimit(), turn.showLimit(), showSent());
  const showStick = () => {
    pad.classList.toggle("tl-held", model.get("stick").held);
    if (!hand.held) put(model.get("stick"));
  };
  const showUnheard = () => {
    const program = model.get("program");
    unheard.textContent = program ? `Keys pressed on the stick go to ${program}.` : model.get("unheard");
  };
  const close = () => (hand.release(), forgetKeys());
  return { panel, close, watch: { sent: showSent, limits: showLimits, stick: showStick, unheard: showUnheard, program: showUnheard } };
}

/** What holds the stick: says so again and again, for Python stops the robot when it hears nothing. */
function stickHand(order, moved) {
  let place = null, signs = 0;
  const sign = () => order("drive", place);
  const hand = {
    get held() {
      return place !== null;
    },
    hold(forward, turn) {
      const first = place === null;
      place = { forward, turn };
      moved(place);
      if (first) sign(), (signs = setInterval(sign, SIGN_EVERY));
    },
    release() {
      if (place === null) return;
      clearInterval(signs);
      place = null;
      moved({ forward: 0, turn: 0 });
      order("release");
    },
  };
  return hand;
}

/** Up is forward, left is a turn to the left; a small dead zone in the middle. */
function followPointer(pad, hand) {
  let pointer = null;
  const hold = (event) => {
    const box = pad.getBoundingClientRect();
    const reach = 0.36 * box.width;
    let [right, up] = [(event.clientX - box.left - box.width / 2) / reach, (box.top + box.height / 2 - event.clientY) / reach];
    const far = Math.hypot(right, up);
    if (far > 1) (right /= far), (up /= far);
    if (far < 0.08) right = up = 0;
    hand.hold(up, -right);
  };
  const letGo = (event) => {
    if (event.pointerId === pointer) (pointer = null), hand.release();
  };
  pad.addEventListener("pointerdown", (event) => {
    if (event.button || pointer !== null) return;
    event.preventDefault();
    pointer = event.pointerId;
    pad.setPointerCapture(pointer);
    pad.focus({ preventScroll: true });
    hold(event);
  });
  pad.addEventListener("pointermove", (event) => event.pointerId === pointer && hold(event));
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) pad.addEventListener(name, letGo);
  pad.addEventListener("contextmenu", (event) => event.preventDefault());
}

/**
 * Keys drive while the stick has the focus; letting go, leaving it and hiding the window all stop.
 * While a program reads keys, they go there instead, all but Tab, which leaves the stick.
 */
function followKeys(pad, hand, order, model) {
  const down = new Set();
  const passed = new Map(); // what a program was told, by code: with shift the key that is let go of has another name
  const pass = (event) => {
    const key = event.ctrlKey && event.code === "KeyC" ? "ctrl+c" : event.key;
    if (event.metaKey || event.key === "Tab" || (event.ctrlKey && key !== "ctrl+c" && key !== "Control")) return false;
    passed.set(event.code, key);
    order("key", { key, down: true });
    return true;
  };
  const drive = () => {
    const sum = [...down].reduce(([f, t], key) => [f + KEYS[key][0], t + KEYS[key][1]], [0, 0]);
    const [forward, turn] = sum.map((each) => Math.max(-1, Math.min(1, each)));
    down.size ? hand.hold(forward, turn) : hand.release();
  };
  const letGo = (code) => (order("key", { key: passed.get(code), down: false }), passed.delete(code));
  const stop = () => (down.clear(), hand.release(), [...passed.keys()].forEach(letGo));
  pad.addEventListener("keydown", (event) => {
    if (model.get("program")) {
      if (!pass(event)) return;
    } else if (event.ctrlKey || event.metaKey || event.altKey) return;
    else if (event.code === "Space") stop(), order("stop");
    else if (event.code in KEYS) {
      if (!event.repeat) down.add(event.code), drive();
    } else return;
    event.preventDefault(); // or the page would scroll, and Jupyter take the letter for a shortcut
    event.stopPropagation();
  });
  pad.addEventListener("keyup", (event) => {
    if (passed.has(event.code)) letGo(event.code);
    if (down.delete(event.code)) drive();
  });
  const hidden = () => document.hidden && stop();
  pad.addEventListener("blur", stop);
  window.addEventListener("blur", stop);
  document.addEventListener("visibilitychange", hidden);
  return () => {
    window.removeEventListener("blur", stop);
    document.removeEventListener("visibilitychange", hidden);
  };
}

/** What is sent of one velocity, as a figure and as a bar from the middle, and a slider for the most that can be. */
function speedRow(name, unit, model, order) {
  const title = { forward: "Forward", turn: "Turn to the left" }[name];
  const value = element("output", { class: "tl-value" });
  const bar = element("div", { class: "tl-speedbar", "aria-hidden": "true" }, element("i"));
  const limit = element("output");
  const slider = element("input", {
    type: "range", min: 0.1, max: 5, step: 0.1, "aria-label": `Highest speed: ${title.toLowerCase()}, ${unit}`,
    oninput: () => order("limits", { [name]: Number(slider.value) }),
  }); // prettier-ignore
  const row = element(
    "div",
    { class: "tl-speed", role: "group", "aria-label": title },
    element("span", {}, title),
    element("span", { class: "tl-figure" }, value, ` ${unit}`),
    bar,
    element("small", {}, "at most ", limit, ` ${unit}`),
    slider,
  );
  const show = (speed) => {
    const part = Math.max(-1, Math.min(1, speed / model.get("limits")[name]));
    value.textContent = figure(speed);
    bar.firstChild.style.cssText = `left:${50 + Math.min(0, part) * 50}%;width:${Math.abs(part) * 50}%`;
  };
  const showLimit = () => {
    const most = model.get("limits")[name];
    limit.textContent = figure(most, 1);
    if (slider !== document.activeElement) slider.value = most;
  };
  return { row, show, showLimit };
}

export default { initialize: handOut, render: (context) => mount(context, "teleop", `Teleop on ${context.model.get("topic")}`, teleopPanel) };
