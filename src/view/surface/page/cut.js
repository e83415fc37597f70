// The cut: a vertical plane that can be moved and turned, and the curves in it.

import * as THREE from 'three';

import {lineMaterial, Lines} from './lines.js';
import {lineOf, rangeOver, surfaceSection} from './section.js';
import {groundSection} from './section_ground.js';

const SAMPLES = 1500;
const NEARBY = 40;  // radii on each side of the middle that the curves in space are made for, at least

export class Cut {
  constructor(scene, envelope, ground, page) {
    Object.assign(this, {scene, envelope, ground, page});
    this.on = false;
    this.follow = true;  // goes through the ball
    this.cutGround = false;
    this.angle = 0;  // degrees from east, of the line
    this.at = [0, 1].map(i => (scene.low[i] + scene.high[i]) / 2);
    this.listeners = [];  // called when the line has changed
    this.group = new THREE.Group();
    this.kindLines = ['sphere', 'cylinder', 'plane'].map(() => this.lines(3.4));
    this.groundLines = this.lines(2.6);
    scene.scene.add(this.group);
  }

  lines(width) {
    const lines = new Lines(lineMaterial(width, [], {polygonOffsetFactor: -2, polygonOffsetUnits: -16}), 6);
    this.group.add(lines);
    return lines;
  }

  setTheme(colors) {
    this.kindLines.forEach(
        (lines, kind) => lines.material.color.set(strong([colors.sphere, colors.cylinder, colors.plane][kind])));
    this.groundLines.material.color.set('#2c3a22');
  }

  get line() { return lineOf(this.at, this.angle * Math.PI / 180); }

  // How far the line is from the middle of the whole, to its left.
  get offset() {
    const {normal} = this.line, middle = [0, 1].map(i => (this.scene.low[i] + this.scene.high[i]) / 2);
    return normal[0] * (this.at[0] - middle[0]) + normal[1] * (this.at[1] - middle[1]);
  }
  set offset(value) {
    const {normal} = this.line, step = value - this.offset;
    this.at = [0, 1].map(i => this.at[i] + step * normal[i]);
  }

  // The part of the line over the whole; null if it lies beside it.
  range() { return rangeOver(this.line, this.scene.low, this.scene.high); }

  change(values) {
    Object.assign(this, values);
    this.scene.setCut(this.on ? {line: this.line, ground: this.cutGround} : null);
    this.group.visible = this.on;
    this.dirty = true;
    for (const listener of this.listeners) listener();
    this.scene.request();
  }

  // Curves of the section between two places of the line.
  curves(from, to, count, tolerance) {
    return {
      surface: surfaceSection(this.envelope, this.line, from, to, count, tolerance),
      ground: this.ground ? groundSection(this.ground, this.line, from, to) : []
    };
  }

  // The curves in space, as fine as can be told from the eye.
  update(moving) {
    const range = this.on && this.range();
    this.group.visible = Boolean(range);
    if (!range) return;
    const {line} = this, eye = this.scene.camera.position, target = this.scene.controls.target;
    const middle = (target.x - line.at[0]) * line.along[0] + (target.y - line.at[1]) * line.along[1];
    const reach = Math.max(1.5 * eye.distanceTo(target), NEARBY * this.page.radius);
    const from = Math.max(range[0], middle - reach), to = Math.min(range[1], middle + reach), key = [from, to].join();
    // Small moves of the eye do not need new curves.
    const near =
        this.made && Math.abs(this.made.reach / reach - 1) < 0.3 && Math.abs(this.made.middle - middle) < 0.2 * reach;
    if (!this.dirty && (this.made?.key === key || near)) return;
    if (moving && !this.dirty) return;
    this.dirty = false;
    this.made = {key, reach, middle};
    if (from >= to) return;
    const curves = this.curves(from, to, SAMPLES, (to - from) / SAMPLES / 8);
    const origin = [...line.place((from + to) / 2), target.z], place = (s, z) => {
      const [x, y] = line.place(s);
      return [x - origin[0], y - origin[1], z - origin[2]];
    };
    this.group.position.set(...origin);
    const kinds = [[], [], []];
    for (const {kind, points} of curves.surface)
      for (let i = 0; i + 3 < points.length; i += 2)
        kinds[kind].push(...place(points[i], points[i + 1]), ...place(points[i + 2], points[i + 3]));
    kinds.forEach((points, kind) => this.kindLines[kind].replace(points));
    this.groundLines.replace(curves.ground.flatMap(([s0, z0, s1, z1]) => [...place(s0, z0), ...place(s1, z1)]));
  }
}

// A kind's colour, dark enough for a line.
export function strong(text) {
  const color = new THREE.Color(text), hsl = color.getHSL({});
  return '#' + color.setHSL(hsl.h, Math.min(1, hsl.s * 1.5 + 0.1), hsl.l * 0.62).getHexString();
}
