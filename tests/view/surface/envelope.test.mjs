// Heights in the page against krepl's drop cutter, which knows nothing of the surface.
import assert from 'node:assert/strict';
import test from 'node:test';

import {heights, hills, module, pageOf, randomFrom, writeMesh} from './support.mjs';

const {Envelope} = await module('envelope');

async function compare(name, mesh, radius, count, seed, format) {
  const {page, layers} = await pageOf(name, mesh, radius, format), [surface] = layers;
  const envelope = new Envelope(surface, page.radius), random = randomFrom(seed);
  const within = i => surface.low3[i] - 0.1 * radius + random() * (surface.high3[i] - surface.low3[i] + 0.2 * radius);
  // Places as krepl gets them; what is left when the origin is taken off is exact.
  const given = Array.from({length: count}, () => [within(0) + page.origin[0], within(1) + page.origin[1]]);
  const places = given.map(([x, y]) => [x - page.origin[0], y - page.origin[1]]);
  const truth = heights(mesh, radius, given);
  const scale = Math.max(radius, ...[0, 1, 2].map(i => surface.high3[i] - surface.low3[i]));
  let none = 0, worst = 0;
  truth.forEach(({h, kind, p}, k) => {
    const contact = envelope.contact(...places[k]);
    if (Number.isNaN(h)) {
      ++none;
      assert.equal(contact, null);
      return;
    }
    worst = Math.max(worst, Math.abs(contact.height + page.origin[2] - h) / scale);
    // Beside a seam either of two names is right; what is touched is at the same place then.
    const touch = contact.touches.find(t => ['vertex', 'edge', 'face'][t.kind] === kind) ?? contact.touches[0];
    const off = Math.hypot(...touch.at.map((v, i) => v + page.origin[i] - p[i]));
    if (contact.touches.length === 1) assert.ok(off < 1e-6 * scale, `contact off by ${off} at ${places[k]}`);
  });
  assert.ok(worst < 1e-10, `heights differ by ${worst} of the extent`);
  return none;
}

test('hills of whole quarters', async () => {
  const none = await compare('hills', hills('hills', 24, 3, 1), 1.25, 4000, 2);
  assert.ok(none > 20, 'some places lie beside the surface');
});
test('hills far from zero', () => compare('far', hills('far', 24, 3, 3, [412345, 5312345]), 0.7, 3000, 4));
test('a radius larger than the cells, more tiles than one', () => compare('wide', hills('wide', 60, 2, 5), 4, 2000, 6));
test('from a GeoPackage', () => compare('packed', hills('packed', 16, 3, 7), 1.25, 2000, 8, 'gpkg'));
test('a step with an upright wall', () => {
  const box = (z, x) => [[x, 0, z], [x + 4, 0, z], [x + 4, 4, z], [x, 4, z]];
  const mesh = writeMesh(
      'step', [...box(0, 0), ...box(3, 4)], [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [1, 4, 7], [1, 7, 2]]);
  return compare('step', mesh, 1, 3000, 9);
});
