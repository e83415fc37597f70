// The way of the tool's tip as lines: what is behind strong, what lies ahead faint, rapid moves dashed.

import * as THREE from 'three';

import {lineGeometry, lineMaterial} from '../lines.js';
import {DEPTHS, depthColor, PATH_COLORS} from './colors.js';
import {LINE, RAPID} from './timeline.js';

const WIDTH = 1.1, STRONG = 0.8, FAINT = 0.25;  // pixels, opacities
const DASHES = 150;         // a dash and a gap along the extent
const MOST_DASHES = 200000;

// Lines of pieces in their order; those before a piece are drawn by one mesh, the others by another.
class Run {
  // points: both ends of each line; pieces: the piece that each is of, ascending.
  constructor(points, pieces) {
    this.pieces = pieces;
    const geometry = lineGeometry(points);
    this.done = new THREE.Mesh(geometry, lineMaterial(WIDTH, [], {opacity: STRONG, depthWrite: false}));
    this.ahead = new THREE.Mesh(this.shared(geometry), lineMaterial(WIDTH, [], {opacity: FAINT, depthWrite: false}));
    for (const [order, mesh] of [[3, this.done], [4, this.ahead]]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = order;
    }
    this.split(0);
  }

  shared(geometry) {
    const same = new THREE.BufferGeometry();
    for (const name of ['position', 'other', 'side']) same.setAttribute(name, geometry.getAttribute(name));
    same.setIndex(geometry.getIndex());
    return same;
  }

  // Pieces before this one are done.
  split(piece) {
    let low = 0, high = this.pieces.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.pieces[middle] < piece) low = middle + 1;
      else high = middle;
    }
    this.done.geometry.setDrawRange(0, 6 * low);
    this.ahead.geometry.setDrawRange(6 * low, 6 * (this.pieces.length - low));
    return low;
  }

  color(color) {
    this.done.material.color.set(color);
    this.ahead.material.color.set(color);
  }
}

export class Way {
  constructor(scene, timeline, extent) {
    Object.assign(this, {scene, timeline});
    this.shown = {done: true, ahead: true, rapid: true};
    this.byDepth = true;
    this.group = new THREE.Group();
    this.measure();
    this.runs = [...this.cuts(), this.rapids(extent)].filter(run => run.pieces.length > 0);
    for (const run of this.runs) this.group.add(run.done, run.ahead);
    this.now = new THREE.Mesh(new THREE.BufferGeometry(), lineMaterial(2 * WIDTH, []));  // the piece that the tool is in
    this.now.frustumCulled = false;
    this.group.add(this.now);
    scene.scene.add(this.group);
  }

  // Heights between which cuts are coloured.
  measure() {
    const {timeline} = this;
    [this.lowest, this.highest] = [Infinity, -Infinity];
    for (let p = 0; p < timeline.pieces; ++p) {
      if (timeline.kindOf(p) === RAPID) continue;
      this.lowest = Math.min(this.lowest, timeline.z[p + 1]);
      this.highest = Math.max(this.highest, timeline.z[p + 1]);
    }
  }

  binOf(height) {
    const share = (height - this.lowest) / (this.highest - this.lowest || 1);
    return Math.min(DEPTHS - 1, Math.max(0, Math.floor(share * DEPTHS)));
  }

  ends(p) {
    const {x, y, z} = this.timeline;
    return [x[p], y[p], z[p], x[p + 1], y[p + 1], z[p + 1]];
  }

  // A run for each colour of depth, of lines and of arcs.
  cuts() {
    const {timeline} = this, bins = Array.from({length: 2 * DEPTHS}, () => ({points: [], pieces: []}));
    for (let p = 0; p < timeline.pieces; ++p) {
      const kind = timeline.kindOf(p);
      if (kind === RAPID) continue;
      const bin = this.binOf((timeline.z[p] + timeline.z[p + 1]) / 2);
      const {points, pieces} = bins[kind === LINE ? bin : DEPTHS + bin];
      points.push(...this.ends(p));
      pieces.push(p);
    }
    return bins.map(({points, pieces}, i) => Object.assign(new Run(points, pieces), {bin: i % DEPTHS, arc: i >= DEPTHS}));
  }

  rapids(extent) {
    const {timeline} = this, points = [], pieces = [];
    const of = p => {
      const [ax, ay, az, bx, by, bz] = this.ends(p);
      return Math.hypot(bx - ax, by - ay, bz - az);
    };
    let length = 0;
    for (let p = 0; p < timeline.pieces; ++p)
      if (timeline.kindOf(p) === RAPID) length += of(p);
    const period = Math.max(extent / DASHES, length / MOST_DASHES);
    for (let p = 0; p < timeline.pieces; ++p) {
      if (timeline.kindOf(p) !== RAPID) continue;
      const [ax, ay, az, bx, by, bz] = this.ends(p), dashes = Math.max(1, Math.round(of(p) / period));
      const at = t => [ax + t * (bx - ax), ay + t * (by - ay), az + t * (bz - az)];
      for (let k = 0; k < dashes; ++k) {
        points.push(...at(k / dashes), ...at((k + 0.55) / dashes));
        pieces.push(p);
      }
    }
    return Object.assign(new Run(points, pieces), {rapid: true});
  }

  // The tool is in a piece, at a place.
  show({piece, x, y, z}) {
    for (const run of this.runs) {
      run.split(piece);
      const shown = !run.rapid || this.shown.rapid;
      run.done.visible = this.shown.done && shown;
      run.ahead.visible = this.shown.ahead && shown;
    }
    const {timeline} = this, rapid = timeline.kindOf(piece) === RAPID;
    this.now.visible = this.shown.done && !rapid;
    if (!this.now.visible) return;
    this.now.geometry.dispose();
    this.now.geometry = lineGeometry([timeline.x[piece], timeline.y[piece], timeline.z[piece], x, y, z]);
    this.now.material.color.set(this.colorOf(this.binOf((timeline.z[piece] + z) / 2), timeline.kindOf(piece) !== LINE));
  }

  colorOf(bin, arc) {
    const colors = PATH_COLORS[this.theme];
    return this.byDepth ? depthColor(bin, this.theme === 'dark') : arc ? colors.arc : colors.line;
  }

  setTheme(name) {
    this.theme = name;
    for (const run of this.runs) run.color(run.rapid ? PATH_COLORS[name].rapid : this.colorOf(run.bin, run.arc));
  }
}
