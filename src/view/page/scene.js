// Draws the layers; keeps the last picture so that a large result can be moved while the next one is on its way.

const SLOW = 35;  // milliseconds; a picture that takes longer is moved as it is until the hand rests

class Scene {
  constructor(canvas, page, camera) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.page = page;
    this.camera = camera;
    this.options = {fill: true, segments: true, arcs: true, holes: false, vertices: false};
    this.back = document.createElement('canvas');
    this.chunks = page.layers.map(layer => new Chunks(layer));
    this.hit = null;      // what the pointer is on
    this.cost = 0;        // milliseconds for the last full picture
    this.frames = 0;
    this.drawn = 0;       // pieces and chords in the last full picture
    this.taken = null;    // camera of the picture in `back`
    this.wanted = false;
    this.readColors();
  }

  readColors() {
    const style = getComputedStyle(document.documentElement);
    this.color = {};
    for (const name of ['paper', 'ink', 'segment', 'arc', 'mixed', 'hole', 'input', 'vertex', 'hit', 'half',
      'tint-near', 'tint-far']) this.color[name] = style.getPropertyValue('--' + name).trim();
  }

  // From pale for the largest radius to strong for the smallest.
  tint(layer) {
    const zones = this.page.layers.filter(l => l.role !== 'input'), k = zones.indexOf(layer);
    const t = zones.length > 1 ? k / (zones.length - 1) : 0.55;
    const rgb = text => [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16));
    const far = rgb(this.color['tint-far']), near = rgb(this.color['tint-near']);
    return `rgb(${far.map((f, i) => Math.round(f + (near[i] - f) * t)).join(' ')})`;
  }

  resize() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    this.ratio = ratio;
    this.camera.width = Math.max(1, box.width);
    this.camera.height = Math.max(1, box.height);
    for (const c of [this.canvas, this.back]) {
      c.width = Math.round(this.camera.width * ratio);
      c.height = Math.round(this.camera.height * ratio);
    }
    this.taken = null;
  }

  // Asks for a picture. moving: a hand is at it, speed counts more than sharpness.
  request(moving = false) {
    this.moving = moving;
    this.stale = true;
    this.schedule();
  }
  requestOverlay() { this.schedule(); }
  schedule() {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => { this.wanted = false; this.frame(); });
  }

  frame() {
    if (this.stale && this.moving && this.cost > SLOW && this.taken) {
      this.showMoved();
      clearTimeout(this.rest);
      this.rest = setTimeout(() => this.request(false), 120);
      return;
    }
    if (this.stale) this.render();
    const g = this.context;
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.drawImage(this.back, 0, 0);
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    if (this.hit) this.drawHit(g, this.hit);
    ++this.frames;
  }

  showMoved() {
    const g = this.context, c = this.camera, t = this.taken, zoom = c.scale / t.scale;
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.fillStyle = this.color.paper;
    g.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const x = c.screenX(t.x) - c.width / 2 * zoom, y = c.screenY(t.y) - c.height / 2 * zoom;
    g.drawImage(this.back, x * this.ratio, y * this.ratio, this.back.width * zoom, this.back.height * zoom);
    ++this.frames;
  }

  render() {
    const begin = performance.now(), g = this.back.getContext('2d');
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.fillStyle = this.color.paper;
    g.fillRect(0, 0, this.camera.width, this.camera.height);
    g.lineJoin = g.lineCap = 'round';
    this.drawn = 0;
    const view = this.camera.window(), shown = this.chunks.filter(chunks => chunks.layer.shown);
    const bodies = shown.filter(chunks => chunks.layer.role !== 'input');
    if (this.options.fill) for (const chunks of bodies) this.fillLayer(g, chunks, view);
    for (const chunks of shown) if (chunks.layer.role === 'input') this.strokeInput(g, chunks, view);
    for (const chunks of bodies) this.strokeLayer(g, chunks, view);
    if (this.options.vertices) for (const chunks of bodies) this.drawVertices(g, chunks, view);
    this.taken = {x: this.camera.x, y: this.camera.y, scale: this.camera.scale};
    this.stale = false;
    this.cost = performance.now() - begin;
  }

  fillLayer(g, chunks, view) {
    g.fillStyle = this.tint(chunks.layer);
    g.fill(fillPath(chunks, this.camera, view), 'evenodd');
  }

  // Mean length of a piece in pixels.
  fineness(layer) { return layer.perimeter / Math.max(1, layer.segments + layer.arcs) * this.camera.scale; }

  // Thin lines where pieces are a few pixels long, bolder ones where each can be told from its neighbours.
  lineWidth(layer) { return 0.8 + 1.4 * Math.min(1, this.fineness(layer) / 30); }

  strokeLayer(g, chunks, view) {
    const layer = chunks.layer, width = this.lineWidth(layer);
    // Kinds have colours where they can be told apart; below that they would only mix to mud.
    const options = {...this.options, kinds: this.fineness(layer) > 3};
    const {paths, drawn} = strokePaths(chunks, this.camera, view, options);
    this.drawn += drawn;
    const line = (name, lineWidth, dash = []) => {
      g.strokeStyle = this.color[name];
      g.lineWidth = lineWidth;
      g.setLineDash(dash);
      g.stroke(paths[name]);
    };
    line('hole', options.kinds ? width + 3 : 1.6);
    line('mixed', 0.6);
    line('half', 1.2, [5, 4]);
    line('segment', width);
    line('arc', width);
    g.setLineDash([]);
  }

  strokeInput(g, chunks, view) {
    const {paths, drawn} = strokePaths(chunks, this.camera, view, {segments: true, arcs: true, kinds: true});
    const layer = chunks.layer;
    this.drawn += drawn;
    g.strokeStyle = g.fillStyle = this.color.input;
    g.lineWidth = this.lineWidth(layer) * 0.9;
    g.stroke(paths.mixed);
    g.stroke(paths.segment);
    for (let c = 0; c < layer.chains; ++c) {
      const v = layer.vertexBegin[c];
      if (layer.vertexBegin[c + 1] - v > 1) continue;
      const x = layer.xy[2 * v], y = layer.xy[2 * v + 1];
      if (x < view.left || x > view.right || y < view.bottom || y > view.top) continue;
      g.fillRect(this.camera.screenX(x) - 1.5, this.camera.screenY(y) - 1.5, 3, 3);
    }
  }

  // Only where neighbours are at least a few pixels apart: elsewhere dots would hide the lines.
  drawVertices(g, chunks, view) {
    const layer = chunks.layer, xy = layer.xy, size = 1.7;
    const sparse = {...view, detail: 14 / this.camera.scale}, nothing = () => {};
    const dot = v => {
      const x = this.camera.screenX(xy[2 * v]), y = this.camera.screenY(xy[2 * v + 1]);
      if (x > -9 && y > -9 && x < this.camera.width + 9 && y < this.camera.height + 9) {
        g.moveTo(x + size, y);
        g.arc(x, y, size, 0, TURN);
      }
    };
    g.fillStyle = this.color.vertex;
    g.beginPath();
    for (let c = 0; c < layer.chains; ++c) {
      if (!chunks.visible(c, sparse)) continue;
      chunks.walk(c, sparse, {hidden: nothing, coarse: nothing, piece: (p, v) => { dot(v); dot(v + 1); }});
    }
    g.fill();
  }

  // The piece under the pointer and what causes it.
  drawHit(g, hit) {
    const {layer, p, v} = hit, path = new Path2D(), pen = new Pen(this.camera, path);
    pen.moveTo(layer.xy[2 * v], layer.xy[2 * v + 1]);
    pen.piece(layer, p, v);
    g.lineCap = 'round';
    g.strokeStyle = this.color.paper;
    g.lineWidth = 7;
    g.stroke(path);
    g.strokeStyle = this.color.hit;
    g.lineWidth = 3.5;
    g.stroke(path);
    this.drawCause(g, causeOf(this.page, hit));
  }

  drawCause(g, cause) {
    if (!cause) return;
    const line = (points, dash, width) => {
      const path = new Path2D(), pen = new Pen(this.camera, path);
      pen.moveTo(points[0].x, points[0].y);
      for (const q of points.slice(1)) pen.lineTo(q.x, q.y);
      g.setLineDash(dash);
      g.lineWidth = width;
      g.stroke(path);
    };
    g.strokeStyle = g.fillStyle = this.color.hit;
    for (const spoke of cause.spokes) line(spoke, [3, 4], 1.2);
    if (cause.points.length > 1) line(cause.points, [], 2.5);
    g.setLineDash([]);
    for (const q of cause.points) {
      g.beginPath();
      g.arc(this.camera.screenX(q.x), this.camera.screenY(q.y), 3.5, 0, TURN);
      g.fill();
    }
  }
}
