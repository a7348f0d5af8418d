// A page that is only the scene: the same view, of a state that is written in the page. A replay has a play bar, too.

const PLAY_RATES = [0.5, 1, 2, 5, 10];

function openPage() {
  const state = read(JSON.parse(document.getElementById("state").textContent));
  const model = { get: (name) => state[name], on: () => {}, off: () => {} };
  setInterval(followNotebook, 500), followNotebook();
  const view = sceneView(model, document.getElementById("page"));
  if (!state.animation) return;
  const bar = playBar(state.begin, state.seconds);
  view.box.after(bar.panel);
  view.ready.then((viewer) => {
    feed(view.frame.contentWindow, viewer, state.animation);
    viewer.animator.play(), viewer.animator.pause(); // only then a track can be wound to and fro
    const grow = growingTrail(viewer, floats(state.growth));
    bar.start((time) => (grow(time), viewer.animator.seek(time)));
  });
}

/** A function that draws as much of the trail as there is at a time: `growth` has times, each with a number of corners. */
function growingTrail(viewer, growth) {
  if (!growth.length) return () => {};
  const { geometry } = viewer.scene_tree.find(["lab", "trail", "<object>"]).object;
  return (time) => {
    let at = 0;
    while (at + 2 < growth.length && growth[at + 2] <= time) at += 2;
    const amount = growth[at + 1];
    const [end, later] = at + 2 < growth.length ? growth.subarray(at + 2, at + 4) : [Infinity, amount];
    const part = Math.min(Math.max((time - growth[at]) / (end - growth[at]), 0), 1);
    geometry.setDrawRange(0, 6 * Math.floor((amount + part * (later - amount)) / 6));
  };
}

/** Bytes were written as base64. */
function read(value) {
  if (Array.isArray(value)) return value.map(read);
  if (value === null || typeof value !== "object") return value;
  if ("base64" in value) return new DataView(Uint8Array.from(atob(value.base64), (each) => each.charCodeAt(0)).buffer);
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, read(each)]));
}

/** Inside a notebook, be as dark as the notebook. */
function followNotebook() {
  try {
    const light = parent !== window && parent.document.body.dataset.jpThemeLight;
    if (light) document.documentElement.dataset.theme = light === "true" ? "light" : "dark";
  } catch {
    // a page of somebody else's: the browser's own choice stays
  }
}

/** Play, pause, a slider for the time, and the speed. `start(show)` begins it: `show(seconds)` is called for each picture. */
function playBar(begin, seconds) {
  let [time, playing, last, show] = [0, false, 0, () => {}];
  const play = sceneButton("Play", () => run(!playing));
  play.classList.add("tl-scene-play");
  const range = { type: "range", min: 0, max: seconds, step: 0.01, value: 0 };
  const slider = element("input", { ...range, "aria-label": "Robot time", oninput: () => wind() });
  const clock = element("output", { class: "tl-scene-time" });
  const rate = element("select", { class: "tl-scene-rate", "aria-label": "Speed" });
  for (const each of PLAY_RATES) rate.append(element("option", { value: each, selected: each === 1 }, `×${each}`));
  const look = { class: "tl-scene-play-bar", role: "group", "aria-label": "Replay" };
  const panel = element("div", look, play, slider, clock, rate);

  function run(go) {
    if (go && time >= seconds) time = 0;
    playing = go;
    play.textContent = go ? "Pause" : "Play";
    last = performance.now();
    if (go) requestAnimationFrame(step);
  }

  function step(now) {
    if (!playing) return;
    time = Math.min(time + Math.max(0, (now - last) / 1000) * Number(rate.value), seconds);
    last = now;
    tell();
    if (time >= seconds) run(false);
    else requestAnimationFrame(step);
  }

  function wind() {
    time = Number(slider.value);
    tell();
  }

  function tell() {
    slider.value = String(time);
    clock.textContent = `${figure(begin + time, 1)} s`;
    slider.setAttribute("aria-valuetext", `${figure(begin + time, 1)} seconds of robot time`);
    show(time);
  }

  tell();
  return { panel, start: (draw) => ((show = draw), tell()) };
}

openPage();
