// Pages made by krepl, read by the page's own modules.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

const {KREPL, PAGE_MODULES} = process.env;
export const directory = mkdtempSync(join(tmpdir(), 'krepl-page-'));

export function module(name) { return import(pathToFileURL(join(PAGE_MODULES, name + '.js')).href); }

export function krepl(...words) { return execFileSync(KREPL, [...words, '--quiet'], {encoding: 'utf8'}); }

// Numbers between 0 and 1 from a seed.
export function randomFrom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

export function writeMesh(name, vertices, triangles) {
  const path = join(directory, name + '.off');
  writeFileSync(path, [
    'OFF', `${vertices.length} ${triangles.length} 0`, ...vertices.map(v => v.join(' ')),
    ...triangles.map(t => '3 ' + t.join(' '))
  ].join('\n') + '\n');
  return path;
}

// Hills on a grid of samples, at a place far from zero.
export function hills(name, size, height, seed, at = [0, 0]) {
  const random = randomFrom(seed), vertices = [], triangles = [];
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x) vertices.push([at[0] + x, at[1] + y, Math.round(height * random() * 4) / 4]);
  for (let y = 0; y + 1 < size; ++y) {
    for (let x = 0; x + 1 < size; ++x) {
      const a = y * size + x;
      triangles.push([a, a + 1, a + size + 1], [a, a + size + 1, a + size]);
    }
  }
  return writeMesh(name, vertices, triangles);
}

// The page of a surface: its description and its layers.
export async function pageOf(name, mesh, radius, format = 'json') {
  const result = join(directory, `${name}.${format}`), path = join(directory, name + '.html');
  krepl('terrain', mesh, result, '--radius', String(radius));
  krepl('view', result, '-o', path, '--input', mesh);
  const {Layer} = await module('layer'), html = readFileSync(path, 'utf8');
  const text = id => {
    const mark = `id="${id}">`, begin = html.indexOf(mark);
    if (begin < 0) throw new Error(`the page has no ${id}`);
    return html.slice(begin + mark.length, html.indexOf('</script>', begin));
  };
  const page = JSON.parse(text('page'));
  return {page, html, layers: page.layers.map(layer => new Layer(page, layer, text))};
}

// What krepl's drop cutter says: { h, kind, p } a place; h is NaN where the ball touches nothing.
export function heights(mesh, radius, places) {
  const at = join(directory, 'at.csv');
  writeFileSync(at, ['x,y', ...places.map(p => p.join(','))].join('\n') + '\n');
  const rows = krepl('height', mesh, '--radius', String(radius), '--at', at, '-o', '-').trim().split('\n').slice(1);
  return rows.map(row => row.split(',')).map(([, , h, kind,
                                               ...p]) => ({h: h === '' ? NaN : Number(h), kind, p: p.map(Number)}));
}
