// Fewer pixels while things move where the computer is slow (without a graphics card, say); all of them as soon as it is still.

const QUALITIES = [
  { pixels: 1, shadows: true },
  { pixels: 0.7, shadows: true },
  { pixels: 0.5, shadows: true },
  { pixels: 0.5, shadows: false },
];
const SLOW = 45; // milliseconds from one picture to the next
const STILL = 350; // milliseconds without a new picture

function adaptQuality(viewer, inside) {
  const sharpest = Math.min(inside.devicePixelRatio || 1, 2);
  const sun = viewer.scene_tree.find(["Lights", "Sun", "<object>"]).object;
  const render = viewer.render.bind(viewer);
  let [level, shown, count, mean, last, drawn, rest] = [0, -1, 0, 0, 0, false, 0];

  function use(which) {
    if (which === shown) return;
    shown = which;
    viewer.renderer.setPixelRatio(sharpest * QUALITIES[which].pixels);
    sun.castShadow = QUALITIES[which].shadows;
  }

  viewer.render = () => {
    use(level);
    render();
    drawn = true;
    inside.clearTimeout(rest);
    if (level) rest = inside.setTimeout(() => (use(0), render()), STILL);
  };

  /** After each picture that was drawn, see how long it took until the browser was ready for another one. */
  function judge(now) {
    inside.requestAnimationFrame(judge);
    const gap = now - last;
    last = now;
    if (!drawn || gap > 1500) return;
    drawn = false;
    count += 1;
    mean += (gap - mean) / Math.min(count, 6);
    if (count < 6 || mean < SLOW || level === QUALITIES.length - 1) return;
    [level, count, mean] = [level + 1, 0, 0];
  }

  use(0);
  inside.requestAnimationFrame(judge);
}
