// The section drawn flat, at true scale: heights and lengths alike. It can be moved and enlarged by itself.

import {strong} from './cut.js';
import {niceStep, text} from './numbers.js';

const MARGIN = {
  left: 58,
  right: 14,
  top: 12,
  bottom: 26
};

export class SectionPanel {
  constructor(canvas, cut, ball, page) {
    Object.assign(this, {canvas, cut, ball, page});
    this.context = canvas.getContext('2d');
    this.view = null;     // { s, z, scale }: the middle, pixels of a unit
    this.chosen = false;  // by hand: then it stays
    canvas.addEventListener('wheel', event => this.wheel(event), {passive: false});
    canvas.addEventListener('pointerdown', event => this.grab(event));
    canvas.addEventListener('dblclick', () => this.reset());
    canvas.addEventListener('keydown', event => this.key(event));
  }

  reset() {
    this.chosen = false;
    this.request();
  }

  request(moving = false) {
    this.quick = moving;
    if (this.wanted || this.canvas.parentElement.hidden) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw();
      if (!this.quick) return;
      clearTimeout(this.rest);
      this.rest = setTimeout(() => this.request(), 160);
    });
  }

  get ballPlace() {
    const {rest} = this.ball, {line} = this.cut;
    if (!rest) return null;
    const dx = rest.x - line.at[0], dy = rest.y - line.at[1];
    return {s: dx * line.along[0] + dy * line.along[1], off: dx * line.normal[0] + dy * line.normal[1], z: rest.height};
  }

  // A dozen radii about the ball, or the whole.
  choose(range) {
    const ball = this.ballPlace, width = this.width - MARGIN.left - MARGIN.right,
          height = this.height - MARGIN.top - MARGIN.bottom;
    if (ball && Math.abs(ball.off) < this.page.radius) {
      const scale = Math.min(width / 14, height / 4.4) / this.page.radius;
      this.view = {s: ball.s, z: ball.z - 0.4 * this.page.radius, scale};
    } else {
      const {low, high} = this.cut.scene;
      this.view = {
        s: (range[0] + range[1]) / 2,
        z: (low[2] + high[2]) / 2,
        scale: Math.min(width / (range[1] - range[0]), height / Math.max(high[2] - low[2], 1e-12) / 1.15)
      };
    }
  }

  toX(s) { return this.width / 2 + (MARGIN.left - MARGIN.right) / 2 + (s - this.view.s) * this.view.scale; }
  toY(z) { return this.height / 2 + (MARGIN.top - MARGIN.bottom) / 2 - (z - this.view.z) * this.view.scale; }
  toS(x) { return this.view.s + (x - this.width / 2 - (MARGIN.left - MARGIN.right) / 2) / this.view.scale; }
  toZ(y) { return this.view.z - (y - this.height / 2 - (MARGIN.top - MARGIN.bottom) / 2) / this.view.scale; }

  draw() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect(), g = this.context;
    this.width = box.width;
    this.height = box.height;
    if (this.width < 50 || !this.cut.on) return;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    const range = this.cut.range();
    if (!range) return;
    if (!this.chosen || !this.view) this.choose(range);
    const from = Math.max(range[0], this.toS(MARGIN.left)),
          to = Math.min(range[1], this.toS(this.width - MARGIN.right));
    const colors = this.cut.scene.colors, style = getComputedStyle(document.documentElement);
    this.ink = style.getPropertyValue('--ink').trim();
    this.faint = style.getPropertyValue('--faint').trim();
    this.axes(g);
    g.save();
    g.beginPath();
    g.rect(MARGIN.left, MARGIN.top, this.width - MARGIN.left - MARGIN.right, this.height - MARGIN.top - MARGIN.bottom);
    g.clip();
    if (from < to) {
      const count = this.quick ? 300 : Math.ceil(this.width - MARGIN.left),
            tolerance = this.quick ? 0.3 / this.view.scale : 1e-4 / this.view.scale;
      this.curves = this.cut.curves(from, to, count, tolerance);
      this.drawGround(g, colors);
      this.drawSurface(g, colors);
    }
    this.drawBall(g, colors);
    g.restore();
  }

  axes(g) {
    g.font = '11px system-ui, "DejaVu Sans", sans-serif';
    g.fillStyle = this.faint;
    g.strokeStyle = this.faint + '33';
    g.lineWidth = 1;
    const step = niceStep(70 / this.view.scale), steepStep = niceStep(34 / this.view.scale);
    g.textAlign = 'center';
    g.textBaseline = 'top';
    g.beginPath();
    const bottom = this.height - MARGIN.bottom, right = this.width - MARGIN.right;
    for (let k = Math.ceil(this.toS(MARGIN.left) / step); k * step <= this.toS(right); ++k) {
      const x = this.toX(k * step);
      g.moveTo(x, MARGIN.top);
      g.lineTo(x, bottom);
      g.fillText(text(k * step, step), x, bottom + 6);
    }
    g.textAlign = 'right';
    g.textBaseline = 'middle';
    const sea = this.page.origin[2];
    for (let k = Math.ceil((this.toZ(bottom) + sea) / steepStep); k * steepStep - sea <= this.toZ(MARGIN.top); ++k) {
      const y = this.toY(k * steepStep - sea);
      g.moveTo(MARGIN.left, y);
      g.lineTo(right, y);
      g.fillText(text(k * steepStep, steepStep), MARGIN.left - 6, y);
    }
    g.stroke();
    g.textAlign = 'left';
    g.textBaseline = 'top';
    const about =
        'Section at true scale: height over the distance along the cut' + (this.page.unit ? `, ${this.page.unit}` : '');
    g.fillText(about, MARGIN.left + 8, MARGIN.top + 2, Math.max(10, this.width - MARGIN.left - MARGIN.right - 16));
  }

  drawGround(g, colors) {
    if (this.curves.ground.length === 0) return;
    const bottom = this.height - MARGIN.bottom + 2;
    g.fillStyle = colors.ground + '66';
    // One path of all, so that nothing is painted twice where parts lie above each other.
    g.beginPath();
    for (const [s0, z0, s1, z1] of this.curves.ground) {
      g.moveTo(this.toX(s0), bottom);
      g.lineTo(this.toX(s0), this.toY(z0));
      g.lineTo(this.toX(s1) + 0.4, this.toY(z1));
      g.lineTo(this.toX(s1) + 0.4, bottom);
    }
    g.fill('nonzero');
    g.strokeStyle = this.ink;
    g.lineWidth = 1.6;
    g.beginPath();
    for (const [s0, z0, s1, z1] of this.curves.ground) {
      g.moveTo(this.toX(s0), this.toY(z0));
      g.lineTo(this.toX(s1), this.toY(z1));
    }
    g.stroke();
  }

  drawSurface(g, colors) {
    g.lineWidth = 2.4;
    g.lineJoin = 'round';
    const strongs = [colors.sphere, colors.cylinder, colors.plane].map(strong);
    let before = null;
    for (const {kind, points} of this.curves.surface) {
      g.strokeStyle = strongs[kind];
      g.beginPath();
      g.moveTo(this.toX(points[0]), this.toY(points[1]));
      for (let i = 2; i < points.length; i += 2) g.lineTo(this.toX(points[i]), this.toY(points[i + 1]));
      g.stroke();
      if (before) this.drawStep(g, before, points);
      before = points;
    }
  }

  // Below a rim the sum ends in a vertical wall.
  drawStep(g, before, points) {
    const s = before[before.length - 2], z = before[before.length - 1];
    if (Math.abs(this.toX(points[0]) - this.toX(s)) > 1 || Math.abs(points[1] - z) * this.view.scale < 1.5) return;
    g.strokeStyle = this.faint;
    g.setLineDash([3, 3]);
    g.beginPath();
    g.moveTo(this.toX(s), this.toY(z));
    g.lineTo(this.toX(points[0]), this.toY(points[1]));
    g.stroke();
    g.setLineDash([]);
  }

  drawBall(g, colors) {
    const ball = this.ballPlace, {radius} = this.page;
    if (!ball || Math.abs(ball.off) >= radius) return;
    const x = this.toX(ball.s), y = this.toY(ball.z), {line} = this.cut;
    g.strokeStyle = colors.contact;
    g.fillStyle = colors.contact + '18';
    g.lineWidth = 1.8;
    g.beginPath();
    g.arc(x, y, Math.sqrt(radius * radius - ball.off * ball.off) * this.view.scale, 0, 2 * Math.PI);
    g.fill();
    g.stroke();
    g.fillStyle = colors.contact;
    for (const {at} of [{at: null}, ...this.ball.rest.touches]) {
      const px = at ? this.toX((at[0] - line.at[0]) * line.along[0] + (at[1] - line.at[1]) * line.along[1]) : x;
      const py = at ? this.toY(at[2]) : y;
      g.beginPath();
      g.arc(px, py, at ? 4 : 2.5, 0, 2 * Math.PI);
      g.fill();
      if (!at) continue;
      g.beginPath();
      g.setLineDash([3, 3]);
      g.moveTo(x, y);
      g.lineTo(px, py);
      g.stroke();
      g.setLineDash([]);
    }
  }

  wheel(event) {
    event.preventDefault();
    if (!this.view) return;
    const box = this.canvas.getBoundingClientRect();
    this.zoom(
        Math.exp(-Math.max(-200, Math.min(200, event.deltaY)) * 0.002), event.clientX - box.left,
        event.clientY - box.top);
  }

  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const s = this.toS(x), z = this.toZ(y);
    this.chosen = true;
    this.view.scale *= factor;
    this.view.s += s - this.toS(x);
    this.view.z += z - this.toZ(y);
    this.request(true);
  }

  move(dx, dy) {
    this.chosen = true;
    this.view.s -= dx / this.view.scale;
    this.view.z += dy / this.view.scale;
    this.request(true);
  }

  // One finger or the mouse moves, two fingers enlarge.
  grab(event) {
    if (!this.view) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.fingers ??= new Map();
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.onpointermove = moved => {
      const before = this.fingers.get(moved.pointerId);
      if (!before) return;
      const spread = () => {
        const [a, b] = [...this.fingers.values()];
        return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
      };
      const was = spread();
      this.fingers.set(moved.pointerId, [moved.clientX, moved.clientY]);
      if (this.fingers.size > 1)
        this.zoom(spread() / Math.max(1, was));
      else
        this.move(moved.clientX - before[0], moved.clientY - before[1]);
    };
    this.canvas.onpointerup = this.canvas.onpointercancel = left => this.fingers.delete(left.pointerId);
  }

  key(event) {
    const moves = {ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40]};
    if (moves[event.key])
      this.move(...moves[event.key]);
    else if (event.key === '+' || event.key === '=')
      this.zoom(1.25);
    else if (event.key === '-')
      this.zoom(0.8);
    else if (event.key === '0')
      this.reset();
    else
      return;
    event.preventDefault();
    event.stopPropagation();
  }
}
