// Which tiles are drawn: those at which a cell is about a pixel or two wide, within a budget of triangles.

// About what a tile has; two a cell, and as many in a leaf.
export const TRIANGLES_A_TILE = 2300;

// Distance from a point to a box, 0 inside.
export function distanceTo(tile, point) {
  let square = 0;
  for (let i = 0; i < 3; ++i) {
    const off = Math.max(tile.low[i] - point[i], 0, point[i] - tile.high[i]);
    square += off * off;
  }
  return Math.sqrt(square);
}

// A binary heap of { tile, size }, the largest size first.
class Queue {
  constructor() { this.items = []; }
  push(item) {
    const a = this.items;
    let i = a.push(item) - 1;
    for (let up = (i - 1) >> 1; i > 0 && a[up].size < item.size; up = (i - 1) >> 1) {
      a[i] = a[up];
      i = up;
    }
    a[i] = item;
  }
  pop() {
    const a = this.items, top = a[0], last = a.pop();
    if (a.length === 0) return top;
    let i = 0;
    for (let down = 1; down < a.length; down = 2 * i + 1) {
      if (down + 1 < a.length && a[down + 1].size > a[down].size) ++down;
      if (a[down].size <= last.size) break;
      a[i] = a[down];
      i = down;
    }
    a[i] = last;
    return top;
  }
}

// eye: the camera's place; pixels: of a unit of length at the distance 1; visible(tile); ready(tile) tells whether it
// can be drawn now, and asks for it if not; detail: pixels of a cell that are fine enough; budget: of triangles.
// Returns the tiles, and whether better ones are still on their way.
export function chooseTiles(layer, {eye, pixels, visible, ready, detail, budget}) {
  const chosen = [], queue = new Queue();
  let triangles = 0, waiting = false;
  const enter = tile => {
    if (!visible(tile)) return;
    triangles += TRIANGLES_A_TILE;
    queue.push({tile, size: tile.leaf ? 0 : pixels * tile.cell / Math.max(distanceTo(tile, eye), tile.cell)});
  };
  enter(layer.tiles[0]);
  while (queue.items.length > 0) {
    const {tile, size} = queue.pop();
    const enough = size <= detail || triangles > budget;
    if (tile.leaf || (enough && tile.sampled)) {
      if (ready(tile))
        chosen.push(tile);
      else
        waiting = true;
      continue;
    }
    const children = tile.children.map(i => layer.tiles[i]);
    // A tile is left for its children when all of them are there.
    const missing = tile.sampled ? children.filter(child => visible(child) && !drawable(child, ready)) : [];
    if (missing.length > 0) {
      waiting = true;
      if (ready(tile)) chosen.push(tile);
      continue;
    }
    triangles -= TRIANGLES_A_TILE;
    for (const child of children) enter(child);
  }
  return {chosen, waiting};
}

function drawable(tile, ready) { return !(tile.leaf || tile.sampled) || ready(tile); }
