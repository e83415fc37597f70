// The material on vertical lines, and how a tool takes it off as time goes: what src/simulate does, in the page.

import {bytesOf, PlaneReader} from '../decode.js';

const BESIDE = -1e29;          // lower heights of the part: it has none there
const KEY_WORK = 3e6;          // dexels looked at between two states that are kept for going back
const MOST_KEYS = 40;
const LOOK_AT_CLOCK = 20000;   // dexels looked at between two looks at the clock
const GOLDEN = 0.6180339887498949;

// The lower side of the tool, by the distance from its axis: flat, corner, flank.
export class Tool {
  constructor({radius, flat, corner, cornerEnd, slope}) {
    Object.assign(this, {radius, flat, corner, cornerEnd, slope});
    this.ball = corner === radius && slope === null;
    this.endHeight = this.inCorner(cornerEnd);
  }

  inCorner(distance) {
    const out = distance - this.flat;
    if (out <= 0) return 0;
    return out * out / (this.corner + Math.sqrt(Math.max(0, (this.corner - out) * (this.corner + out))));
  }

  // Above its tip; the distance is at most the radius.
  height(distance) {
    if (distance <= this.cornerEnd || this.slope === null) return this.inCorner(distance);
    return this.endHeight + this.slope * (distance - this.cornerEnd);
  }

  // The lowest point of the tool over a place while its tip moves straight from a to b; Infinity if it does not come over it.
  // `enough`: what is not below that need not be told exactly.
  lowest(ax, ay, az, bx, by, bz, x, y, enough) {
    const dx = bx - ax, dy = by - ay, length = Math.hypot(dx, dy), ex = x - ax, ey = y - ay;
    if (length === 0) {
      const away = Math.hypot(ex, ey);
      return away > this.radius ? Infinity : Math.min(az, bz) + this.height(away);
    }
    // Along the way and across it.
    const u = (ex * dx + ey * dy) / length, w = Math.abs(ex * dy - ey * dx) / length;
    if (w > this.radius) return Infinity;
    const reach = Math.sqrt((this.radius - w) * (this.radius + w));
    const first = Math.max(0, u - reach), last = Math.min(length, u + reach);
    if (first > last || Math.min(az, bz) + this.height(w) >= enough) return Infinity;
    const rise = (bz - az) / length;
    if (this.ball) {
      const s = Math.min(last, Math.max(first, u - reach * rise / Math.hypot(1, rise))), v = u - s;
      return az + rise * s + this.radius - Math.sqrt(Math.max(0, (reach - v) * (reach + v)));
    }
    const at = s => az + rise * s + this.height(Math.min(this.radius, Math.hypot(w, u - s)));
    if (rise === 0) return at(Math.min(last, Math.max(first, u)));
    // The height is a convex function of the way.
    let low = first, high = last, a = high - GOLDEN * (high - low), b = low + GOLDEN * (high - low), atA = at(a), atB = at(b);
    for (let step = 0; step < 40; ++step) {
      if (atA > atB) {
        low = a, a = b, atA = atB, b = low + GOLDEN * (high - low), atB = at(b);
      } else {
        high = b, b = a, atB = atA, a = high - GOLDEN * (high - low), atA = at(a);
      }
    }
    return Math.min(atA, atB, at(first), at(last));
  }
}

export class Stock {
  constructor(description, text) {
    const {columns, rows} = description;
    Object.assign(this, {columns, rows, cell: description.cell, first: description.first, top: description.top});
    this.bottom = description.bottom;
    const count = columns * rows;
    const heights = id => new Float32Array(new PlaneReader(bytesOf(text(id))).words(count).buffer);
    this.part = heights(description.part);
    this.finished = heights(description.finished);
    this.before = description.before ? heights(description.before) : new Float32Array(count).fill(this.top);
    this.gouged = new PlaneReader(bytesOf(text(description.gouged))).bytes(count);
    this.heights = this.before.slice();
  }

  hasPart(dexel) { return this.part[dexel] > BESIDE; }

