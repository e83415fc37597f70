// What the ball touches, in words.

import {PATCH_NAMES, TOUCHED_NAMES} from './kinds.js';
import {exact, grouped, rounded} from './numbers.js';

export class Inspector {
  constructor(page) {
    this.page = page;
    this.box = document.getElementById('inspector');
    this.spoken = document.getElementById('spoken');
  }

  place(p) { return p.map((v, i) => rounded(v + this.page.origin[i], 300 * this.page.radius)).join(', '); }

  // held: the ball does not follow the mouse.
  show(rest, held = false) {
    this.box.hidden = rest === null;
    if (!rest) return;
    const {touches} = rest, unit = this.page.unit ? ' ' + this.page.unit : '';
    const names = touches.map(t => `${TOUCHED_NAMES[t.kind]} ${grouped(t.feature)}`);
    this.box.querySelector('h2').textContent = `The ball touches ${names.join(' and ')}`;
    const rows = [
      ['centre', this.place([rest.x, rest.y, rest.height])],
      [
        'height',
        `${exact(rest.height + this.page.origin[2])}${unit}, lowest point ${
            exact(rest.height - this.page.radius + this.page.origin[2])}`
      ],
      ['patch', touches.map(t => PATCH_NAMES[t.kind]).join(', ') + (touches.length > 1 ? ' (a valley or seam)' : '')]
    ];
    for (const [i, t] of touches.entries()) {
      rows.push([touches.length > 1 ? `contact ${i + 1}` : 'contact', this.place(t.at)]);
      rows.push([TOUCHED_NAMES[t.kind], t.points.map(p => this.place(p)).join('\n')]);
    }
    if (held) rows.push(['held', 'a click lets it follow the mouse again']);
    this.box.querySelector('dl').replaceChildren(...rows.flatMap(([term, value]) => {
      const dt = document.createElement('dt'), dd = document.createElement('dd');
      dt.textContent = term;
      dd.textContent = value;
      return [dt, dd];
    }));
    this.spoken.textContent = `${names.join(' and ')}, height ${exact(rest.height + this.page.origin[2])}`;
  }
}
