// Where the ball rests: the highest of all patches over a place. Which ones are asked is told by a grid over the boxes
// of faces, so the patch whose face has the place is always among them; every other one is a ball that touches the
// terrain, and cannot be higher.

import {makePatch, touch} from './patches.js';

const FACES_A_CELL = 3;

// Rows of a grid: the faces whose box meets a cell.
export class FaceGrid {
  constructor(leaf, tile) {
    this.leaf = leaf;
    this.low = tile.low;
    const faces = leaf.faceKind.length;
    this.cells = Math.max(1, Math.ceil(Math.sqrt(faces / FACES_A_CELL)));
    this.width = [0, 1].map(i => Math.max(tile.high[i] - tile.low[i], Number.MIN_VALUE) / this.cells);
    const margin = [0, 1].map(i => (tile.high[i] - tile.low[i]) / 65535 + 1e-9 * Math.abs(tile.high[i]));
    this.first = new Uint32Array(this.cells * this.cells + 1);
    const boxes = this.boxes(margin);
    this.each(boxes, cell => ++this.first[cell + 1]);
    for (let c = 0; c < this.cells * this.cells; ++c) this.first[c + 1] += this.first[c];
    this.face = new Uint32Array(this.first[this.cells * this.cells]);
    const fill = this.first.slice();
    this.each(boxes, (cell, f) => {
      this.face[fill[cell]++] = f;
    });
  }

  // Vertices are rounded: boxes grow by a margin.
  boxes(margin) {
    const {leaf} = this, boxes = new Float64Array(4 * leaf.faceKind.length);
    for (let f = 0; f < leaf.faceKind.length; ++f) {
      let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
      for (let c = 3 * leaf.faceFirst[f]; c < 3 * leaf.faceFirst[f + 1]; ++c) {
        const x = leaf.x[leaf.corner[c]], y = leaf.y[leaf.corner[c]];
        x0 = Math.min(x0, x);
        x1 = Math.max(x1, x);
        y0 = Math.min(y0, y);
        y1 = Math.max(y1, y);
      }
      boxes.set([x0 - margin[0], y0 - margin[1], x1 + margin[0], y1 + margin[1]], 4 * f);
    }
    return boxes;
  }

  column(x, i = 0) { return Math.min(this.cells - 1, Math.max(0, Math.floor((x - this.low[i]) / this.width[i]))); }

  each(boxes, put) {
    for (let f = 0; f < this.leaf.faceKind.length; ++f) {
      if (this.leaf.featureOf[f] < 0 || this.leaf.faceFirst[f] === this.leaf.faceFirst[f + 1]) continue;
      const right = this.column(boxes[4 * f + 2]), top = this.column(boxes[4 * f + 3], 1);
      for (let row = this.column(boxes[4 * f + 1], 1); row <= top; ++row)
        for (let column = this.column(boxes[4 * f]); column <= right; ++column) put(row * this.cells + column, f);
    }
  }

  facesAt(x, y) {
    const cell = this.column(y, 1) * this.cells + this.column(x);
    return this.face.subarray(this.first[cell], this.first[cell + 1]);
  }
}

export class Envelope {
  constructor(layer, radius) {
    this.layer = layer;
    this.radius = radius;
    this.grids = new WeakMap();  // by decoded leaf
    this.patches = new WeakMap();
    // Heights as near as this are one: the accuracy that krepl promises.
    this.same = 1e-9 * Math.max(radius, ...[0, 1, 2].map(i => layer.high3[i] - layer.low3[i]));
  }

  // { height, touches: [{ feature, kind, points, at, leaf, face }] }, the highest one
  // first; null where the ball touches nothing.
  contact(x, y) {
    let height = -Infinity;
    const found = [];
    for (const tile of this.layer.leaves(t => x >= t.low[0] && x <= t.high[0] && y >= t.low[1] && y <= t.high[1])) {
      const leaf = this.layer.decoded(tile), grid = this.gridOf(leaf, tile);
      for (const face of grid.facesAt(x, y)) {
        const patch = this.patchOf(leaf, face), hit = touch(patch, x, y);
        if (!hit || hit.height < height - this.same) continue;
        height = Math.max(height, hit.height);
        found.push({hit, patch, leaf, face, tile});
      }
    }
    if (found.length === 0) return null;
    const touches = [];
    found.sort((a, b) => b.hit.height - a.hit.height);
    for (const {hit, patch, leaf, face, tile} of found) {
      if (hit.height < height - this.same) break;
      const feature = leaf.feature[leaf.featureOf[face]];
      // A feature can have several faces.
      if (touches.some(t => t.feature === feature)) continue;
      touches.push({feature, kind: patch.points.length - 1, points: patch.points, at: hit.at, leaf, face, tile});
    }
    return {height, touches};
  }

  gridOf(leaf, tile) {
    let grid = this.grids.get(leaf);
    if (!grid) this.grids.set(leaf, grid = new FaceGrid(leaf, tile));
    return grid;
  }

  patchOf(leaf, face) {
    let patches = this.patches.get(leaf);
    if (!patches) this.patches.set(leaf, patches = []);
    return patches[face] ??= makePatch(pointsOf(leaf, face), this.radius);
  }
}

export function pointsOf(leaf, face) {
  const first = leaf.pointFirst[leaf.featureOf[face]], points = [];
  for (let i = 0; i <= leaf.faceKind[face]; ++i) {
    const p = leaf.featurePoint[first + i];
    points.push([leaf.point.x[p], leaf.point.y[p], leaf.point.z[p]]);
  }
  return points;
}
