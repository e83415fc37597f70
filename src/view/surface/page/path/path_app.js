// All parts of the page of a tool path.

import * as THREE from 'three';

import {Input} from '../input.js';
import {COLORS} from '../kinds.js';
import {Layer} from '../layer.js';
import {exact, grouped, niceStep, text} from '../numbers.js';
import {parseFragment} from '../page_state.js';
import {addSlider, addSwitch} from '../panel.js';
import {Scene} from '../scene.js';
import {PATH_COLORS} from './colors.js';
import {clock, Player} from './player.js';
import {Cutting, Stock, Tool} from './stock.js';
import {StockMesh} from './stock_mesh.js';
import {RAPID, Timeline} from './timeline.js';
import {ToolMesh} from './tool_mesh.js';
import {Way} from './way.js';

const byId = id => document.getElementById(id);
const MOVE_NAMES = ['rapid', 'line', 'arc, clockwise', 'arc, counter-clockwise'];
const CUT_MOVING = 14, CUT_RESTING = 120;  // milliseconds that cutting may take of a picture

export class PathApp {
  constructor() {
    this.page = JSON.parse(byId('page').textContent);
    const arrays = id => byId(id).textContent, {page} = this;
    this.layers = page.layers.map(layer => new Layer(page, layer, arrays));
    this.timeline = new Timeline(page.path, arrays);
    this.tool = new Tool(page.tool);
    this.stock = page.material ? new Stock(page.material, arrays) : null;
    this.cutting = this.stock ? new Cutting(this.stock, this.timeline, this.tool) : null;
    this.scene = new Scene(byId('map'), page, this.layers, this.boxes());
    this.addMeshes();
    this.there = true;  // the material is that of the time
    this.player = new Player(this.timeline, time => this.show(time));
    this.makePanel();
    this.makeTools();
    this.input = new Input(byId('map'), this.scene, this.inputActions());
    window.addEventListener('keydown', event => this.key(event));
    this.scene.listeners.push(moving => this.cut(moving), () => this.showScale());
    window.addEventListener('resize', () => this.scene.resize());
    this.setTheme(matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    this.applyFragment(parseFragment(location.hash));
  }

  get margins() { return {left: innerWidth > 900 && !byId('panel').hidden ? 290 : 0}; }

  boxes() {
    const boxes = [[this.timeline.low, this.timeline.high]], {stock} = this;
    if (stock) {
      const [x, y] = stock.first;
      boxes.push([
        [x, y, stock.bottom],
        [x + (stock.columns - 1) * stock.cell, y + (stock.rows - 1) * stock.cell, stock.top]
      ]);
    }
    return boxes;
  }

  addMeshes() {
    const {scene, stock, tool} = this;
    const height = Math.max(4 * tool.radius, tool.height(tool.radius) + 2 * tool.radius, 0.12 * scene.extent);
    this.toolMesh = new ToolMesh(tool, height);
    this.way = new Way(scene, this.timeline, scene.extent);
    scene.scene.add(this.toolMesh);
    if (!stock) return;
    this.stockMesh = new StockMesh(stock, tool.radius);
    scene.scene.add(this.stockMesh);
    // Below opaque material nothing of the part shows.
    scene.covered = () => this.stockMesh.visible && this.stockMesh.uniforms.opacity.value === 1;
  }

  makePanel() {
    const {scene, way, stockMesh, page, timeline, stock} = this;
    this.paints = [];
    const row = (parent, options, paint) => {
      const made = addSwitch(byId(parent), options);
      if (paint) this.paints.push(name => made.paint(paint(name)));
      return made;
    };
    byId('about').textContent = `${page.tool.text}, ${grouped(page.path.moves)} moves, ${clock(timeline.minutes)} without acceleration; ` +
        'rapid moves as fast as twice the fastest feed';
    const shownIn = key => on => {
      way.shown[key] = on;
      this.refresh();
    };
    row('way', {id: 'behind', name: 'Way behind', change: shownIn('done')});
    row('way', {id: 'ahead', name: 'Way ahead', remark: 'faint', change: shownIn('ahead')});
    row('way', {id: 'rapid', name: 'Rapid moves', remark: 'dashed', swatch: {line: true}, change: shownIn('rapid')}, name => PATH_COLORS[name].rapid);
    const low = exact(Number((way.lowest + page.origin[2]).toPrecision(5))), high = exact(Number((way.highest + page.origin[2]).toPrecision(5)));
    if (way.lowest <= way.highest)
      row('way', {
        id: 'by-depth',
        name: 'Colours by depth',
        remark: `blue ${low} to red ${high}; else lines and arcs`,
        change: on => {
          way.byDepth = on;
          way.setTheme(this.theme);
          this.refresh();
        }
      });
    row('way', {
      id: 'tool',
      name: 'Tool',
      swatch: {},
      change: on => {
        this.toolMesh.visible = on;
        scene.request();
      }
    }, name => PATH_COLORS[name].tool);
    if (!stock) {
      byId('material').remove();
      return;
    }
    row('material', {
      id: 'stock',
      name: 'Material',
      remark: `${grouped(stock.columns * stock.rows)} heights ${exact(Number(stock.cell.toPrecision(3)))} apart`,
      swatch: {},
      change: on => {
        stockMesh.visible = on;
        scene.request();
      }
    }, name => PATH_COLORS[name].stock);
    row('material', {
      id: 'by-rest',
      name: 'Colours by what is left',
      remark: `up to ${exact(Number(this.tool.radius.toPrecision(4)))} above the part; red: gouged`,
      swatch: {},
      change: on => {
        stockMesh.uniforms.colored.value = on ? 1 : 0;
        scene.request();
      }
    }, name => PATH_COLORS[name].rest);
    this.opacity = addSlider(byId('material'), {
      id: 'opacity',
      name: 'Opacity',
      low: 0.1,
      high: 1,
      step: 0.05,
      value: 1,
      show: v => `${Math.round(100 * v)} %`,
      change: v => {
        stockMesh.setOpacity(v);
        scene.request();
      }
    });
    row('material', {
      id: 'ground',
      name: 'Part',
      remark: 'shows where material is hidden or translucent',
      swatch: {},
      change: on => {
        scene.shown.ground = on;
        scene.request();
      }
    }, name => COLORS[name].ground);
  }

  makeTools() {
    const press = (id, act) => byId(id).addEventListener('click', act);
    press('zoom-in', () => this.input.zoom(1 / 1.5));
    press('zoom-out', () => this.input.zoom(1.5));
    press('fit', () => this.scene.fit(undefined, this.margins));
    press('top', () => this.lookDown());
    press('near', () => this.goToTool());
    press('theme', () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'));
    press('toggle-panel', () => {
      const panel = byId('panel');
      panel.hidden = !panel.hidden;
      byId('toggle-panel').setAttribute('aria-expanded', String(!panel.hidden));
    });
    if (innerWidth < 640) byId('toggle-panel').click();
  }

  inputActions() {
    const nothing = () => {};
    return {
      hold: nothing,
      release: () => this.player.play(false),
      rollTo: nothing,
      roll: nothing,
      fit: () => this.scene.fit(undefined, this.margins),
      top: () => this.lookDown(),
      keys: {b: () => this.goToTool()},
    };
  }

  // Keys of time work wherever the focus is, unless they mean something there.
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const {player, timeline} = this;
    const keys = {
      ' ': () => player.play(!player.playing),
      ',': () => player.step(-1),
      '.': () => player.step(1),
      Home: () => player.set(0),
      End: () => player.set(timeline.minutes),
    };
    if (!keys[event.key] || /^(BUTTON|SELECT)$/.test(event.target.tagName)) return;
    event.preventDefault();
    keys[event.key]();
  }

  // The moment has changed.
  show(time) {
    const at = this.at = this.timeline.at(time);
    this.toolMesh.position.set(at.x, at.y, at.z);
    this.way.show(at);
    this.there = !this.cutting;
    const {timeline, page} = this, move = timeline.move[at.piece], kind = timeline.kind[move];
    const place = ['x', 'y', 'z'].map((axis, i) => text(at[axis] + page.origin[i], page.radius / 1000)).join('  ');
    byId('moment').textContent = `${clock(time)} of ${clock(timeline.minutes)}`;
    byId('reading').textContent = [
      timeline.line ? `line ${timeline.line[move]}` : `move ${move + 1}`, MOVE_NAMES[kind],
      kind === RAPID ? '' : `feed ${exact(timeline.feed[move])}`, `tip at ${place}`
    ].filter(Boolean).join(' \u00b7 ');
    this.scene.request(true);
  }

  refresh() {
    this.way.show(this.at);
    this.scene.request();
  }

  // Before a picture: the material as far as time allows.
  cut(moving) {
    if (this.there) return;
    const {version} = this.cutting;
    this.there = this.cutting.advance(this.player.time, moving ? CUT_MOVING : CUT_RESTING);
    if (this.cutting.version !== version) this.stockMesh.refresh();
    document.documentElement.classList.toggle('behind', !this.there);
    if (!this.there) this.scene.request(moving);
  }

  lookDown() {
    const {controls, camera} = this.scene, distance = camera.position.distanceTo(controls.target);
    this.scene.look(
        controls.target.clone(), controls.target.clone().add(new THREE.Vector3(0, -1e-4, 1).multiplyScalar(distance)));
  }

  goToTool() {
    const {scene, at} = this, target = new THREE.Vector3(at.x, at.y, at.z);
    const direction = scene.camera.position.clone().sub(scene.controls.target).normalize();
    scene.look(target, target.clone().addScaledVector(direction, 16 * this.tool.radius));
  }

  setTheme(name) {
    this.theme = document.documentElement.dataset.theme = name;
    for (const part of [this.scene, this.way, this.toolMesh, this.stockMesh]) part?.setTheme(name);
    for (const paint of this.paints) paint(name);
    if (this.at) this.refresh();
  }

  // The length of a bar at the middle of the view.
  showScale() {
    const {scene} = this, distance = scene.camera.position.distanceTo(scene.controls.target);
    const pixel = distance / scene.pixels(), length = niceStep(60 * pixel);
    byId('scale-text').textContent = `${text(length, length)} ${this.page.unit}`;
    byId('scale-bar').style.width = `${length / pixel}px`;
  }

  applyFragment(state) {
    document.documentElement.classList.toggle('figure', state.figure);
    if (state.theme) this.setTheme(state.theme);
    this.scene.fit(undefined, this.margins);
    this.player.set(state.time ? state.time[0] : 0);
    for (const id of state.hide) {
      const box = byId(['behind', 'ahead', 'rapid', 'by-depth', 'tool', 'stock', 'by-rest', 'ground'].includes(id) ? id : '');
      if (box?.checked) box.click();
    }
    if (state.opacity && this.opacity) {
      this.opacity.set(state.opacity[0]);
      this.stockMesh.setOpacity(state.opacity[0]);
    }
    if (state.at || state.eye) this.setView(state.at, state.eye);
  }

  // at: a place of the program; eye: direction from it to the eye, and how far away it is.
  setView(at, eye) {
    const {scene, page} = this, {target} = scene.controls;
    const place = at ? new THREE.Vector3(...at.slice(0, 2).map((v, i) => v - page.origin[i]), at.length > 2 ? at[2] - page.origin[2] : target.z) :
                       target.clone();
    const [east, north, up, distance = scene.camera.position.distanceTo(target)] = eye ?? [-0.3, -0.8, 0.6];
    scene.look(place, place.clone().addScaledVector(new THREE.Vector3(east, north, up).normalize(), distance));
  }

  // For scripts and tests; coordinates are those of the program, times minutes.
  api() {
    const {scene, page, player, timeline, stock, cutting} = this, [ox, oy, oz] = page.origin;
    return {
      page,
      frame: () => ({count: scene.frames, stale: scene.stale || scene.drawn.waiting || !this.there, ...scene.drawn}),
      time: () => player.time,
      setTime: time => {
        player.play(false);
        player.set(time);
      },
      play: on => player.play(on),
      playing: () => player.playing,
      tool: () => {
        const {at} = this, move = timeline.move[at.piece];
        return {x: at.x + ox, y: at.y + oy, z: at.z + oz, move, line: timeline.line?.[move], kind: timeline.kind[move]};
      },
      // Heights of material, finished material and part on the dexel nearest to a place.
      material: (x, y) => {
        const dexel = stock ? stock.dexelAt(x - ox, y - oy) : -1;
        if (dexel < 0) return null;
        const {heights, finished, part} = stock;
        return {height: heights[dexel] + oz, finished: finished[dexel] + oz, part: stock.hasPart(dexel) ? part[dexel] + oz : null};
      },
      states: () => cutting?.keys.length,
      toScreen: (x, y, z) => scene.toScreen(x - ox, y - oy, z - oz),
      setView: (at, eye) => this.setView(at, eye),
    };
  }
}
