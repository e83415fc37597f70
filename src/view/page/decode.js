// The data of the page: what C++ (src/view/page_data.hpp) calls a Layer, as typed arrays.

const SEGMENT = 0, ARC_LEFT = 1, ARC_RIGHT = 2, HALF_LINE = 3;
const OUTER = 0, HOLE = 1, OPEN = 2;
const UNKNOWN = 0xffffffff;

function decodeArray(id, Type) {
  const element = document.getElementById(id);
  const text = atob(element.textContent);
  element.remove();  // half the memory of a large page
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Type(bytes.buffer);
}

class Layer {
  constructor(json, index) {
    Object.assign(this, {index, role: json.role, name: json.name, radius: json.radius, polygons: json.polygons,
      area: json.area, perimeter: json.perimeter, shown: true});
    this.xy = decodeArray(json.vertices, Float64Array);
    this.vertexBegin = decodeArray(json.vertexBegin, Uint32Array);
    this.chainKind = decodeArray(json.chainKind, Uint8Array);
    this.kind = decodeArray(json.kind, Uint8Array);
    this.centers = decodeArray(json.centers, Float64Array);
    this.sourcePart = decodeArray(json.sourcePart, Uint32Array);
    this.sourceVertex = decodeArray(json.sourceVertex, Uint32Array);
    this.parts = decodeArray(json.parts, Float64Array);
    this.arcBefore = this.countArcs();
    this.count();
    this.bounds = this.findBounds();
  }

  get chains() { return this.chainKind.length; }
  get pieces() { return this.kind.length; }
  pieceBegin(chain) { return this.vertexBegin[chain] - chain; }

  // arcBefore[p]: number of arcs before piece p, which is the index of p's centre if p is an arc.
  countArcs() {
    const before = new Uint32Array(this.kind.length);
    for (let p = 0, arcs = 0; p < before.length; ++p) {
      before[p] = arcs;
      if (this.kind[p] === ARC_LEFT || this.kind[p] === ARC_RIGHT) ++arcs;
    }
    return before;
  }

  count() {
    this.arcs = this.centers.length / 2;
    this.segments = 0;
    this.halfLines = 0;
    for (const k of this.kind) {
      if (k === SEGMENT) ++this.segments;
      else if (k === HALF_LINE) ++this.halfLines;
    }
    this.holes = 0;
    for (const k of this.chainKind) if (k === HOLE) ++this.holes;
  }

  // The chain that piece p belongs to, by bisection.
  chainOf(p) {
    let low = 0, high = this.chains - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.pieceBegin(middle) <= p) low = middle; else high = middle - 1;
    }
    return low;
  }

  // Bounds of what matters: the far ends of half-lines are left out, arcs bulge over their ends by the radius at most.
  findBounds() {
    const box = [Infinity, Infinity, -Infinity, -Infinity], piece = newBox();
    for (let c = 0; c < this.chains; ++c) {
      const base = this.pieceBegin(c), first = this.vertexBegin[c], last = this.vertexBegin[c + 1] - 1;
      if (first === last) growBox(box, this.xy[2 * first], this.xy[2 * first + 1]);
      for (let v = first; v < last; ++v) {
        const p = base + v - first;
        if (this.kind[p] === HALF_LINE) continue;
        pieceBox(this, p, v, piece);
        uniteBox(box, piece);
      }
    }
    return box;
  }
}

function decodePage() {
  const page = JSON.parse(document.getElementById('page').textContent);
  page.layers = page.layers.map((json, index) => new Layer(json, index));
  return page;
}
