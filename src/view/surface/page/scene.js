// The scene: layers, camera, what is drawn when. Pictures are made when something has changed, not all the time.

import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {COLORS} from './kinds.js';
import {lineMaterial, setWindow} from './lines.js';
import {setOpacity, setPaints, surfaceMaterial} from './materials.js';
import {Pace} from './pace.js';
import {TileSet} from './tiles.js';

const FIELD_OF_VIEW = 35;
const REST_AFTER = 180;                         // milliseconds
const LINE_WIDTHS = [1.1, 1.8, 2.2];            // pixels of seams, valleys, rims
const FADING = [0.12, 0.25, 0.4, 0.6, 0.8, 1];  // lines of small faces are thin and pale, or nothing else would be seen

THREE.ColorManagement.enabled = false;

function drawsInSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

export class Scene {
  // boxes: [low, high] of what else is shown
  constructor(canvas, page, layers, boxes = []) {
    this.page = page;
    this.layers = layers;
    this.boxes = boxes;
    // Without graphics hardware, smooth edges take twice the time: then pictures at rest have twice the pixels a side
    // instead.
    const software = drawsInSoftware();
    this.restScale = software && window.devicePixelRatio < 2 ? 2 : 1;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: !software, powerPreference: 'high-performance'});
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.localClippingEnabled = true;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 2);
    this.camera.up.set(0, 0, 1);
    this.cutPlane = new THREE.Plane(new THREE.Vector3(0, 1, 0), 0);
    this.noPlanes = [];
    this.surfaceMaterial = surfaceMaterial(this.noPlanes);
    this.groundMaterial = surfaceMaterial(this.noPlanes, true);
    this.lineMaterials = LINE_WIDTHS.map(
        width => FADING.map(share => lineMaterial(width * (0.5 + 0.5 * share), this.noPlanes, {opacity: share})));
    this.sets = layers.map(
        layer => layer.role === 'surface' ? new TileSet(layer, page.radius, this.surfaceMaterial, this.lineMaterials) :
                                            new TileSet(layer, 0, this.groundMaterial, null));
    for (const set of this.sets) this.scene.add(set.group);
    const set = role => this.sets.find(({layer}) => layer.role === role) ?? null;
    this.surface = set('surface');
    this.ground = set('terrain');
    this.covered = () => this.surface && this.shown.surface && this.opacity === 1 && !this.cutting;  // the ground is
    this.shown = {surface: true, ground: true};
    this.opacity = 1;
    this.drawn = {tiles: 0, triangles: 0, segments: 0, waiting: true};
    this.frames = 0;
    this.pace = new Pace();
    this.scale = 1;  // of the pixels a side
    this.stale = true;
    this.listeners = [];  // called before each picture
    this.measure();
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, {
      zoomToCursor: true,
      maxPolarAngle: Math.PI * 0.495,
      screenSpacePanning: false,
      rotateSpeed: 0.8,
      minDistance: this.extent * 1e-6,
      maxDistance: this.extent * 6
    });
    this.controls.addEventListener('change', () => this.request(true));
    this.resize();
    this.fit();
  }

  // Whole numbers of the page are relative to its origin; the scene's are too, and never large beside what is shown.
  measure() {
    const boxes = [...this.layers.map(layer => [layer.low3, layer.high3]), ...this.boxes];
    this.low = [0, 1, 2].map(i => Math.min(...boxes.map(([low]) => low[i])));
    this.high = [0, 1, 2].map(i => Math.max(...boxes.map(([, high]) => high[i])));
    this.extent = Math.hypot(...[0, 1, 2].map(i => this.high[i] - this.low[i]));
    // Countries are flat: slopes are lit as if heights were so much larger that the relief is a sixth of the width.
    const width = Math.max(this.high[0] - this.low[0], this.high[1] - this.low[1]);
    const relief = Math.min(3, Math.max(1, width / 6 / Math.max(this.high[2] - this.low[2], 1e-9 * width)));
    for (const material of [this.surfaceMaterial, this.groundMaterial]) material.uniforms.relief.value = relief;
  }

  setTheme(name) {
    this.colors = COLORS[name];
    const c = this.colors, {ground} = c;
    setPaints(
        this.surfaceMaterial, {plane: c.plane, cylinder: c.cylinder, sphere: c.sphere, wall: c.wall, plain: c.plain});
    setPaints(this.groundMaterial, {plane: ground, cylinder: ground, sphere: ground, wall: ground, plain: ground});
    [c.seam, c.valley, c.rim].forEach(
        (color, kind) => this.lineMaterials[kind].forEach(material => material.color.set(color)));
    this.scene.background = new THREE.Color(c.paper);
    this.request();
  }

  resize() {
    const canvas = this.renderer.domElement;
    this.width = Math.max(1, canvas.clientWidth || window.innerWidth);
    this.height = Math.max(1, canvas.clientHeight || window.innerHeight);
    this.camera.aspect = this.width / this.height;
    setWindow(this.width, this.height);
    this.setPixels(1);
    this.request();
  }

  setPixels(scale) {
    this.scale = scale;
    this.renderer.setPixelRatio((window.devicePixelRatio || 1) * scale);
    this.renderer.setSize(this.width, this.height, false);
  }

  // The whole from the south, at a slant. margins: pixels that are covered on the left and below.
  fit(direction = [-0.25, -0.8, 0.62], margins = {left: 0, bottom: 0}) {
    const middle = new THREE.Vector3(...[0, 1, 2].map(i => (this.low[i] + this.high[i]) / 2));
    const d = new THREE.Vector3(...direction).normalize();
    const tangent = Math.tan(this.camera.fov * Math.PI / 360), free = 1 - margins.left / this.width;
    // As near as all corners of the box allow.
    let distance = 0;
    const right = new THREE.Vector3().crossVectors(new THREE.Vector3(0, 0, 1), d).normalize(),
          up = new THREE.Vector3().crossVectors(d, right);
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3(...[0, 1, 2].map(i => (k >> i & 1 ? this.high : this.low)[i])).sub(middle);
      const across = Math.abs(corner.dot(right)) / (tangent * this.camera.aspect * free),
            along = Math.abs(corner.dot(up)) / tangent;
      distance = Math.max(distance, Math.max(across, along) + corner.dot(d));
    }
    this.look(middle, middle.clone().addScaledVector(d, 1.04 * distance));
    // Shifted to the middle of what is free.
    const shift = margins.left / this.width * tangent * this.camera.aspect * distance;
    const move = right.multiplyScalar(-shift);
    this.look(middle.clone().add(move), this.camera.position.clone().add(move));
  }

  look(target, position) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    this.controls.update();
    this.request();
  }

  request(moving = false) {
    this.stale = true;
    if (moving) this.movedAt = performance.now();
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.frame();
    });
  }

  get moving() { return performance.now() - (this.movedAt ?? -Infinity) < REST_AFTER; }

  // One picture, and another one later if this one is not the best there is.
  frame() {
    const now = performance.now(), {moving} = this, waited = this.drawn.waiting;
    this.stale = false;
    if (moving && this.lastMoving) this.pace.took(now - this.lastMoving);
    this.lastMoving = moving ? now : 0;
    const scale = moving ? this.pace.scale : waited ? 1 : this.restScale;
    if (scale !== this.scale) this.setPixels(scale);
    for (const listener of this.listeners) listener(moving);
    const {resting} = this.pace;
    // Tiles first, all lines when they are there.
    if (this.drawn.waiting) resting.lineBudget = this.pace.moving.lineBudget;
    this.draw(moving ? this.pace.moving : resting);
    ++this.frames;
    if (moving) {
      clearTimeout(this.rest);
      this.rest = setTimeout(() => this.request(), REST_AFTER + 20);
      this.stale = true;
    } else if (this.drawn.waiting || waited) {
      this.request();
    }
  }

  draw(quality) {
    this.setNearAndFar();
    if (this.cut) this.placeCut();
    const camera = this.camera;
    camera.updateMatrixWorld();
    const frustum = new THREE.Frustum().setFromProjectionMatrix(
        new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const box = new THREE.Box3(), {x, y, z} = camera.position;
    const view = {
      ...quality,
      eye: [x, y, z],
      pixels: this.pixels(),
      visible: tile => frustum.intersectsBox(box.set(box.min.fromArray(tile.low), box.max.fromArray(tile.high)))
    };
    const toWorld = new THREE.Matrix3().setFromMatrix4(camera.matrixWorld);
    for (const material of [this.surfaceMaterial, this.groundMaterial]) material.uniforms.toWorld.value.copy(toWorld);
    const surface = this.surface && this.shown.surface;
    if (this.surface) this.surface.group.visible = surface;
    // Below an opaque surface nothing of the ground shows.
    const ground = this.ground && this.shown.ground && !this.covered();
    if (this.ground) this.ground.group.visible = Boolean(ground);
    const drawn = [surface && this.surface, ground && this.ground].filter(Boolean).map(
        set => set.update({...view, budget: view.budget / (surface && ground ? 2 : 1)}, quality.milliseconds));
    const sum = key => drawn.reduce((total, d) => total + d[key], 0);
    this.drawn = {
      tiles: sum('tiles'),
      triangles: sum('triangles'),
      segments: sum('segments'),
      waiting: drawn.some(d => d.waiting)
    };
    this.renderer.render(this.scene, camera);
  }

  // Pixels of a unit of length at the distance 1.
  pixels() { return this.height / (2 * Math.tan(this.camera.fov * Math.PI / 360)); }

  setNearAndFar() {
    let near = Infinity, far = 0;
    const forward = this.camera.getWorldDirection(new THREE.Vector3());
    for (let k = 0; k < 8; ++k) {
      const d = new THREE.Vector3(...[0, 1, 2].map(i => (k >> i & 1 ? this.high : this.low)[i]))
                    .sub(this.camera.position)
                    .dot(forward);
      near = Math.min(near, d);
      far = Math.max(far, d);
    }
    const distance = this.camera.position.distanceTo(this.controls.target);
    far = Math.max(far + 2.5 * this.page.radius, distance) * 1.05;
    this.camera.near = Math.max(near - 2.5 * this.page.radius, Math.min(distance * 0.01, far * 0.002), far * 1e-5);
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
  }

  setOpacity(opacity) {
    this.opacity = opacity;
    setOpacity(this.surfaceMaterial, opacity);
    this.request();
  }

  setKinds(on) {
    this.surfaceMaterial.uniforms.kinds.value = on ? 1 : 0;
    this.request();
  }

  // cut: null, or { line, ground }: what lies on the viewer's side of the plane is
  // left out, of the ground too if asked.
  setCut(cut) {
    this.cutting = cut !== null;
    this.cut = cut;
    const planes = cut ? [this.cutPlane] : this.noPlanes, ground = cut?.ground ? [this.cutPlane] : this.noPlanes;
    for (const material of [this.surfaceMaterial, ...this.lineMaterials.flat()]) material.clippingPlanes = planes;
    this.groundMaterial.clippingPlanes = ground;
    this.request();
  }

  // The half that is left is the one the eye is not in.
  placeCut() {
    const {at, normal} = this.cut.line, {x, y} = this.camera.position;
    const side = normal[0] * (x - at[0]) + normal[1] * (y - at[1]) > 0 ? -1 : 1;
    this.cutPlane.normal.set(side * normal[0], side * normal[1], 0);
    this.cutPlane.constant = -side * (normal[0] * at[0] + normal[1] * at[1]);
  }

  toScreen(x, y, z) {
    const p = new THREE.Vector3(x, y, z).project(this.camera);
    return [(p.x + 1) / 2 * this.width, (1 - p.y) / 2 * this.height];
  }

  // From the eye through a pixel.
  ray(px, py) {
    const p = new THREE.Vector3(2 * px / this.width - 1, 1 - 2 * py / this.height, 0.5).unproject(this.camera);
    return {origin: this.camera.position.toArray(), direction: p.sub(this.camera.position).normalize().toArray()};
  }
}
