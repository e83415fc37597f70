// Geometry of one piece. v is the index of its first vertex, p its own.

const TURN = 2 * Math.PI;

function newBox() { return new Float64Array(4); }
function growBox(box, x, y) {
  if (x < box[0]) box[0] = x;
  if (y < box[1]) box[1] = y;
  if (x > box[2]) box[2] = x;
  if (y > box[3]) box[3] = y;
}
function uniteBox(box, other) {
  growBox(box, other[0], other[1]);
  growBox(box, other[2], other[3]);
}

// Circle, start angle and sweep (positive: counter-clockwise) of an arc.
function arcOf(layer, p, v) {
  const i = 2 * layer.arcBefore[p], cx = layer.centers[i], cy = layer.centers[i + 1];
  const dx = layer.xy[2 * v] - cx, dy = layer.xy[2 * v + 1] - cy;
  const ex = layer.xy[2 * v + 2] - cx, ey = layer.xy[2 * v + 3] - cy;
  const from = Math.atan2(dy, dx);
  let sweep = Math.atan2(dx * ey - dy * ex, dx * ex + dy * ey);  // in (-pi, pi], exact for short arcs
  if (layer.kind[p] === ARC_LEFT) { if (sweep <= 0) sweep += TURN; } else if (sweep >= 0) sweep -= TURN;
  return {cx, cy, r: Math.hypot(dx, dy), from, sweep};
}

function isArc(layer, p) { return layer.kind[p] === ARC_LEFT || layer.kind[p] === ARC_RIGHT; }

// Angle a on the arc? By how far it lies from the start in the arc's own sense.
function onArc(arc, a) {
  const sense = Math.sign(arc.sweep);
  let way = ((a - arc.from) * sense) % TURN;
  if (way < 0) way += TURN;
  return way <= Math.abs(arc.sweep);
}

function pieceBox(layer, p, v, box) {
  const xy = layer.xy;
  box[0] = box[2] = xy[2 * v];
  box[1] = box[3] = xy[2 * v + 1];
  growBox(box, xy[2 * v + 2], xy[2 * v + 3]);
  if (!isArc(layer, p)) return;
  const arc = arcOf(layer, p, v);
  for (let quarter = -2; quarter < 2; ++quarter) {
    const a = quarter * Math.PI / 2;
    if (onArc(arc, a)) growBox(box, arc.cx + arc.r * Math.round(Math.cos(a)), arc.cy + arc.r * Math.round(Math.sin(a)));
  }
}

// Nearest point of the piece to (x, y).
function nearestOnPiece(layer, p, v, x, y) {
  const xy = layer.xy, ax = xy[2 * v], ay = xy[2 * v + 1], bx = xy[2 * v + 2], by = xy[2 * v + 3];
  if (!isArc(layer, p)) {
    const dx = bx - ax, dy = by - ay, dd = dx * dx + dy * dy;
    const t = dd > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / dd)) : 0;
    return {x: ax + t * dx, y: ay + t * dy};
  }
  const arc = arcOf(layer, p, v), a = Math.atan2(y - arc.cy, x - arc.cx);
  if (onArc(arc, a)) return {x: arc.cx + arc.r * Math.cos(a), y: arc.cy + arc.r * Math.sin(a)};
  return Math.hypot(x - ax, y - ay) <= Math.hypot(x - bx, y - by) ? {x: ax, y: ay} : {x: bx, y: by};
}

function pieceLength(layer, p, v) {
  if (layer.kind[p] === HALF_LINE) return Infinity;
  if (isArc(layer, p)) {
    const arc = arcOf(layer, p, v);
    return arc.r * Math.abs(arc.sweep);
  }
  const xy = layer.xy;
  return Math.hypot(xy[2 * v + 2] - xy[2 * v], xy[2 * v + 3] - xy[2 * v + 1]);
}