  // The dexel nearest to a place; -1 beside the block.
  dexelAt(x, y) {
    const column = Math.round((x - this.first[0]) / this.cell), row = Math.round((y - this.first[1]) / this.cell);
    return column < 0 || row < 0 || column >= this.columns || row >= this.rows ? -1 : row * this.columns + column;
  }

  // Takes off what the tool sweeps from a to b. Returns how many dexels were looked at.
  sweep(tool, ax, ay, az, bx, by, bz) {
    const {cell, columns, rows, heights, bottom} = this, r = tool.radius;
    const c0 = Math.max(0, Math.ceil((Math.min(ax, bx) - r - this.first[0]) / cell)),
          c1 = Math.min(columns - 1, Math.floor((Math.max(ax, bx) + r - this.first[0]) / cell));
    const r0 = Math.max(0, Math.ceil((Math.min(ay, by) - r - this.first[1]) / cell)),
          r1 = Math.min(rows - 1, Math.floor((Math.max(ay, by) + r - this.first[1]) / cell));
    if (c0 > c1 || r0 > r1) return 1;
    const lowest = Math.min(az, bz);
    for (let row = r0; row <= r1; ++row) {
      const y = this.first[1] + row * cell;
      for (let column = c0, d = row * columns + c0; column <= c1; ++column, ++d) {
        if (lowest >= heights[d]) continue;
        const z = tool.lowest(ax, ay, az, bx, by, bz, this.first[0] + column * cell, y, heights[d]);
        if (z < heights[d]) heights[d] = Math.max(z, bottom);
      }
    }
    return 1 + (c1 - c0 + 1) * (r1 - r0 + 1);
  }
}

// The stock at a time. Going forward cuts what lies between, going back starts from a state that was kept.
export class Cutting {
  constructor(stock, timeline, tool) {
    Object.assign(this, {stock, timeline, tool});
    this.keys = [{piece: 0, heights: stock.before.slice()}];
    this.interval = KEY_WORK;
    this.work = 0;  // since the last key
    this.piece = 0;  // all before it are cut
    this.time = 0;   // that the heights are of
    this.version = 0;  // of the heights
  }

  // Cuts up to a time, as far as that can be done in so many milliseconds. Returns whether it is done.
  advance(time, milliseconds = Infinity) {
    const {timeline, stock} = this;
    if (time === this.time) return true;
    ++this.version;
    if (time >= timeline.minutes) {
      stock.heights.set(stock.finished);
      [this.piece, this.time, this.work] = [timeline.pieces, timeline.minutes, 0];
      return true;
    }
    const {piece, x, y, z} = timeline.at(time), until = performance.now() + milliseconds;
    const key = this.keys.filter(k => k.piece <= piece).pop();
    if (time < this.time || key.piece > this.piece) {
      stock.heights.set(key.heights);
      [this.piece, this.time, this.work] = [key.piece, timeline.time[key.piece], 0];
    }
    for (let looked = 0; this.piece < piece;) {
      const p = this.piece++;
      looked += this.sweep(p, timeline.x[p + 1], timeline.y[p + 1], timeline.z[p + 1]);
      this.time = timeline.time[this.piece];
      this.keep();
      if (looked < LOOK_AT_CLOCK) continue;
      looked = 0;
      if (performance.now() > until) return false;
    }
    this.sweep(piece, x, y, z);
    this.time = time;
    return true;
  }

  // From the beginning of a piece to a place on it.
  sweep(piece, x, y, z) {
    const {timeline} = this;
    const looked = this.stock.sweep(this.tool, timeline.x[piece], timeline.y[piece], timeline.z[piece], x, y, z);
    this.work += looked;
    return looked;
  }

  keep() {
    if (this.work < this.interval || this.piece <= this.keys[this.keys.length - 1].piece) return;
    this.keys.push({piece: this.piece, heights: this.stock.heights.slice()});
    this.work = 0;
    if (this.keys.length <= MOST_KEYS) return;
    this.keys = this.keys.filter((_, i) => i % 2 === 0);
    this.interval *= 2;
  }
}
