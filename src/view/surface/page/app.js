// All parts of the page and what they do to each other.

import * as THREE from 'three';

import {Ball} from './ball.js';
import {Cut} from './cut.js';
import {Envelope} from './envelope.js';
import {Input} from './input.js';
import {Inspector} from './inspector.js';
import {LINE_NAMES} from './kinds.js';
import {Layer} from './layer.js';
import {exact, niceStep, text} from './numbers.js';
import {parseFragment} from './page_state.js';
import {Panel} from './panel.js';
import {Scene} from './scene.js';
import {SectionPanel} from './section_panel.js';

const byId = id => document.getElementById(id);

export class App {
  constructor() {
    this.page = JSON.parse(byId('page').textContent);
    this.layers = this.page.layers.map(layer => new Layer(this.page, layer, id => byId(id).textContent));
    this.scene = new Scene(byId('map'), this.page, this.layers);
    this.envelope = new Envelope(this.layers[0], this.page.radius);
    this.ball = new Ball(this.scene, this.envelope, this.page.radius);
    this.cut = new Cut(this.scene, this.envelope, this.layers[1] ?? null, this.page);
    this.flat = new SectionPanel(byId('flat'), this.cut, this.ball, this.page);
    this.inspector = new Inspector(this.page);
    this.held = false;
    this.makePanel();
    this.makeTools();
    this.input = new Input(byId('map'), this.scene, this.inputActions());
    this.scene.listeners.push(moving => this.cut.update(moving), () => this.showScale());
    window.addEventListener('resize', () => {
      this.scene.resize();
      this.flat.request();
    });
    const dark = matchMedia('(prefers-color-scheme: dark)');
    this.setTheme(dark.matches ? 'dark' : 'light');
    this.applyFragment(parseFragment(location.hash));
  }

  get hasTerrain() { return this.layers.length > 1; }
  get margins() { return {left: innerWidth > 900 && !byId('panel').hidden ? 290 : 0}; }

  makePanel() {
    const {scene, cut} = this, half = scene.extent / 2;
    this.panel = new Panel(this.page, {
      hasTerrain: this.hasTerrain,
      opacity: 1,
      showSurface: on => {
        scene.shown.surface = on;
        scene.request();
      },
      showGround: on => {
        scene.shown.ground = on;
        scene.request();
      },
      showKinds: on => scene.setKinds(on),
      setOpacity: opacity => scene.setOpacity(opacity),
      showLines: (kind, on) => {
        scene.surface.lineKinds[kind] = on;
        scene.request();
      },
      cut: on => this.setCut(on),
      follow: on => {
        cut.follow = on;
        this.followBall();
      },
      cutGround: on => cut.change({cutGround: on}),
      turnCut: angle => this.moveCut({angle}),
      moveCut: share => {
        this.panel.follow.checked = cut.follow = false;
        this.moveCut({offset: share * half});
      },
      showOffset: share => exact(Number((share * half).toPrecision(4))),
    });
    cut.listeners.push(() => {
      this.panel.angle.set(Math.round(cut.angle));
      this.panel.offset.set(cut.offset / half);
    });
  }

