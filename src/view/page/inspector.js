// What the pointer is on: the piece in words, and the part of the input that causes it.

// On which side of its direction does a chain have the inside? 1: left, -1: right. By its area, kept for the next time.
function insideOf(layer, chain) {
  if (layer.role === 'profile') return -1;
  layer.sides = layer.sides || new Int8Array(layer.chains);
  if (layer.sides[chain] === 0) {
    const xy = layer.xy, first = layer.vertexBegin[chain], last = layer.vertexBegin[chain + 1] - 1;
    let area = 0;
    for (let v = first; v < last; ++v) {
      area += (xy[2 * v] - xy[2 * first]) * (xy[2 * v + 3] - xy[2 * first + 1]) -
        (xy[2 * v + 2] - xy[2 * first]) * (xy[2 * v + 1] - xy[2 * first + 1]);
    }
    layer.sides[chain] = (area >= 0) === (layer.chainKind[chain] !== HOLE) ? 1 : -1;
  }
  return layer.sides[chain];
}

// The segment of the input that a source names, if the input is on the page and lies at the radius from the piece.
function inputSegment(page, hit, source) {
  const input = page.layers.find(layer => layer.role === 'input'), {layer, v} = hit;
  if (!input || !source || source.part < 0 || source.part >= input.chains) return null;
  const a = input.vertexBegin[source.part] + source.vertex;
  if (a + 1 >= input.vertexBegin[source.part + 1]) return null;
  const points = [a, a + 1].map(i => ({x: input.xy[2 * i], y: input.xy[2 * i + 1]}));
  const length = Math.hypot(points[1].x - points[0].x, points[1].y - points[0].y);
  const away = ((layer.xy[2 * v] - points[0].x) * (points[1].y - points[0].y) -
    (layer.xy[2 * v + 1] - points[0].y) * (points[1].x - points[0].x)) / length;
  return Math.abs(Math.abs(away) - layer.radius) < 1e-6 * layer.radius ? points : null;
}

// Places that cause a piece, and the radii from there to its ends: {points, spokes}; null where the file does not tell.
function causeOf(page, hit) {
  const {layer, p, v, chain} = hit;
  if (layer.role === 'input' || layer.kind[p] === HALF_LINE) return null;
  const ends = [v, v + 1].map(i => ({x: layer.xy[2 * i], y: layer.xy[2 * i + 1]}));
  if (isArc(layer, p)) {
    const arc = arcOf(layer, p, v), center = {x: arc.cx, y: arc.cy};
    return {points: [center], spokes: ends.map(end => [center, end])};
  }
  const source = sourceOf(layer, p);
  if (layer.radius === null || !source) return null;
  const dx = ends[1].x - ends[0].x, dy = ends[1].y - ends[0].y, length = Math.hypot(dx, dy);
  if (length === 0) return null;
  const k = insideOf(layer, chain) * layer.radius / length;
  const feet = ends.map(end => ({x: end.x - dy * k, y: end.y + dx * k}));
  return {points: inputSegment(page, hit, source) || feet, spokes: feet.map((foot, i) => [foot, ends[i]])};
}

// {feature, part, vertex}, -1 where unknown; null if nothing is known.
function sourceOf(layer, p) {
  if (layer.role === 'input' || layer.sourcePart.length === 0 || layer.sourcePart[p] === UNKNOWN) return null;
  if (layer.sourceVertex[p] === UNKNOWN) return null;
  const i = 2 * layer.sourcePart[p];
  return {feature: layer.parts[i], part: layer.parts[i + 1], vertex: layer.sourceVertex[p]};
}

function kindName(layer, p) {
  return ['segment', 'arc', 'arc', 'half-line'][layer.kind[p]];
}

// A hit as plain data, for the test hook and for the words below.
function describeHit(page, hit) {
  if (!hit) return null;
  const {layer, p, v, chain} = hit, arc = isArc(layer, p) ? arcOf(layer, p, v) : null, xy = layer.xy;
  let source = sourceOf(layer, p);
  if (layer.role === 'input') {
    source = {feature: layer.parts[2 * chain], part: layer.parts[2 * chain + 1], vertex: v - layer.vertexBegin[chain]};
  }
  return {
    layer: layer.index, role: layer.role, zoneRadius: layer.radius, piece: p, chain, kind: kindName(layer, p),
    hole: layer.chainKind[chain] === HOLE, source, radius: arc ? arc.r : null,
    angle: arc ? Math.abs(arc.sweep) : null, center: arc ? [arc.cx, arc.cy] : null, length: pieceLength(layer, p, v),
    from: [xy[2 * v], xy[2 * v + 1]], to: [xy[2 * v + 2], xy[2 * v + 3]],
  };
}

