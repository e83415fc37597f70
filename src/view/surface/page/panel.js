// The panel: what there is, in which colours, switches and sliders.

import {grouped} from './numbers.js';

function element(name, attributes = {}, ...children) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
}

// A row with a switch, a sample of the colour, a name and a remark. change(on) is called when it is switched.
export function addSwitch(parent, {id, name, remark = '', swatch = null, on = true, change = null}) {
  const box = element('input', {type: 'checkbox', id, checked: on, disabled: change === null});
  if (change === null) box.style.visibility = 'hidden';
  const mark = element('span', {className: 'swatch ' + (swatch?.line ? 'line' : 'wide')});
  if (!swatch) mark.style.display = 'none';
  parent.append(element(
      'label', {className: swatch ? 'row' : 'row bare', htmlFor: id}, box, mark,
      element('span', {}, name, remark ? element('small', {}, remark) : '')));
  if (change) box.addEventListener('change', () => change(box.checked));
  return {
    box,
    paint: color => {
      mark.style[swatch.line ? 'borderColor' : 'background'] = color;
    }
  };
}

// A slider; show(value) is what stands beside it.
export function addSlider(parent, {id, name, low, high, step, value, show, change}) {
  const slider = element('input', {type: 'range', id, min: low, max: high, step, value});
  const output = element('output', {htmlFor: id});
  parent.append(element('label', {className: 'slide'}, name, slider, output));
  const tell = () => {
    output.textContent = show(Number(slider.value));
  };
  slider.addEventListener('input', () => {
    tell();
    change(Number(slider.value));
  });
  tell();
  return {
    set: next => {
      slider.value = next;
      tell();
    }
  };
}

export class Panel {
  constructor(page, actions) {
    this.paints = [];
    const kinds = document.getElementById('patches'), edges = document.getElementById('edges');
    document.getElementById('about').textContent =
        `Centre of a ball of radius ${page.radius}${page.unit ? ' ' + page.unit : ''} that rests on the terrain: ` +
        `${grouped(page.faces.plane + page.faces.cylinder + page.faces.sphere)} patches`;
    addSwitch(kinds, {id: 'surface', name: 'Show it', change: actions.showSurface});
    const patch = (kind, name, a) =>
        this.add(kinds, {id: kind, name, swatch: {}, remark: `touching ${a}: ${grouped(page.faces[kind])}`}, kind);
    patch('plane', 'Planes', 'a face');
    patch('cylinder', 'Cylinders', 'an edge');
    patch('sphere', 'Spheres', 'a vertex');
    addSwitch(kinds, {id: 'kinds', name: 'Colours by kind', change: actions.showKinds});
    this.opacity = addSlider(kinds, {
      id: 'opacity',
      name: 'Opacity',
      low: 0.1,
      high: 1,
      step: 0.05,
      value: actions.opacity,
      show: v => `${Math.round(100 * v)} %`,
      change: actions.setOpacity
    });
    const line = (kind, index, name, meaning) => this.add(
        edges, {
          id: kind,
          name,
          remark: `${meaning}: ${grouped(page.edges[kind])}`,
          swatch: {line: true},
          change: on => actions.showLines(index, on)
        },
        kind);
    line('seam', 0, 'Seams', 'joined smoothly');
    line('valley', 1, 'Valleys', 'two contacts');
    line('rim', 2, 'Rims', 'the surface ends');
    const terrain = document.getElementById('terrain');
    if (actions.hasTerrain)
      this.add(terrain, {id: 'ground', name: 'Terrain', swatch: {}, change: actions.showGround}, 'ground');
    else
      terrain.remove();
    this.addSection(document.getElementById('section'), actions);
  }

  addSection(section, actions) {
    this.cut =
        addSwitch(section, {id: 'cutting', name: 'Cut', remark: 'a vertical plane', on: false, change: actions.cut})
            .box;
    this.follow = addSwitch(section, {id: 'follow', name: 'Through the ball', change: actions.follow}).box;
    if (actions.hasTerrain)
      addSwitch(section, {id: 'cut-ground', name: 'Cut the terrain too', on: false, change: actions.cutGround});
    this.angle = addSlider(section, {
      id: 'angle',
      name: 'Direction',
      low: -90,
      high: 90,
      step: 1,
      value: 0,
      show: v => `${v}\u00b0`,
      change: actions.turnCut
    });
    this.offset = addSlider(section, {
      id: 'offset',
      name: 'Place',
      low: -1,
      high: 1,
      step: 0.0005,
      value: 0,
      show: actions.showOffset,
      change: actions.moveCut
    });
  }

  add(parent, options, color) {
    const row = addSwitch(parent, options);
    this.paints.push({paint: row.paint, color});
  }

  setTheme(colors) {
    for (const {paint, color} of this.paints) paint(colors[color]);
  }
}
