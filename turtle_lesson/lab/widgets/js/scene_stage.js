// meshcat's viewer in a frame of its own, which it fills, and the parts of the scene that it is fed.

const SCENE_PARTS = ["stage", "trail", "tip", "scan", "obstacles", "goal", "turtle"];

const SCENE_FRAME = `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><style>
  html, body, #pane { margin: 0; width: 100%; height: 100%; overflow: hidden; }
  #pane { outline: none; cursor: grab; }
  #pane:active { cursor: grabbing; }
  #pane:focus-visible { box-shadow: inset 0 0 0 3px #56b4e9; }
  canvas { display: block; position: relative; z-index: -1; }
  .dg { display: none; }
</style></head><body><div id="pane" tabindex="0" role="img"></div></body></html>`;

/**
 * The frame with the viewer, made anew whenever the browser loads it again (as when a notebook moves its cell).
 * `ready(viewer, THREE, pane)` is called each time; `failed(error)` where the browser cannot draw in three dimensions.
 */
function sceneStage(model, ready, failed) {
  const frame = element("iframe", { class: "tl-scene-frame", title: "3-D scene", srcdoc: SCENE_FRAME });
  let viewer = null;
  const source = unpacked(model.get("bundle"));

  frame.addEventListener("load", async () => {
    viewer = null;
    const script = await source;
    const inside = frame.contentWindow;
    if (!inside || inside.MeshCat) return;
    try {
      inside.document.head.append(Object.assign(inside.document.createElement("script"), { textContent: script }));
      const pane = inside.document.getElementById("pane");
      const made = new inside.MeshCat.Viewer(pane);
      inside.viewer = viewer = made; // where meshcat's own page has it, too
      SCENE_PARTS.forEach(draw);
      adaptQuality(made, inside);
      ready(made, inside.MeshCat.THREE, pane);
    } catch (error) {
      failed(error);
    }
  });

  /** Bring a part of the scene up to date. */
  function draw(name) {
    if (!viewer) return;
    for (const command of [model.get(name)].flat()) if (command.byteLength) feed(frame.contentWindow, viewer, command);
    if (name === "turtle") viewer.set_property(["lab", "turtle"], "visible", model.get("turtle").byteLength > 0);
  }

  const watch = Object.fromEntries(SCENE_PARTS.map((name) => [name, () => draw(name)]));
  const close = () => viewer?.renderer.dispose();
  return { frame, watch, close };
}

/** Hand one command to the viewer: a copy of its bytes that belongs to the viewer's own frame. */
function feed(inside, viewer, command) {
  const bytes = new inside.Uint8Array(command.byteLength);
  bytes.set(new Uint8Array(command.buffer, command.byteOffset, command.byteLength));
  viewer.handle_command_bytearray(bytes);
}

/** The text in bytes that gzip made. */
function unpacked(view) {
  const bytes = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}