function sourceText(layer, found) {
  if (!found.source) return 'not told in this file';
  const {feature, part, vertex} = found.source, terrain = layer.role === 'profile' || part < 0;
  const what = found.kind === 'segment' ? `segment ${vertex}–${vertex + 1}` : `vertex ${vertex}`;
  return what + (terrain ? ' of the terrain' : ` of part ${part}`) + (feature >= 0 ? `, feature ${feature}` : '');
}

function hitRows(page, hit, place) {
  const found = describeHit(page, hit), layer = hit.layer, rows = [];
  if (layer.role === 'input') {
    rows.push(['is', sourceText(layer, found)]);
  } else {
    rows.push(['of', layerTitle(page, layer) + (found.hole ? ', a hole' : '')]);
    rows.push(['caused by', sourceText(layer, found)]);
  }
  if (found.radius !== null) rows.push(['radius', lengthText(page, found.radius, 9)]);
  rows.push(['length', lengthText(page, found.length, 9)]);
  if (found.angle !== null) {
    rows.push(['angle', significant(found.angle * 180 / Math.PI) + '°']);
    rows.push(['centre', place(...found.center)]);
  }
  if (found.kind !== 'half-line') rows.push(['from', place(...found.from)], ['to', place(...found.to)]);
  return rows;
}

class Inspector {
  constructor(page, scene) {
    this.page = page;
    this.scene = scene;
    this.element = document.getElementById('inspector');
    this.grids = page.layers.map(() => null);
  }

  grid(index) {
    if (!this.grids[index]) this.grids[index] = new HitGrid(this.page.layers[index]);
    return this.grids[index];
  }

  // The nearest piece of what is shown, within 9 pixels; of equally near ones that of the layer on top.
  find(sx, sy) {
    const camera = this.scene.camera, options = this.scene.options, x = camera.toX(sx), y = camera.toY(sy);
    let best = null;
    for (const layer of this.page.layers) {
      if (!layer.shown || layer.pieces === 0) continue;
      const hit = this.grid(layer.index).nearest(x, y, 9 / camera.scale);
      if (!hit || (best && hit.distance > best.distance)) continue;
      const hidden = layer.role !== 'input' &&
        (isArc(layer, hit.p) ? !options.arcs : layer.kind[hit.p] === SEGMENT && !options.segments);
      if (!hidden || (hit.layer.chainKind[hit.chain] === HOLE && options.holes)) best = hit;
    }
    return best;
  }

  show(hit, sx, sy, place) {
    const same = hit && this.scene.hit && hit.layer === this.scene.hit.layer && hit.p === this.scene.hit.p;
    if (!same && (hit || this.scene.hit)) {
      this.scene.hit = hit;
      this.scene.requestOverlay();
    }
    this.element.hidden = !hit;
    if (!hit) return;
    if (!same) this.fill(hit, place);
    this.dock(sx, sy);
  }

  // In the corner, where it hides nothing near the pointer; in the other one if the pointer is there.
  dock(sx, sy) {
    const camera = this.scene.camera, box = this.element.getBoundingClientRect(), room = 40;
    const low = sx > camera.width - box.width - 12 - room && sy > camera.height - box.height - 54 - room;
    this.element.classList.toggle('high', low);
  }

  fill(hit, place) {
    const kind = kindName(hit.layer, hit.p), head = this.element.querySelector('h2'), list = this.element.querySelector('dl');
    const mark = document.createElement('i'), colors = {segment: 'segment', arc: 'arc', 'half-line': 'half'};
    mark.style.background = this.scene.color[hit.layer.role === 'input' ? 'input' : colors[kind]];
    head.replaceChildren(mark, hit.layer.role === 'input' ? 'Input segment' : kind[0].toUpperCase() + kind.slice(1));
    list.replaceChildren();
    for (const [name, value] of hitRows(this.page, hit, place)) {
      const term = document.createElement('dt'), text = document.createElement('dd');
      term.textContent = name;
      text.textContent = value;
      list.append(term, text);
    }
  }

  // For those who do not see the picture.
  speak(hit, place) {
    const words = hit ? this.element.querySelector('h2').textContent + ': ' +
      hitRows(this.page, hit, place).map(row => row.join(' ')).join(', ') : 'Nothing here';
    document.getElementById('spoken').textContent = words;
  }
}
