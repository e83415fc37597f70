// Chains cut into runs of 8 pieces, runs of 8 runs and so on, each with its box. Drawing replaces a run by its chord where
// it lies outside the window or is smaller than a pixel: the path stays inside the run's box, so nothing visible
// changes, and the cost is that of what can be seen.

const FAN = 8;

class Chunks {
  constructor(layer) {
    this.layer = layer;
    this.base = new Uint32Array(layer.chains + 1);  // first node of a chain; its levels follow each other, runs of 8 first
    for (let c = 0; c < layer.chains; ++c) {
      let nodes = 0, size = this.pieces(c);
      do { size = Math.ceil(size / FAN); nodes += size; } while (size > 1);
      this.base[c + 1] = this.base[c] + nodes;
    }
    this.boxes = new Float64Array(4 * this.base[layer.chains]);
    for (let c = 0; c < layer.chains; ++c) this.fill(c);
  }

  pieces(c) { return this.layer.vertexBegin[c + 1] - this.layer.vertexBegin[c] - 1; }
  top(c) { return this.base[c + 1] - 1; }

  fill(c) {
    const layer = this.layer, boxes = this.boxes, piece = newBox();
    const firstPiece = layer.pieceBegin(c), firstVertex = layer.vertexBegin[c];
    const put = (node, box, fresh) => {
      const i = 4 * node;
      if (fresh) { boxes[i] = box[0]; boxes[i + 1] = box[1]; boxes[i + 2] = box[2]; boxes[i + 3] = box[3]; return; }
      if (box[0] < boxes[i]) boxes[i] = box[0];
      if (box[1] < boxes[i + 1]) boxes[i + 1] = box[1];
      if (box[2] > boxes[i + 2]) boxes[i + 2] = box[2];
      if (box[3] > boxes[i + 3]) boxes[i + 3] = box[3];
    };
    const count = this.pieces(c);
    for (let k = 0; k < count; ++k) {
      pieceBox(layer, firstPiece + k, firstVertex + k, piece);
      put(this.base[c] + Math.floor(k / FAN), piece, k % FAN === 0);
    }
    let level = this.base[c], size = Math.ceil(count / FAN);
    while (size > 1) {
      const above = level + size;
      for (let k = 0; k < size; ++k) {
        put(above + Math.floor(k / FAN), boxes.subarray(4 * (level + k), 4 * (level + k) + 4), k % FAN === 0);
      }
      level = above;
      size = Math.ceil(size / FAN);
    }
  }

  // Walks chain c. `sink` has hidden(v), coarse(v): go straight to vertex v; and piece(p, v): draw it whole.
  walk(c, view, sink) {
    const sizes = [], levels = [];
    let level = this.base[c], size = Math.ceil(this.pieces(c) / FAN);
    if (size === 0) return;
    for (;;) {
      sizes.push(size);
      levels.push(level);
      if (size <= 1) break;
      level += size;
      size = Math.ceil(size / FAN);
    }
    const firstVertex = this.layer.vertexBegin[c], firstPiece = this.layer.pieceBegin(c), count = this.pieces(c);
    const boxes = this.boxes;
    const visit = (depth, k) => {
      const i = 4 * (levels[depth] + k), span = FAN ** (depth + 1);
      const end = Math.min(count, (k + 1) * span);
      if (boxes[i] > view.right || boxes[i + 2] < view.left || boxes[i + 1] > view.top || boxes[i + 3] < view.bottom) {
        sink.hidden(firstVertex + end);
      } else if (boxes[i + 2] - boxes[i] < view.detail && boxes[i + 3] - boxes[i + 1] < view.detail) {
        sink.coarse(firstVertex + end);
      } else if (depth === 0) {
        this.walkRun(firstPiece, firstVertex, k * FAN, end, view.detail, sink);
      } else {
        const stop = Math.min(sizes[depth - 1], (k + 1) * FAN);
        for (let j = k * FAN; j < stop; ++j) visit(depth - 1, j);
      }
    };
    visit(levels.length - 1, 0);
  }

  // Pieces of a run; small neighbours are drawn as one chord.
  walkRun(firstPiece, firstVertex, begin, end, detail, sink) {
    const layer = this.layer, xy = layer.xy, box = newBox();
    let drawn = firstVertex + begin;
    for (let j = begin; j < end; ++j) {
      const p = firstPiece + j, v = firstVertex + j, next = v + 1;
      pieceBox(layer, p, v, box);
      if (box[2] - box[0] >= detail || box[3] - box[1] >= detail) {
        if (drawn !== v) sink.coarse(v);
        sink.piece(p, v);
        drawn = next;
      } else if (j + 1 === end || Math.abs(xy[2 * next] - xy[2 * drawn]) >= detail ||
                 Math.abs(xy[2 * next + 1] - xy[2 * drawn + 1]) >= detail) {
        sink.coarse(next);
        drawn = next;
      }
    }
  }

  // Is any of chain c in the window?
  visible(c, view) {
    if (this.base[c] === this.base[c + 1]) return false;
    const i = 4 * this.top(c), b = this.boxes;
    return !(b[i] > view.right || b[i + 2] < view.left || b[i + 1] > view.top || b[i + 3] < view.bottom);
  }
}
