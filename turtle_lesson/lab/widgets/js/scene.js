// The 3-D scene as a widget: its view, and word to the kernel that somebody looks.

function render({ model, el }) {
  const { close } = connect(model);
  const view = sceneView(model, el);
  return () => (view.close(), close());
}

export default { initialize: handOut, render };
