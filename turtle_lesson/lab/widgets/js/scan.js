// The scan, as the turtle sees it: ahead is up, the free space is a fan, a dot is where a beam hits something.

function scanPanel(model) {
  const { canvas, repaint, close } = sharpCanvas({ class: "tl-scan", "aria-hidden": "true" }, draw);
  const nearest = element("p", { class: "tl-scan-nearest" });
  const count = element("p", { class: "tl-scan-count" });
  const panel = element("div", {}, canvas, nearest, count);

  function draw(context, width, height, colour) {
    const [angle, step, reach, ...ranges] = floats(model.get("scan"));
    if (!ranges.length) {
      fitScan(context, width, height, false);
      return drawRings(context, 10, context.scanSize, false, colour);
    }
    const beams = ranges.map((range, at) => ({ range, turn: angle + at * step }));
    const whole = beams.some(({ turn }) => Math.abs(turn) > 1.75);
    fitScan(context, width, height, whole);
    context.globalAlpha = model.get("scan_words").note ? 0.35 : 1;
    drawScan(context, beams, reach, model.get("scan_words").beam, whole, colour);
  }
  const showWords = () => {
    const words = model.get("scan_words");
    nearest.replaceChildren(...(words.nearest ? ["Nearest: ", element("strong", {}, words.nearest)] : []));
    count.textContent = words.note || words.count;
    repaint();
  };
  return { title: "Scan", aside: "/obstacles", panel, close, watch: { scan: repaint, scan_words: showWords } };
}

/** Set the context so that the turtle is at (0, 0), ahead is up, and the scanner's reach is 1. */
function fitScan(context, width, height, whole) {
  const size = whole ? Math.min(width, height) / 2 - 14 : Math.min(width / 2 - 24, height - 30);
  context.translate(width / 2, whole ? height / 2 : height - 14);
  context.scanSize = size; // one metre's worth of pixels times the reach; lines keep their width, so no scale()
}

function drawScan(context, beams, reach, nearest, whole, colour) {
  const size = context.scanSize;
  const at = (turn, range) => [(-Math.sin(turn) * range * size) / reach, (-Math.cos(turn) * range * size) / reach];
  const sees = ({ range }) => Number.isFinite(range) && range >= 0 && range < reach - 1e-3;
  const free = new Path2D();
  free.moveTo(0, 0);
  for (const beam of beams) free.lineTo(...at(beam.turn, sees(beam) ? beam.range : reach));
  context.fillStyle = colour.free;
  context.fill(free);
  drawRings(context, reach, size, whole, colour);
  context.fillStyle = colour.laser;
  for (const beam of beams.filter(sees)) dot(context, at(beam.turn, beam.range), 1.7);
  if (beams[nearest]) {
    context.strokeStyle = colour.ink;
    context.lineWidth = 1.5;
    dot(context, at(beams[nearest].turn, beams[nearest].range), 6, true);
  }
  context.rotate(-Math.PI / 2); // the turtle is drawn looking along x
  context.scale(20, -20);
  turtle(context, 0, 0, 0, colour);
}

function drawRings(context, reach, size, whole, colour) {
  const half = whole ? Math.PI : Math.PI / 2;
  const step = [1, 2, 5, 10, 20, 50].find((each) => reach / each <= 5) ?? reach / 4;
  context.lineWidth = 1;
  context.strokeStyle = colour.line;
  context.beginPath();
  for (let turn = -half; turn <= half + 1e-6; turn += Math.PI / 6) {
    context.moveTo(0, 0);
    context.lineTo(-Math.sin(turn) * size, -Math.cos(turn) * size);
  }
  for (let ring = step; ring <= reach + 1e-6; ring += step) {
    const radius = (ring / reach) * size;
    context.moveTo(Math.sin(half) * radius, -Math.cos(half) * radius);
    context.arc(0, 0, radius, half - Math.PI / 2, -half - Math.PI / 2, true);
  }
  context.stroke();
  nameRings(context, reach, size, step, colour);
}

function nameRings(context, reach, size, step, colour) {
  context.fillStyle = colour.grey;
  context.font = "10px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (let ring = step; ring <= reach + 1e-6; ring += step) {
    const last = ring + step > reach + 1e-6;
    context.fillText(last ? `${figure(ring, 0)} m` : figure(ring, 0), (ring / reach) * size, 8);
  }
  for (const [degrees, turn] of [["+60°", 1], ["+30°", 0.5], ["0°", 0], ["−30°", -0.5], ["−60°", -1]]) {
    const side = (turn * Math.PI) / 3;
    context.fillText(degrees, -Math.sin(side) * (size + 14), -Math.cos(side) * (size + 9));
  }
}

function dot(context, [x, y], radius, hollow = false) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  if (hollow) context.stroke();
  else context.fill();
}
