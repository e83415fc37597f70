// Which piece is near a place: a grid with about one cell for every two pieces.

class HitGrid {
  constructor(layer) {
    this.layer = layer;
    const [left, bottom, right, top] = layer.bounds;
    const width = Math.max(right - left, 1e-300), height = Math.max(top - bottom, 1e-300);
    const cells = Math.min(4e6, Math.max(1, layer.pieces / 2));
    this.cell = Math.max(Math.sqrt(width * height / cells), Math.max(width, height) / 4096);
    this.left = left;
    this.bottom = bottom;
    this.columns = Math.floor(width / this.cell) + 1;
    this.rows = Math.floor(height / this.cell) + 1;
    this.large = [];  // pieces that cover many cells, looked at every time
    this.fill();
  }

  column(x) { return Math.min(this.columns - 1, Math.max(0, Math.floor((x - this.left) / this.cell))); }
  row(y) { return Math.min(this.rows - 1, Math.max(0, Math.floor((y - this.bottom) / this.cell))); }

  // Calls use(p, v, column0, row0, column1, row1) for each piece.
  each(use) {
    const layer = this.layer, box = newBox();
    for (let c = 0; c < layer.chains; ++c) {
      const first = layer.vertexBegin[c], base = layer.pieceBegin(c), count = layer.vertexBegin[c + 1] - first - 1;
      for (let k = 0; k < count; ++k) {
        pieceBox(layer, base + k, first + k, box);
        use(base + k, first + k, this.column(box[0]), this.row(box[1]), this.column(box[2]), this.row(box[3]));
      }
    }
  }

  fill() {
    const most = 64, begin = new Uint32Array(this.columns * this.rows + 1);
    this.each((p, v, i0, j0, i1, j1) => {
      if ((i1 - i0 + 1) * (j1 - j0 + 1) > most) { this.large.push(v); return; }
      for (let j = j0; j <= j1; ++j) for (let i = i0; i <= i1; ++i) ++begin[j * this.columns + i + 1];
    });
    for (let i = 1; i < begin.length; ++i) begin[i] += begin[i - 1];
    const place = begin.slice(), entries = new Uint32Array(begin[begin.length - 1]);
    this.each((p, v, i0, j0, i1, j1) => {
      if ((i1 - i0 + 1) * (j1 - j0 + 1) > most) return;
      for (let j = j0; j <= j1; ++j) for (let i = i0; i <= i1; ++i) entries[place[j * this.columns + i]++] = v;
    });
    this.begin = begin;
    this.entries = entries;
  }

  // The chain of a vertex that starts a piece, by bisection.
  chainOfVertex(v) {
    const begin = this.layer.vertexBegin;
    let low = 0, high = this.layer.chains - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (begin[middle] <= v) low = middle; else high = middle - 1;
    }
    return low;
  }

  // The piece nearest to (x, y) within `reach`: {layer, p, v, chain, distance, x, y} with the nearest point, or null.
  nearest(x, y, reach) {
    let best = null, limit = reach;
    const look = v => {
      const chain = this.chainOfVertex(v), p = v - chain, q = nearestOnPiece(this.layer, p, v, x, y);
      const distance = Math.hypot(q.x - x, q.y - y);
      if (distance > limit || (distance === limit && best !== null)) return;
      limit = distance;
      best = {layer: this.layer, p, v, chain, distance, x: q.x, y: q.y};
    };
    this.large.forEach(look);
    const i0 = this.column(x - reach), i1 = this.column(x + reach), j0 = this.row(y - reach), j1 = this.row(y + reach);
    for (let j = j0; j <= j1; ++j) {
      for (let i = i0; i <= i1; ++i) {
        const cell = j * this.columns + i;
        for (let e = this.begin[cell]; e < this.begin[cell + 1]; ++e) look(this.entries[e]);
      }
    }
    return best;
  }
}