  makeTools() {
    const press = (id, act) => byId(id).addEventListener('click', act);
    press('zoom-in', () => this.input.zoom(1 / 1.5));
    press('zoom-out', () => this.input.zoom(1.5));
    press('fit', () => this.scene.fit(undefined, this.margins));
    press('top', () => this.lookDown());
    press('near', () => this.goToBall());
    press('cut', () => this.setCut(!this.cut.on));
    press('theme', () => this.setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
    press('toggle-panel', () => {
      const panel = byId('panel');
      panel.hidden = !panel.hidden;
      byId('toggle-panel').setAttribute('aria-expanded', String(!panel.hidden));
    });
    if (innerWidth < 640) byId('toggle-panel').click();
  }

  inputActions() {
    return {
      // A click holds the ball where it is, for looking at it; the next one lets it follow the mouse again.
      hold: () => {
        this.held = !this.held;
      },
      release: () => {
        this.held = false;
        this.ball.remove();
        this.inspector.show(null);
        this.flat.request();
      },
      rollTo: (x, y, now) => {
        if (this.held && !now) return;
        const place = this.ball.placeUnder(x, y);
        if (place) this.roll(place[0], place[1]);
      },
      roll: (dx, dy) => {
        const {rest} = this.ball, {target} = this.scene.controls, step = this.page.radius / 10;
        this.held = true;
        if (rest)
          this.roll(rest.x + dx * step, rest.y + dy * step);
        else
          this.roll(target.x, target.y);
      },
      fit: () => this.scene.fit(undefined, this.margins),
      top: () => this.lookDown(),
      keys: {
        b: () => this.goToBall(),
        x: () => this.setCut(!this.cut.on),
        '[': () => this.shiftCut(-1),
        ']': () => this.shiftCut(1),
        ',': () => this.spinCut(5),
        '.': () => this.spinCut(-5),
      },
    };
  }

  roll(x, y) {
    const rest = this.ball.place(x, y);
    if (!rest) return;
    this.inspector.show(rest, this.held);
    this.followBall();
  }

  followBall() {
    if (!this.cut.on) return;
    if (this.cut.follow && this.ball.rest) {
      this.cut.at = [this.ball.rest.x, this.ball.rest.y];
      this.cut.change({});
    }
    this.flat.request(true);
  }

  setCut(on) {
    byId('cut').setAttribute('aria-pressed', String(on));
    this.panel.cut.checked = on;
    document.documentElement.classList.toggle('cutting', on);
    byId('profile').hidden = !on;
    this.scene.resize();
    if (on && this.cut.follow && this.ball.rest) this.cut.at = [this.ball.rest.x, this.ball.rest.y];
    this.cut.change({on});
    this.flat.reset();
  }

  shiftCut(sign) {
    this.panel.follow.checked = this.cut.follow = false;
    this.moveCut({offset: this.cut.offset + sign * 0.1 * this.page.radius});
  }

  spinCut(degrees) {
    const angle = this.cut.angle + degrees;
    this.moveCut({angle: angle > 90 ? angle - 180 : angle < -90 ? angle + 180 : angle});
  }

  moveCut(values) {
    this.cut.change(values);
    this.flat.request(true);
  }

  lookDown() {
    const {controls, camera} = this.scene, distance = camera.position.distanceTo(controls.target);
    this.scene.look(
        controls.target.clone(), controls.target.clone().add(new THREE.Vector3(0, -1e-4, 1).multiplyScalar(distance)));
  }

  // Near enough to see what is touched.
  goToBall() {
    const {rest} = this.ball, {scene} = this;
    if (!rest) return;
    const target = new THREE.Vector3(rest.x, rest.y, rest.height);
    const direction = scene.camera.position.clone().sub(scene.controls.target).normalize();
    scene.look(target, this.eyeFor(target, direction, 9 * this.page.radius));
  }

  // In that direction, or more from above if the surface is in the way.
  eyeFor(target, direction, distance) {
    const flat = Math.hypot(direction.x, direction.y) || 1e-9;
    let up = Math.atan2(direction.z, flat);
    const eye = () => target.clone().add(
        new THREE.Vector3(direction.x / flat * Math.cos(up), direction.y / flat * Math.cos(up), Math.sin(up))
            .multiplyScalar(distance));
    const hidden = place => Array.from({length: 24}, (_, i) => target.clone().lerp(place, (i + 1) / 24))
                                .some(p => (this.envelope.contact(p.x, p.y)?.height ?? -Infinity) > p.z);
    for (; up < 1.5 && hidden(eye()); up += 0.1)
      ;
    return eye();
  }

  setTheme(name) {
    document.documentElement.dataset.theme = name;
    this.scene.setTheme(name);
    const {colors} = this.scene;
    for (const part of [this.panel, this.ball, this.cut]) part.setTheme(colors);
    this.flat.request();
  }

  // The length of a bar at the middle of the view.
  showScale() {
    const {scene} = this, distance = scene.camera.position.distanceTo(scene.controls.target);
    const pixel = distance / scene.pixels(), length = niceStep(60 * pixel);
    byId('scale-text').textContent = `${text(length, length)} ${this.page.unit}`;
    byId('scale-bar').style.width = `${length / pixel}px`;
  }

  // Coordinates of the file to those of the scene.
  local(x, y) { return [x - this.page.origin[0], y - this.page.origin[1]]; }

  applyFragment(state) {
    document.documentElement.classList.toggle('figure', state.figure);
    if (state.theme) this.setTheme(state.theme);
    this.scene.fit(undefined, this.margins);
    if (state.plain) byId('kinds').click();
    for (const id of state.hide) {
      const box = byId(LINE_NAMES.includes(id) || ['surface', 'ground'].includes(id) ? id : '');
      if (box?.checked) box.click();
    }
    if (state.opacity) {
      this.panel.opacity.set(state.opacity[0]);
      this.scene.setOpacity(state.opacity[0]);
    }
    if (state.ball) {
      this.held = true;
      this.roll(...this.local(...state.ball));
    }
    if (state.cut) {
      this.cut.follow = state.cut.length < 2;
      this.panel.follow.checked = this.cut.follow;
      this.cut.angle = state.cut[0];
      if (state.cutGround) byId('cut-ground')?.click();
      this.setCut(true);
      if (!this.cut.follow) this.moveCut({offset: state.cut[1]});
    }
    if (state.at || state.eye) this.setView(state.at ?? state.ball, state.eye);
  }

  // at: a place of the file; eye: direction from it to the eye, and how far away it is.
  setView(at, eye = [-0.3, -0.8, 0.6, 12 * this.page.radius]) {
    const {scene} = this, [x, y] = at ? this.local(...at) : [scene.controls.target.x, scene.controls.target.y];
    const contact = this.envelope.contact(x, y), z = contact ? contact.height : scene.controls.target.z;
    const target = new THREE.Vector3(x, y, z), direction = new THREE.Vector3(...eye).normalize();
    scene.look(target, this.eyeFor(target, direction, eye[3]));
  }

  // For scripts and tests; coordinates are those of the file.
  api() {
    const {scene, page} = this, origin = page.origin;
    const told = contact => contact && {
      height: contact.height + origin[2],
      touches: contact.touches.map(t => ({feature: t.feature, kind: t.kind, at: t.at.map((v, i) => v + origin[i])}))
    };
    return {
      page,
      frame: () => ({count: scene.frames, stale: scene.stale || scene.drawn.waiting, ...scene.drawn}),
      contact: (x, y) => told(this.envelope.contact(...this.local(x, y))),
      ball: () =>
          this.ball.rest && {x: this.ball.rest.x + origin[0], y: this.ball.rest.y + origin[1], ...told(this.ball.rest)},
      roll: (x, y) => {
        this.held = true;
        this.roll(...this.local(x, y));
      },
      toScreen: (x, y, z) => scene.toScreen(...this.local(x, y), z - origin[2]),
      setView: (at, eye) => this.setView(at, eye),
      cut: (on, values = {}) => {
        if (values.offset !== undefined) this.cut.follow = this.panel.follow.checked = false;
        this.setCut(on);
        this.moveCut(values);
      },
      section: (count = 1500, tolerance = scene.extent * 1e-12) => {
        const range = this.cut.range(), {line} = this.cut, curves = this.cut.curves(...range, count, tolerance);
        const place = (s, z) => [...line.place(s).map((v, i) => v + origin[i]), z + origin[2]];
        return {
          surface: curves.surface.map(
              ({feature, kind, points}) => ({
                feature,
                kind,
                points: Array.from({length: points.length / 2}, (_, i) => place(points[2 * i], points[2 * i + 1]))
              })),
          ground: curves.ground.map(([s0, z0, s1, z1]) => [place(s0, z0), place(s1, z1)])
        };
      },
      // Milliseconds of each of `count` pictures while the eye turns, with all that drawing takes.
      measure: count => this.measure(count),
    };
  }

  async measure(count) {
    const times = [], {scene} = this, gl = scene.renderer.getContext(), pixel = new Uint8Array(4);
    for (let i = 0; i < count; ++i) {
      const begin = performance.now(), {frames} = scene;
      this.input.turn(Math.PI / 180, 0);
      while (scene.frames === frames) await new Promise(done => requestAnimationFrame(done));
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // waits until it is drawn
      times.push(performance.now() - begin);
    }
    return times;
  }
}
