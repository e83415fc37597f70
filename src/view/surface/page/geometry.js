// Decoded tiles as arrays for the graphics card. Positions are relative to the tile's middle.

import {ROW} from './decode.js';
import {pointsOf} from './envelope.js';
import {CYLINDER, GROUND, SPHERE, WALL} from './kinds.js';
import {makePatch, normalAt} from './patches.js';

export function middleOf(tile) { return [0, 1, 2].map(i => (tile.low[i] + tile.high[i]) / 2); }

// Kinds as shares of 255: cylinder, sphere, wall; planes have none.
function mixOf(kind) { return [kind === CYLINDER ? 255 : 0, kind === SPHERE ? 255 : 0, kind === WALL ? 255 : 0]; }

class VertexArrays {
  constructor(most) {
    this.position = new Float32Array(3 * most);
    this.normal = new Int8Array(4 * most);
    this.mix = new Uint8Array(4 * most);
    this.count = 0;
  }
  add(x, y, z, normal, mix) {
    const i = this.count++;
    this.position[3 * i] = x;
    this.position[3 * i + 1] = y;
    this.position[3 * i + 2] = z;
    for (let k = 0; k < 3; ++k) {
      this.normal[4 * i + k] = Math.round(127 * normal[k]);
      this.mix[4 * i + k] = mix[k];
    }
    return i;
  }
  finished(index) {
    const n = this.count;
    return {
      position: this.position.slice(0, 3 * n),
      normal: this.normal.slice(0, 4 * n),
      mix: this.mix.slice(0, 4 * n),
      index: n > 65535 ? index : Uint16Array.from(index)
    };
  }
}

// Each face has its own vertices with the normals of its patch, so that valleys look sharp and seams smooth.
export function leafGeometry(leaf, tile, radius) {
  const middle = middleOf(tile), arrays = new VertexArrays(leaf.corner.length), normal = [0, 0, 1];
  const seenIn = new Int32Array(leaf.x.length).fill(-1), number = new Uint32Array(leaf.x.length);
  const index = new Uint32Array(leaf.corner.length);
  for (let f = 0; f < leaf.faceKind.length; ++f) {
    const kind = leaf.faceKind[f], mix = mixOf(kind);
    const patch = leaf.featureOf[f] < 0 ? null : makePatch(pointsOf(leaf, f), radius);
    const flat = kind === WALL ? wallNormals(leaf, f) : null;
    for (let c = 3 * leaf.faceFirst[f]; c < 3 * leaf.faceFirst[f + 1]; ++c) {
      const v = leaf.corner[c];
      // The ground is lit by the slope of what is drawn, and shares vertices between its faces.
      const owner = kind === GROUND ? 0 : f;
      if (flat || seenIn[v] !== owner) {
        if (patch) normalAt(patch, leaf.x[v], leaf.y[v], leaf.z[v], normal);
        number[v] = arrays.add(
            leaf.x[v] - middle[0], leaf.y[v] - middle[1], leaf.z[v] - middle[2],
            flat ? flat[Math.floor(c / 3 - leaf.faceFirst[f])] : normal, mix);
        seenIn[v] = owner;
      }
      index[c] = number[v];
    }
  }
  return arrays.finished(index);
}

function wallNormals(leaf, f) {
  const normals = [];
  for (let t = leaf.faceFirst[f]; t < leaf.faceFirst[f + 1]; ++t) {
    const [a, b, c] = leaf.corner.subarray(3 * t, 3 * t + 3);
    const u = ['x', 'y', 'z'].map(i => leaf[i][b] - leaf[i][a]), v = ['x', 'y', 'z'].map(i => leaf[i][c] - leaf[i][a]);
    const x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], length = Math.hypot(x, y) || 1;
    normals.push([x / length, y / length, 0]);
  }
  return normals;
}

// Pairs of points by kind of line, relative to the tile's middle.
export function leafLines(leaf, tile) {
  const middle = middleOf(tile), lines = [[], [], []];
  for (let l = 0; l < leaf.lineKind.length; ++l) {
    const points = lines[leaf.lineKind[l]];
    for (let i = leaf.lineFirst[l]; i + 1 < leaf.lineFirst[l + 1]; ++i)
      for (const v of [leaf.lineVertex[i], leaf.lineVertex[i + 1]])
        points.push(leaf.x[v] - middle[0], leaf.y[v] - middle[1], leaf.z[v] - middle[2]);
  }
  return lines.map(points => Float32Array.from(points));
}

// Samples on a grid. The outermost ones lie beyond the tile and a bit lower, so
// that no gap shows beside finer neighbours.
const SUNK = 0.3;  // of a cell

export function sampleGeometry(samples, tile) {
  const arrays = new VertexArrays(ROW * ROW), middle = middleOf(tile), cell = tile.cell, {z} = samples;
  const number = new Int32Array(ROW * ROW).fill(-1), normal = [0, 0, 1];
  const left = tile.origin[0] - middle[0] - cell, bottom = tile.origin[1] - middle[1] - cell;
  for (let row = 0, i = 0; row < ROW; ++row) {
    for (let column = 0; column < ROW; ++column, ++i) {
      if (Number.isNaN(z[i])) continue;
      slopeAt(z, row, column, cell, normal);
      const sunk = row === 0 || column === 0 || row === ROW - 1 || column === ROW - 1 ? SUNK * cell : 0;
      number[i] = arrays.add(
          left + column * cell, bottom + row * cell, z[i] - middle[2] - sunk, normal,
          [samples.cylinder[i], samples.sphere[i], 0]);
    }
  }
  return arrays.finished(gridTriangles(number));
}

function slopeAt(z, row, column, cell, normal) {
  const i = row * ROW + column, here = z[i];
  const or = (a, b) => Number.isNaN(a) ? b : a;
  const west = column > 0 ? or(z[i - 1], here) : here, east = column < ROW - 1 ? or(z[i + 1], here) : here;
  const south = row > 0 ? or(z[i - ROW], here) : here, north = row < ROW - 1 ? or(z[i + ROW], here) : here;
  const dx = (east - west) / ((column > 0) + (column < ROW - 1)) / cell;
  const dy = (north - south) / ((row > 0) + (row < ROW - 1)) / cell, length = Math.hypot(dx, dy, 1);
  normal[0] = -dx / length;
  normal[1] = -dy / length;
  normal[2] = 1 / length;
}

// Two triangles a cell, one where a sample is missing.
export function gridTriangles(number) {
  const index = [];
  for (let row = 0; row + 1 < ROW; ++row) {
    for (let column = 0; column + 1 < ROW; ++column) {
      const i = row * ROW + column, corners = [i, i + 1, i + ROW + 1, i + ROW].map(k => number[k]).filter(k => k >= 0);
      if (corners.length >= 3) index.push(corners[0], corners[1], corners[2]);
      if (corners.length === 4) index.push(corners[0], corners[2], corners[3]);
    }
  }
  return Uint32Array.from(index);
}
