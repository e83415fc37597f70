// Pieces to canvas paths. Canvas works in single precision, so whatever lies far outside the window is bent onto a
// large square around it first; that changes nothing inside.

const FAR = 20000;      // half the side of that square, in pixels
const ROUND = 3000;     // largest radius in pixels left to the canvas

class Pen {
  constructor(camera, path) {
    this.camera = camera;
    this.path = path;
    this.at = -1;  // vertex that the pen is on; -1: up
    this.sx = this.sy = 0;
  }

  clamp(s, half) { return Math.min(half + FAR, Math.max(half - FAR, s)); }

  moveTo(x, y) {
    const c = this.camera;
    this.sx = c.screenX(x);
    this.sy = c.screenY(y);
    this.path.moveTo(this.clamp(this.sx, c.width / 2), this.clamp(this.sy, c.height / 2));
  }

  lineTo(x, y) { this.screenLine(this.camera.screenX(x), this.camera.screenY(y)); }

  screenLine(ex, ey) {
    const c = this.camera, hx = c.width / 2, hy = c.height / 2, sx = this.sx, sy = this.sy;
    if (Math.abs(sx - hx) > FAR || Math.abs(sy - hy) > FAR || Math.abs(ex - hx) > FAR || Math.abs(ey - hy) > FAR) {
      // Between the crossings of the square's four lines, bending onto the square is a straight map.
      const cuts = [];
      for (const [s, e, h] of [[sx, ex, hx], [sy, ey, hy]]) {
        for (const edge of [h - FAR, h + FAR]) {
          const t = (edge - s) / (e - s);
          if (t > 0 && t < 1) cuts.push(t);
        }
      }
      cuts.sort((a, b) => a - b);
      for (const t of cuts) this.path.lineTo(this.clamp(sx + t * (ex - sx), hx), this.clamp(sy + t * (ey - sy), hy));
    }
    this.path.lineTo(this.clamp(ex, hx), this.clamp(ey, hy));
    this.sx = ex;
    this.sy = ey;
  }

  piece(layer, p, v) {
    const xy = layer.xy;
    if (isArc(layer, p)) this.arc(arcOf(layer, p, v));
    this.lineTo(xy[2 * v + 2], xy[2 * v + 3]);  // after an arc: closes the last rounding error only
  }

  arc(arc) {
    const c = this.camera, r = arc.r * c.scale, sx = c.screenX(arc.cx), sy = c.screenY(arc.cy);
    if (r * (1 - Math.cos(Math.min(Math.PI, Math.abs(arc.sweep) / 2))) < 0.1) return;  // no pixel from its chord
    if (r < ROUND && Math.abs(sx - c.width / 2) < FAR && Math.abs(sy - c.height / 2) < FAR) {
      this.path.arc(sx, sy, r, -arc.from, -arc.from - arc.sweep, arc.sweep > 0);
      this.sx = sx + r * Math.cos(arc.from + arc.sweep);
      this.sy = sy - r * Math.sin(arc.from + arc.sweep);
      return;
    }
    const parts = Math.ceil(Math.abs(arc.sweep) / (Math.PI / 4));
    for (let i = 0; i < parts; ++i) {
      this.flatten(sx, sy, r, arc.from + arc.sweep * i / parts, arc.from + arc.sweep * (i + 1) / parts);
    }
  }

  // Huge circles: halves until a part is out of the window or within a tenth of a pixel of its chord.
  flatten(sx, sy, r, a, b) {
    const c = this.camera, sag = r * (1 - Math.cos((b - a) / 2));
    const x0 = sx + r * Math.cos(a), y0 = sy - r * Math.sin(a), x1 = sx + r * Math.cos(b), y1 = sy - r * Math.sin(b);
    const out = Math.max(x0, x1) + sag < -20 || Math.min(x0, x1) - sag > c.width + 20 ||
      Math.max(y0, y1) + sag < -20 || Math.min(y0, y1) - sag > c.height + 20;
    if (out || sag < 0.1) { this.screenLine(x1, y1); return; }
    const middle = (a + b) / 2;
    this.flatten(sx, sy, r, a, middle);
    this.flatten(sx, sy, r, middle, b);
  }
}

// The inside as one path for filling by the even-odd rule; a profile's ends lie far below, where its path closes.
function fillPath(chunks, camera, view) {
  const layer = chunks.layer, path = new Path2D(), pen = new Pen(camera, path), xy = layer.xy;
  const sink = {
    hidden: v => pen.lineTo(xy[2 * v], xy[2 * v + 1]),
    coarse: v => pen.lineTo(xy[2 * v], xy[2 * v + 1]),
    piece: (p, v) => pen.piece(layer, p, v),
  };
  for (let c = 0; c < layer.chains; ++c) {
    if (!chunks.visible(c, view)) continue;
    const v = layer.vertexBegin[c];
    pen.moveTo(xy[2 * v], xy[2 * v + 1]);
    chunks.walk(c, view, sink);  // no closePath(): filling closes by itself, and its cost in Chromium grows with the path
  }
  return path;
}

// Boundaries sorted by what they are made of: {segment, arc, mixed, half, hole}; mixed where runs are below a pixel, and
// everywhere without options.kinds.
function strokePaths(chunks, camera, view, options) {
  const layer = chunks.layer, xy = layer.xy, pens = {}, paths = {};
  for (const name of ['segment', 'arc', 'mixed', 'half', 'hole']) pens[name] = new Pen(camera, paths[name] = new Path2D());
  let at = 0, hole = false, drawn = 0;
  const start = pen => { if (pen.at !== at) pen.moveTo(xy[2 * at], xy[2 * at + 1]); };
  const straight = (pen, v) => { start(pen); pen.lineTo(xy[2 * v], xy[2 * v + 1]); at = pen.at = v; ++drawn; };
  const sink = {
    hidden: v => { at = v; },
    coarse: v => {
      if (hole && options.holes) straight(pens.hole, v);
      if (options.segments || options.arcs) straight(pens.mixed, v);
      at = v;
    },
    piece: (p, v) => {
      const kind = layer.kind[p], arc = kind === ARC_LEFT || kind === ARC_RIGHT;
      const draw = pen => { start(pen); pen.piece(layer, p, v); pen.at = v + 1; ++drawn; };
      if (hole && options.holes) draw(pens.hole);
      if (kind === HALF_LINE) draw(pens.half);
      else if (arc ? options.arcs : options.segments) draw(!options.kinds ? pens.mixed : arc ? pens.arc : pens.segment);
      at = v + 1;
    },
  };
  for (let c = 0; c < layer.chains; ++c) {
    if (!chunks.visible(c, view)) continue;
    at = layer.vertexBegin[c];
    hole = layer.chainKind[c] === HOLE;
    chunks.walk(c, view, sink);
  }
  return {paths, drawn};
}
