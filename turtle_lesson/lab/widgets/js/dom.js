// Small helpers that every widget shares.

/** An element: element("button", {class: "go", onclick: f}, "Go"). Attributes that are functions become listeners. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child != null));
  return made;
}

/** The Float32Array in a trait of bytes. */
function floats(view) {
  if (!view || !view.byteLength) return new Float32Array(0);
  const bytes = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  return new Float32Array(bytes.slice().buffer);
}

/** A number as people write it, with a true minus sign; a dash for what is no number. */
function figure(value, digits = 2) {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

/** Tell Python that this view is there, until it is closed; returns how to send orders, and how to end. */
function connect(model) {
  const page = (globalThis.turtleLessonPage ??= Math.random().toString(36).slice(2)); // the same for all widgets here
  const view = `${page}/${Math.random().toString(36).slice(2)}`;
  const order = (name, content = {}) => {
    try {
      model.send({ ...content, do: name, view });
    } catch {
      clearInterval(heart); // the kernel is gone, and this view with it: the page's next run makes another
    }
  };
  const heart = setInterval(() => order("alive"), 20000);
  order("open");
  return { order, close: () => (clearInterval(heart), order("close")) };
}

/** Hand out what the kernel sends as one message to the first of several widgets of this page. */
function handOut({ model }) {
  model.on("msg:custom", ({ messages = [] }, buffers) => {
    for (const [id, data, first, end] of messages) {
      const message = { content: { data }, buffers: buffers.slice(first, end) };
      model.widget_manager.get_model(id).then((one) => one._handle_comm_msg(message));
    }
  });
}

/** Call `draw` at the next repaint, however often this is asked for until then. */
function atRepaint(draw) {
  let asked = 0;
  return () => {
    if (!asked) asked = requestAnimationFrame(() => ((asked = 0), draw()));
  };
}

/** A canvas that is sharp on every screen: draw(context, width, height, colours) works in CSS pixels. */
function sharpCanvas(attributes, draw) {
  const canvas = element("canvas", attributes);
  const repaint = atRepaint(() => {
    const { width, height } = canvas.getBoundingClientRect();
    if (!width || !height) return;
    const scale = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * scale), Math.round(height * scale)];
    if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    draw(context, width, height, colours(canvas));
  });
  const sizes = new ResizeObserver(repaint);
  sizes.observe(canvas);
  const themes = new MutationObserver(repaint);
  themes.observe(document.body, { attributes: true, attributeFilter: ["class", "data-jp-theme-name"] });
  return { canvas, repaint, close: () => (sizes.disconnect(), themes.disconnect()) };
}

/** The colours of the style sheet, which follow the page's theme. */
function colours(node) {
  const style = getComputedStyle(node);
  return new Proxy({}, { get: (_, name) => style.getPropertyValue(`--tl-${name}`).trim() });
}

/** Keep keys from becoming Jupyter's shortcuts, which would take even Enter on a button and arrows on a slider.
 * Lumino asks the focused element itself for this attribute, not those around it. */
function keepKeys(root) {
  root.addEventListener("focusin", (event) => event.target.setAttribute("data-lm-suppress-shortcuts", "true"));
}
