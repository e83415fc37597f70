// Puts the parts together: pointer, keys, buttons, scale bar, coordinates, address.

const root = document.documentElement;
const page = decodePage();
const canvas = document.getElementById('map');
const place = document.getElementById('place');

function unitedBounds(layers) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const layer of layers) uniteBox(box, layer.bounds);
  return box[0] <= box[2] ? box : [0, 0, 1, 1];
}

function setTheme(name) {
  root.dataset.theme = name;
}
setTheme(window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');

const camera = new Camera(unitedBounds(page.layers));
const scene = new Scene(canvas, page, camera);
const panel = new Panel(page, scene);
const inspector = new Inspector(page, scene);

// As many decimals as a pixel tells apart.
function coordinate(x, y) {
  const decimals = Math.min(12, Math.max(0, Math.ceil(Math.log10(camera.scale)) + 1));
  return x.toFixed(decimals) + '  ' + y.toFixed(decimals);
}

function showScale() {
  const wanted = 130 / camera.scale, power = 10 ** Math.floor(Math.log10(wanted));
  const step = [5, 2, 1].find(k => k * power <= wanted) * power;
  document.getElementById('scale-text').textContent = lengthText(page, step, 3);
  document.getElementById('scale-bar').style.width = step * camera.scale + 'px';
}

function changed(moving = false) {
  showScale();
  scene.request(moving);
}

function zoomBy(factor, sx = (camera.width + camera.inset) / 2, sy = camera.height / 2, moving = false) {
  camera.zoom(factor, sx, sy);
  changed(moving);
}

function fit() {
  const box = document.getElementById('panel');
  camera.inset = !box.hidden && camera.width > 640 ? box.getBoundingClientRect().right : 0;
  camera.fit();
  changed();
}

// Pointers: one drags, two pinch, none hovers.
const pointers = new Map();
let lastPinch = null;

function pinch() {
  const [a, b] = [...pointers.values()];
  return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y)};
}

function hover(sx, sy) {
  place.textContent = coordinate(camera.toX(sx), camera.toY(sy));
  inspector.show(inspector.find(sx, sy), sx, sy, coordinate);
}

canvas.addEventListener('pointerdown', event => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, {x: event.offsetX, y: event.offsetY});
  lastPinch = pointers.size === 2 ? pinch() : null;
  canvas.classList.add('moving');
});
canvas.addEventListener('pointermove', event => {
  const pointer = pointers.get(event.pointerId), x = event.offsetX, y = event.offsetY;
  if (!pointer) { hover(x, y); return; }
  if (pointers.size === 1 && (x !== pointer.x || y !== pointer.y)) {
    inspector.show(null);
    camera.pan(x - pointer.x, y - pointer.y);
    changed(true);
  }
  pointer.x = x;
  pointer.y = y;
  if (pointers.size === 2 && lastPinch) {
    const now = pinch();
    camera.pan(now.x - lastPinch.x, now.y - lastPinch.y);
    if (now.size > 0 && lastPinch.size > 0) zoomBy(now.size / lastPinch.size, now.x, now.y, true);
    lastPinch = now;
  }
});
for (const name of ['pointerup', 'pointercancel']) {
  canvas.addEventListener(name, event => {
    pointers.delete(event.pointerId);
    lastPinch = null;
    if (pointers.size > 0) return;
    canvas.classList.remove('moving');
    changed();
    if (name === 'pointerup') hover(event.offsetX, event.offsetY);
  });
}
canvas.addEventListener('pointerleave', () => {
  if (pointers.size > 0) return;
  inspector.show(null);
  place.textContent = '';
});
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  const lines = event.deltaMode === 1 ? 30 : 1;
  zoomBy(Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0016)), event.offsetX, event.offsetY, true);
  inspector.show(null);
}, {passive: false});

const keys = {
  '+': () => zoomBy(1.5), '=': () => zoomBy(1.5), '-': () => zoomBy(1 / 1.5), '_': () => zoomBy(1 / 1.5), '0': fit,
  ArrowLeft: () => { camera.pan(80, 0); changed(); }, ArrowRight: () => { camera.pan(-80, 0); changed(); },
  ArrowUp: () => { camera.pan(0, 80); changed(); }, ArrowDown: () => { camera.pan(0, -80); changed(); },
  Escape: () => inspector.show(null),
  Enter: () => {
    const sx = (camera.width + camera.inset) / 2, sy = camera.height / 2;
    hover(sx, sy);
    inspector.speak(scene.hit, coordinate);
  },
};
window.addEventListener('keydown', event => {
  if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
  if (event.target !== canvas && (event.key.startsWith('Arrow') || event.key === 'Enter')) return;
  event.preventDefault();
  keys[event.key]();
});

document.getElementById('zoom-in').addEventListener('click', () => zoomBy(1.5));
document.getElementById('zoom-out').addEventListener('click', () => zoomBy(1 / 1.5));
document.getElementById('fit').addEventListener('click', fit);
function repaint() {
  scene.readColors();
  panel.paint();
  scene.request();
}
document.getElementById('theme').addEventListener('click', () => {
  setTheme(root.dataset.theme === 'dark' ? 'light' : 'dark');
  repaint();
});
document.getElementById('toggle-panel').addEventListener('click', event => {
  const box = document.getElementById('panel');
  box.hidden = !box.hidden;
  event.currentTarget.setAttribute('aria-expanded', String(!box.hidden));
});

// #at=x,y,units-per-pixel  #theme=dark  #figure (no controls)  #hide=holes,vertices,layer-0  #show=...  joined by &
function readAddress() {
  const wishes = new URLSearchParams(location.hash.slice(1));
  root.classList.toggle('figure', wishes.has('figure'));
  if (wishes.has('theme')) setTheme(wishes.get('theme') === 'dark' ? 'dark' : 'light');
  for (const [wish, on] of [['show', true], ['hide', false]]) {
    for (const name of (wishes.get(wish) || '').split(',')) panel.set(name, on);
  }
  repaint();
  const at = (wishes.get('at') || '').split(',').map(Number);
  fit();
  if (at.length === 3 && at.every(Number.isFinite) && at[2] > 0) {
    [camera.x, camera.y, camera.scale] = [at[0], at[1], 1 / at[2]];
    changed();
  }
}

window.addEventListener('resize', () => {
  const fitted = camera.scale === camera.fitted;
  scene.resize();
  if (fitted) fit(); else changed();
});
window.addEventListener('hashchange', readAddress);
scene.resize();
readAddress();

// For tests and for scripts in the console.
window.kreplView = {
  counts: page.layers.map(layer => ({role: layer.role, name: layer.name, radius: layer.radius, chains: layer.chains,
    polygons: layer.polygons, holes: layer.holes, pieces: layer.pieces, segments: layer.segments, arcs: layer.arcs,
    halfLines: layer.halfLines, area: layer.area, perimeter: layer.perimeter})),
  camera,
  toScreen: (x, y) => [camera.screenX(x), camera.screenY(y)],
  hitTest: (sx, sy) => describeHit(page, inspector.find(sx, sy)),
  setView: (x, y, scale) => { Object.assign(camera, {x, y, scale}); changed(); },
  frame: () => ({count: scene.frames, milliseconds: scene.cost, drawn: scene.drawn, stale: Boolean(scene.stale)}),
};
