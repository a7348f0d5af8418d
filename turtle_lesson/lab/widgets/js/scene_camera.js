// From where one looks at the scene: freely, from behind the turtle, or from above. Also lets the turtle walk.
// The viewer's own axes: x to the right, y up, and z towards the reader (the world's -y).

const FLIGHT = 600; // milliseconds from one view to another
const LEGS = { front_left: 1, hind_right: 1, front_right: -1, hind_left: -1 };

function sceneCamera(viewer, THREE, pane) {
  const inside = pane.ownerDocument.defaultView;
  const { camera, controls } = viewer;
  const turtle = turtlePose(viewer, THREE);
  const walk = turtleWalk(viewer);
  let mode = "free";
  let flight = null;
  let followed = turtle();
  let last = inside.performance.now();

  Object.assign(camera, { fov: 38, near: 0.1, far: 150 });
  Object.assign(controls, { minDistance: 1.2, maxDistance: 50, maxPolarAngle: 1.52, enableZoom: false, zoomSpeed: 0.8 });
  controls.addEventListener("start", () => (flight = null));
  // the wheel scrolls the page, until somebody has clicked into the scene
  pane.addEventListener("focus", () => (controls.enableZoom = true));
  pane.addEventListener("blur", () => (controls.enableZoom = false));
  pane.addEventListener("pointerdown", () => pane.focus({ preventScroll: true }));
  pane.addEventListener("keydown", (event) => {
    if (key(event.key)) event.preventDefault();
  });

  const views = {
    free: () => outlook([0.3 * wide(18), 0.68 * wide(18), 0.74 * wide(18)], [0.15, 0, 0.75]),
    top: () => outlook([0, wide(18.8), 0.001], [0, 0, 0]),
    follow: () => {
      const { place, turn } = turtle();
      const ahead = new THREE.Vector3(Math.cos(turn), 0, -Math.sin(turn));
      const behind = place.clone().addScaledVector(ahead, -3.4).setY(2.1);
      return { position: behind, target: place.clone().addScaledVector(ahead, 0.9).setY(0.15) };
    },
  };
  const outlook = (position, target) => ({
    position: new THREE.Vector3(...position),
    target: new THREE.Vector3(...target),
  });
  /** The distance at which the whole world is seen, in a narrow frame, too. */
  const wide = (far) => far * Math.max(1, 1.3 / (camera.aspect || 1.6));

  /** Change to a view; `at once` without flying there. */
  function look(name, atOnce) {
    mode = name;
    controls.enableRotate = name !== "top";
    const still = inside.matchMedia("(prefers-reduced-motion: reduce)").matches;
    const [position, target] = [camera.position.clone(), controls.target.clone()];
    flight = { position, target, begin: inside.performance.now(), lasts: atOnce || still ? 0 : FLIGHT };
    viewer.set_dirty();
  }

  function step(now) {
    inside.requestAnimationFrame(step);
    const seconds = Math.min((now - last) / 1000, 0.1);
    last = now;
    if (walk(turtle(), seconds)) viewer.set_dirty();
    if (flight) fly(now);
    else if (mode === "follow") follow(seconds);
  }

  function fly(now) {
    const part = flight.lasts ? Math.min((now - flight.begin) / flight.lasts, 1) : 1;
    const eased = part * part * (3 - 2 * part);
    const { position, target } = views[mode]();
    camera.position.lerpVectors(flight.position, position, eased);
    controls.target.lerpVectors(flight.target, target, eased);
    if (part === 1) (flight = null), (followed = turtle());
    viewer.set_dirty();
  }

  /** Go and turn with the turtle, softly, and keep the view that the reader has chosen. */
  function follow(seconds) {
    const { place, turn } = turtle();
    const went = place.clone().sub(followed.place).multiplyScalar(1 - Math.exp(-seconds / 0.1));
    const turned = wrapped(turn - followed.turn) * (1 - Math.exp(-seconds / 0.45));
    if (went.length() < 1e-5 && Math.abs(turned) < 1e-5) return;
    const up = new THREE.Vector3(0, 1, 0);
    for (const point of [camera.position, controls.target])
      point.sub(followed.place).applyAxisAngle(up, turned).add(followed.place).add(went);
    followed = { place: followed.place.clone().add(went), turn: followed.turn + turned };
    viewer.set_dirty();
  }

  /** Turn around what one looks at (rad), and rise above it. */
  function orbit(around, rise) {
    const ball = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    ball.theta += around;
    ball.phi = Math.min(Math.max(ball.phi - rise, 0.02), controls.maxPolarAngle);
    moveTo(new THREE.Vector3().setFromSpherical(ball));
  }

  function zoom(factor) {
    const arm = camera.position.clone().sub(controls.target);
    moveTo(arm.setLength(Math.min(Math.max(arm.length() * factor, controls.minDistance), controls.maxDistance)));
  }

  function moveTo(arm) {
    flight = null;
    camera.position.copy(controls.target).add(arm);
    viewer.set_dirty();
  }

  /** What a key does; false for a key that does nothing. */
  function key(name) {
    const turning = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] }[name];
    const factor = { "+": 0.85, "=": 0.85, "-": 1 / 0.85 }[name];
    if (turning && mode !== "top") orbit(...turning);
    else if (factor) zoom(factor);
    else if (name === "Home") look(mode);
    else return false;
    return true;
  }

  inside.requestAnimationFrame(step);
  return { look, zoom };
}

/** A function that says where the turtle is, and how it is turned. */
function turtlePose(viewer, THREE) {
  const group = viewer.scene_tree.find(["lab", "turtle"]).object;
  return () => {
    const place = group.getWorldPosition(new THREE.Vector3());
    return { place, turn: 2 * Math.atan2(group.quaternion.z, group.quaternion.w) };
  };
}

/** A function that swings the turtle's legs as it goes and turns; true while they move. */
function turtleWalk(viewer) {
  const legs = Object.entries(LEGS).map(([name, side]) => {
    return { side, turns: viewer.scene_tree.find(["lab", "turtle", name, "swing"]).object.rotation };
  });
  let [before, stride, swing] = [null, 0, 0];
  return ({ place, turn }, seconds) => {
    const went = before ? place.distanceTo(before.place) + 0.25 * Math.abs(wrapped(turn - before.turn)) : 0;
    before = { place, turn };
    if (went < 0.6) stride += 7 * went; // farther in a moment only when it is put elsewhere
    const aim = went > 1e-5 && went < 0.6 ? 0.4 : 0;
    swing += (aim - swing) * (1 - Math.exp(-seconds / 0.12));
    if (swing < 0.004) return false;
    for (const { side, turns } of legs) turns.z = swing * Math.sin(stride) * side;
    return true;
  };
}

/** An angle brought to within half a turn. */
function wrapped(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}
