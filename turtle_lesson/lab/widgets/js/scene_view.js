// What one sees of the 3-D scene: the frame with the viewer, buttons for the camera, and the scene in words.

const SCENE_VIEWS = { free: "Free", follow: "Follow", top: "From above" };

/** Show the scene in `el`. Returns {root, ready: a promise of the viewer, close}. */
function sceneView(model, el) {
  let viewer = null;
  let camera = null;
  let mode = "free";
  let dark = null;
  let arrived;
  const ready = new Promise((done) => (arrived = done));

  const stage = sceneStage(model, begin, fail);
  const views = Object.entries(SCENE_VIEWS).map(([name, label]) => [name, sceneButton(label, () => choose(name))]);
  const laser = sceneButton("Laser", () => showLaser());
  laser.setAttribute("aria-pressed", "true");
  const near = sceneButton("+", () => camera?.zoom(0.8), "Nearer");
  const far = sceneButton("−", () => camera?.zoom(1.25), "Farther");
  const tools = element(
    "div",
    { class: "tl-scene-tools" },
    sceneGroup("Camera", ...views.map(([, button]) => button)),
    sceneGroup("Distance", far, near),
    sceneGroup("Shown", laser),
  );
  const caption = element("p", { class: "tl-scene-caption" });
  const spoken = element("p", { class: "tl-scene-words", role: "status", "aria-live": "polite" });
  const box = element("div", { class: "tl-scene-box" }, stage.frame, tools);
  const foot = element("div", { class: "tl-scene-foot" }, caption, spoken);
  const root = element("div", { class: "tl-root tl-scene" }, box, foot);
  el.append(root);

  /** The viewer is there: for the first time, or again after the browser has reloaded its frame. */
  function begin(made, THREE, pane) {
    viewer = made;
    camera = sceneCamera(made, THREE, pane);
    dark = null;
    follow();
    describe();
    made.set_property(["lab", "scan"], "visible", pressed(laser));
    camera.look(mode, true);
    arrived(made);
  }

  function fail(error) {
    spoken.textContent = `This browser cannot draw the scene in 3D: ${error.message}`;
    box.classList.add("tl-scene-failed");
  }

  function choose(name) {
    mode = name;
    for (const [each, button] of views) button.setAttribute("aria-pressed", String(each === name));
    camera?.look(name);
  }

  function showLaser() {
    laser.setAttribute("aria-pressed", String(!pressed(laser)));
    viewer?.set_property(["lab", "scan"], "visible", pressed(laser));
    viewer?.set_dirty();
  }

  const pressed = (button) => button.getAttribute("aria-pressed") === "true";
  for (const [name, button] of views) button.setAttribute("aria-pressed", String(name === mode));

  /** Follow the page's theme, which no event tells of everywhere. */
  function follow() {
    const now = isDark(root);
    if (viewer && now !== dark) paintScene(viewer, (dark = now));
  }
  const looking = setInterval(follow, 500);

  function describe() {
    caption.textContent = model.get("description");
    const pane = stage.frame.contentDocument?.getElementById("pane");
    const keys = "Arrow keys turn the view, plus and minus change the distance.";
    pane?.setAttribute("aria-label", `${model.get("description")} ${keys}`);
  }

  function speak() {
    const gone = "This world is gone: a newer start() has taken its place.";
    spoken.textContent = model.get("ended") ? gone : model.get("words");
    root.classList.toggle("tl-ended", Boolean(model.get("ended")));
  }

  /** No button for a laser that nobody has heard. */
  const offer = () => (laser.parentElement.hidden = !model.get("scan").length);
  const drawScan = stage.watch.scan;
  stage.watch.scan = () => (drawScan(), offer());

  const watched = Object.entries({ ...stage.watch, description: describe, words: speak, ended: speak });
  for (const [name, changed] of watched) model.on(`change:${name}`, changed);
  describe(), speak(), offer();
  return {
    root,
    box,
    ready,
    frame: stage.frame,
    close: () => {
      clearInterval(looking);
      for (const [name, changed] of watched) model.off(`change:${name}`, changed);
      stage.close();
    },
  };
}

function sceneButton(text, onclick, label) {
  return element("button", { class: "tl-scene-button", type: "button", onclick, "aria-label": label, title: label }, text);
}

function sceneGroup(label, ...buttons) {
  return element("div", { class: "tl-scene-group", role: "group", "aria-label": label }, ...buttons);
}
