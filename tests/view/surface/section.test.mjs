// Sections: pieces of the true curves, without gaps, ending where patches do.
import assert from 'node:assert/strict';
import test from 'node:test';

import {hills, module, pageOf, writeMesh} from './support.mjs';

const {Envelope} = await module('envelope');
const {lineOf, rangeOver, surfaceSection} = await module('section');
const {groundSection} = await module('section_ground');

const radius = 1.25;
const {page, layers: [surface, terrain]} = await pageOf('section', hills('section', 24, 3, 21), radius);
const envelope = new Envelope(surface, radius);

test('a line over a box', () => {
  const line = lineOf([1, 1], Math.PI / 4), [from, to] = rangeOver(line, [0, 0], [4, 4]);
  assert.ok(Math.abs(from + Math.SQRT2) < 1e-12 && Math.abs(to - 3 * Math.SQRT2) < 1e-12);
  assert.equal(rangeOver(lineOf([5, 5], 0), [0, 0], [4, 4]), null);
  assert.deepEqual(rangeOver(lineOf([5, 2], 0), [0, 0], [4, 4]), [-5, -1]);
});

test('pieces of a section are exact and join', () => {
  const line = lineOf([11.3, 12.1], 0.4), [from, to] = rangeOver(line, surface.low3, surface.high3);
  const pieces = surfaceSection(envelope, line, from, to, 2000, 1e-10);
  assert.ok(pieces.length > 30);
  for (const {points} of pieces) {
    for (let i = 0; i < points.length; i += 2) {
      const contact = envelope.contact(...line.place(points[i]));
      assert.equal(contact.height, points[i + 1]);
    }
  }
  for (let k = 1; k < pieces.length; ++k) {
    const a = pieces[k - 1].points, b = pieces[k].points;
    assert.ok(Math.abs(b[0] - a[a.length - 2]) < 2e-10, 'no gap');
    assert.ok(Math.abs(b[1] - a[a.length - 1]) < 1e-7, 'no step');
  }
});

test('each piece is one line or arc of an ellipse of its patch', () => {
  // Along x: a cylinder's section has (z - slope * s)^2 of second degree in s; planes have none.
  const line = lineOf([0, 7.3], 0), [from, to] = rangeOver(line, surface.low3, surface.high3);
  for (const {kind, points} of surfaceSection(envelope, line, from, to, 4000, 1e-10)) {
    if (kind !== 2 || points.length < 6) continue;
    const [s0, z0] = points, s1 = points[points.length - 2], z1 = points[points.length - 1];
    for (let i = 2; i < points.length; i += 2)
      assert.ok(Math.abs(z0 + (z1 - z0) * (points[i] - s0) / (s1 - s0) - points[i + 1]) < 1e-9);
  }
});

test('the terrain below', () => {
  const line = lineOf([11.3 - page.origin[0], 12.1 - page.origin[1]], 0.4);
  const segments = groundSection(terrain, line, -5, 5);
  const covered = segments.reduce((sum, [s0, , s1]) => sum + Math.min(5, s1) - Math.max(-5, s0), 0);
  assert.ok(Math.abs(covered - 10) < 1e-9, `covers ${covered} of 10, once`);
  for (const [s0, z0, s1, z1] of segments) {
    const s = (s0 + s1) / 2, contact = envelope.contact(...line.place(s));
    assert.ok(contact.height > (z0 + z1) / 2 + 0.99 * radius, 'the centre is a radius above it at least');
  }
});

test('a gap between two islands stays a gap', async () => {
  const mesh = writeMesh(
      'islands', [[0, 0, 0], [2, 0, 0], [0, 2, 0], [9, 0, 0], [11, 0, 0], [11, 2, 0]], [[0, 1, 2], [3, 4, 5]]);
  const {layers: [islands], page: {origin}} = await pageOf('islands', mesh, 1);
  const line = lineOf([0 - origin[0], 0.5 - origin[1]], 0), [from, to] = rangeOver(line, islands.low3, islands.high3);
  const pieces = surfaceSection(new Envelope(islands, 1), line, from, to, 500, 1e-9);
  const gaps = pieces.slice(1)
                   .map((piece, k) => piece.points[0] - pieces[k].points[pieces[k].points.length - 2])
                   .filter(d => d > 1e-6);
  assert.equal(gaps.length, 1);
});
