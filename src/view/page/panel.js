// The list of layers and the switches for parts of the boundary.

const NUMBER = new Intl.NumberFormat('en');

function significant(value, digits = 6) {
  if (!Number.isFinite(value)) return value > 0 ? 'infinite' : String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e15 || size < 1e-4)) return value.toExponential(digits - 1);
  return new Intl.NumberFormat('en', {maximumSignificantDigits: digits}).format(value);
}

function lengthText(page, value, digits = 6) {
  if (page.unit === 'm' && Number.isFinite(value)) {
    if (Math.abs(value) >= 1000) return significant(value / 1000, digits) + '\u00a0km';
    if (value !== 0 && Math.abs(value) < 1) return significant(value * 1000, digits) + '\u00a0mm';
  }
  return significant(value, digits) + (page.unit && Number.isFinite(value) ? '\u00a0' + page.unit : '');
}

function areaText(page, value) {
  if (page.unit === 'm' && Math.abs(value) >= 1e6) return significant(value / 1e6) + '\u00a0km²';
  return significant(value) + (page.unit ? '\u00a0' + page.unit + '²' : '');
}

function many(count, one, more = one + 's') { return NUMBER.format(count) + '\u00a0' + (count === 1 ? one : more); }

function layerTitle(page, layer) {
  if (layer.role === 'input' || layer.radius === null) return layer.name;
  return (layer.role === 'zone' ? 'Zone' : 'Profile') + ', radius ' + lengthText(page, layer.radius);
}

function layerFacts(page, layer) {
  if (layer.role === 'input') {
    return [many(layer.chains, 'line'), many(layer.segments, 'segment'), 'length\u00a0' + lengthText(page, layer.perimeter)];
  }
  if (layer.role === 'profile') return [many(layer.segments, 'segment'), many(layer.arcs, 'arc')];
  return [many(layer.polygons, 'polygon'), many(layer.holes, 'hole'), many(layer.segments, 'segment'),
    many(layer.arcs, 'arc'), areaText(page, layer.area)];
}

class Panel {
  constructor(page, scene) {
    this.page = page;
    this.scene = scene;
    this.boxes = {};
    this.swatches = [];
    document.getElementById('about').textContent = page.crs || 'Plane coordinates, unit not told';
    const layers = document.getElementById('layers'), parts = document.getElementById('parts');
    for (const layer of [...page.layers].reverse()) {
      const swatch = layer.role === 'input' ? ['line', () => scene.color.input] : ['', () => scene.tint(layer)];
      this.row(layers, 'layer-' + layer.index, layerTitle(page, layer), layerFacts(page, layer).join(' · '), swatch,
        layer.shown, on => { layer.shown = on; });
    }
    const bodies = page.layers.filter(layer => layer.role !== 'input');
    const sum = name => bodies.reduce((total, layer) => total + layer[name], 0), color = name => () => scene.color[name];
    const part = (name, label, facts, swatch) =>
      this.row(parts, name, label, facts, swatch, scene.options[name], on => { scene.options[name] = on; });
    part('fill', 'Inside', '', ['', () => scene.tint(bodies[bodies.length - 1])]);
    part('segments', 'Segments', NUMBER.format(sum('segments')), ['line', color('segment')]);
    part('arcs', 'Arcs', NUMBER.format(sum('arcs')), ['line', color('arc')]);
    if (bodies.some(layer => layer.role === 'zone')) {
      part('holes', 'Holes, marked', NUMBER.format(sum('holes')), ['line', color('hole')]);
    }
    part('vertices', 'Vertices, where they can be told apart', '', ['dot', color('vertex')]);
    this.paint();
  }

  row(parent, name, label, facts, [shape, color], on, change) {
    const row = document.createElement('label'), box = document.createElement('input'), swatch = document.createElement('span');
    const text = document.createElement('span'), small = document.createElement('small');
    row.className = 'row';
    box.type = 'checkbox';
    box.id = name;
    box.checked = on;
    box.addEventListener('change', () => { change(box.checked); this.scene.request(); });
    swatch.className = 'swatch ' + shape;
    swatch.setAttribute('aria-hidden', 'true');
    text.textContent = label;
    small.textContent = facts;
    text.append(small);
    row.append(box, swatch, text);
    parent.append(row);
    this.boxes[name] = box;
    this.swatches.push(() => { swatch.style[shape === 'line' ? 'borderColor' : 'background'] = color(); });
  }

  // After a change of theme.
  paint() { for (const paint of this.swatches) paint(); }

  // Switches as a click would.
  set(name, on) {
    const box = this.boxes[name];
    if (!box || box.checked === on) return;
    box.checked = on;
    box.dispatchEvent(new Event('change'));
  }
}
