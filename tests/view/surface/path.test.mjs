// The way of a tool and the material it takes off, in the page's own modules: against krepl's simulation, which is written in
// another language, and against tools that stand at many places of their way.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import test from 'node:test';

import {directory, hills, krepl, module, randomFrom} from './support.mjs';

const {Cutting, Stock, Tool} = await module('path/stock');
const {RAPID, Timeline} = await module('path/timeline');
const {clock} = await module('path/player');

const SIDE = 12, AT = [1000, -500];
const part = hills('part', SIDE, 1.5, 11, AT);

// A program of lines and arcs in all directions over the part; the ways down are rapid.
function program(name, moves, seed, arcs) {
  const random = randomFrom(seed), near = i => (AT[i] + random() * (SIDE - 1)).toFixed(3);
  const lines = ['G21 G90', `G0 X${AT[0]} Y${AT[1]} Z5`, 'F100'];
  for (let k = 0; k < moves; ++k) {
    const kind = random(), z = (0.4 + random() * 3).toFixed(3);
    if (kind < 0.1) lines.push('G0 Z5', `G0 X${near(0)} Y${near(1)}`, `G1 Z${z} F50`);
    else if (kind < 0.4 && arcs) lines.push(`G91 G${2 + Math.round(random())} X1.5 Y0.5 Z-0.1 I0.75 J0.25 F200`, 'G90');
    else if (kind < 0.5) lines.push(`G1 Z${z}`);
    else if (kind < 0.6) lines.push(`G1 X${near(0)}`);
    else lines.push(`G1 X${near(0)} Y${near(1)} Z${z} F150`);
  }
  const path = join(directory, name + '.ngc');
  writeFileSync(path, lines.join('\n') + '\n');
  return path;
}

function read(name, path, tool, ...more) {
  const page = join(directory, name + '.html');
  krepl('view', path, '-o', page, '--input', part, '--tool', tool, '--stock', '1,4', '--cell', '0.21', ...more);
  const html = readFileSync(page, 'utf8');
  const text = id => {
    const mark = `id="${id}">`, begin = html.indexOf(mark) + mark.length;
    return html.slice(begin, html.indexOf('</script>', begin));
  };
  const description = JSON.parse(text('page')), timeline = new Timeline(description.path, text);
  const stock = new Stock(description.material, text), cutter = new Tool(description.tool);
  return {description, timeline, stock, tool: cutter, cutting: new Cutting(stock, timeline, cutter)};
}

const worst = (a, b) => a.reduce((most, v, i) => Math.max(most, Math.abs(v - b[i])), 0);

const TOOLS = ['ball:2', 'flat:1.6', 'bull:2:0.4', 'cone:2:60', 'taper:2:20:0.3'];

for (const [i, tool] of TOOLS.entries()) {
  test(`${tool}: all of it cut is what krepl simulate leaves`, () => {
    const {timeline, stock, tool: cutter, description} = read(`all${i}`, program(`all${i}`, 60, 3 + i, true), tool);
    for (let p = 0; p < timeline.pieces; ++p) {
      const {x, y, z} = timeline;
      stock.sweep(cutter, x[p], y[p], z[p], x[p + 1], y[p + 1], z[p + 1]);
    }
    // The page's chords are off the arcs by a fiftieth of a cell, in height by as much more as the tool is steep; at its shank it is
    // upright.
    const limit = 1.1 * stock.cell / 50 * (1 + (cutter.slope ?? 2));
    const off = stock.heights.map((h, d) => Math.abs(h - stock.finished[d])), many = off.filter(d => d > limit).length;
    assert.ok(many <= 0.004 * off.length, `${many} of ${off.length} differ`);
    assert.ok(stock.heights.some(h => h < description.material.top - 1), 'it has cut');
  });
  test(`${tool}: lines alone leave the same to the last digits`, () => {
    const {timeline, stock, tool: cutter} = read(`lines${i}`, program(`lines${i}`, 60, 13 + i, false), tool);
    const {x, y, z} = timeline;
    for (let p = 0; p < timeline.pieces; ++p) stock.sweep(cutter, x[p], y[p], z[p], x[p + 1], y[p + 1], z[p + 1]);
    const off = stock.heights.map((h, d) => Math.abs(h - stock.finished[d])), many = off.filter(d => d > 2e-5).length;
    assert.ok(many <= 2, `${many} differ, by ${Math.max(...off)}`);  // where rounding decides on which side of its edge a place is
  });
}

test('at any time it is what a tool leaves that stands at many places of its way', () => {
  const {timeline, stock, tool, cutting} = read('times', program('times', 25, 40, true), 'ball:2');
  const random = randomFrom(41);
  let gone = 0;
  for (const time of [0.2, 0.7, 0.5, 0.31, 0.9].map(share => share * timeline.minutes)) {
    assert.ok(cutting.advance(time));
    for (let n = 0; n < 60; ++n) {
      const dexel = Math.floor(random() * stock.heights.length);
      const x = stock.first[0] + (dexel % stock.columns) * stock.cell, y = stock.first[1] + Math.floor(dexel / stock.columns) * stock.cell;
      let height = stock.top;
      const steps = 20000;
      for (let k = 0; k <= steps; ++k) {
        const at = timeline.at(time * k / steps), away = Math.hypot(at.x - x, at.y - y);
        if (away < tool.radius) height = Math.min(height, at.z + tool.radius - Math.sqrt(tool.radius ** 2 - away ** 2));
      }
      height = Math.max(height, stock.bottom);
      // Between two of the places the tool goes on by a step; near its upright side that is much in height.
      assert.ok(stock.heights[dexel] <= height + 1e-5, 'nothing is left where the tool has been');
      assert.ok(stock.heights[dexel] >= height - 0.1, `${height - stock.heights[dexel]} too much at ${time}`);
      gone += height < stock.top ? 1 : 0;
    }
  }
  assert.ok(gone > 60);
});

test('going back and on again leaves the same', () => {
  const {timeline, stock, cutting} = read('back', program('back', 400, 50, false), 'ball:3');
  cutting.interval = 20000;  // many states to go back to, and so many that some are forgotten
  const times = [0.1, 0.6, 0.9, 0.3, 0.31, 0.7, 0.05, 0.999].map(share => share * timeline.minutes);
  for (const time of times) assert.ok(cutting.advance(time));
  const states = cutting.keys.length, left = stock.heights.slice();
  assert.ok(states > 3 && states <= 41, `${states} states`);
  const fresh = read('again', join(directory, 'back.ngc'), 'ball:3');
  fresh.cutting.advance(times.at(-1));
  assert.ok(worst(left, fresh.stock.heights) < 1e-5);
  cutting.advance(timeline.minutes);
  assert.equal(worst(stock.heights, stock.finished), 0);
  cutting.advance(0);
  assert.equal(worst(stock.heights, stock.before), 0);
});

test('little time at once comes to the same', () => {
  const {timeline, stock, cutting} = read('slices', program('slices', 400, 60, false), 'ball:3');
  let slices = 1;
  while (!cutting.advance(0.9 * timeline.minutes, 0)) ++slices;
  assert.ok(slices > 2, `${slices}`);
  const fresh = read('whole', join(directory, 'slices.ngc'), 'ball:3');
  fresh.cutting.advance(0.9 * timeline.minutes);
  assert.equal(worst(stock.heights, fresh.stock.heights), 0);
});

test('a path before it has left its part of the block', () => {
  const first = program('first', 40, 70, false), second = program('second', 10, 71, false);
  const {stock} = read('second', second, 'ball:2', '--before', `${first},ball:1`);
  const alone = read('first', first, 'ball:1');
  assert.equal(worst(stock.before, alone.stock.finished), 0);
  assert.ok(stock.heights.some((h, d) => stock.finished[d] < h));
});

test('places and moves in time', () => {
  const path = join(directory, 'clock.ngc');
  writeFileSync(path, 'G21 G90\nG0 X0 Y0 Z2\nG0 X10\nG1 Z0 F10\nG1 X30 F40\nG2 X40 Y0 I5 J0 F10\n');
  const page = join(directory, 'clock.html');
  krepl('view', path, '-o', page, '--tool', 'flat:2');
  const html = readFileSync(page, 'utf8');
  const text = id => html.split(`id="${id}">`)[1].split('</script>')[0];
  const timeline = new Timeline(JSON.parse(text('page')).path, text);
  // Rapid at twice the feed of 40: 10 / 80; then 2 / 10; 20 / 40; 5 pi / 10.
  const ends = [0, 0.125, 0.325, 0.825];
  assert.ok(Math.abs(timeline.minutes - (0.825 + Math.PI / 2)) < 1e-3);
  assert.equal(timeline.kindOf(0), RAPID);
  ends.forEach((end, i) => assert.ok(Math.abs(timeline.time[i] - end) < 1e-12));
  const at = timeline.at(0.575);
  assert.ok(Math.abs(at.x - 20) < 1e-9 && at.z === -2, 'relative to where it starts');
  assert.equal(timeline.line[timeline.move[at.piece]], 5);
  let time = 0;
  const steps = [];
  while (time < timeline.minutes) steps.push(time = timeline.step(time, 1));
  assert.deepEqual(steps.slice(0, 3).map(t => Number(t.toFixed(9))), ends.slice(1));
  assert.equal(steps.length, 4);
  const back = [];
  while (time > 0) back.push(time = timeline.step(time, -1));
  assert.deepEqual(back.map(t => Number(t.toFixed(9))), ends.slice().reverse());
  assert.equal(clock(61.5), '1:01:30');
  assert.equal(clock(1.51), '1:30.6');
});
