// Rays against triangles and the exact surface; what follows # in the address; numbers for people.
import assert from 'node:assert/strict';
import test from 'node:test';

import {hills, module, pageOf} from './support.mjs';

const {entryOf, hitTriangles, refine} = await module('picking');
const {Envelope} = await module('envelope');
const {parseFragment} = await module('page_state');
const {exact, grouped, niceStep, rounded, text} = await module('numbers');

test('a ray enters a box', () => {
  const box = {low: [0, 0, 0], high: [1, 2, 3]};
  assert.equal(entryOf(box, [-1, 1, 1], [1, 0, 0]), 1);
  assert.equal(entryOf(box, [0.5, 1, 1], [1, 0, 0]), 0);
  assert.equal(entryOf(box, [-1, 3, 1], [1, 0, 0]), Infinity);
  assert.equal(entryOf(box, [2, 1, 1], [1, 0, 0]), Infinity);
});

test('the nearest triangle that is allowed', () => {
  const mesh = {position: [0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 1, 4, 0, 1, 0, 4, 1], index: [0, 1, 2, 3, 4, 5]};
  assert.equal(hitTriangles(mesh, [1, 1, 5], [0, 0, -1], () => true), 4);
  assert.equal(hitTriangles(mesh, [1, 1, 5], [0, 0, -1], t => t > 4.5), 5);
  assert.equal(hitTriangles(mesh, [3, 3, 5], [0, 0, -1], () => true), Infinity);
});

test('the exact place under a ray', async () => {
  const {page, layers: [surface]} = await pageOf('picking', hills('picking', 16, 2, 31), 1),
                       envelope = new Envelope(surface, 1);
  const target = [7.3 - page.origin[0], 8.1 - page.origin[1]], height = envelope.contact(...target).height;
  const origin = [target[0] - 3, target[1] - 4, height + 12], direction = [3 / 13, 4 / 13, -12 / 13];
  for (const off of [-0.2, 0, 0.2]) {
    const place = refine(envelope, origin, direction, 13 + off, 0.05);
    assert.ok(Math.abs(place[2] - envelope.contact(place[0], place[1]).height) < 1e-9);
    assert.ok(Math.hypot(place[0] - target[0], place[1] - target[1]) < 1e-9);
  }
});

test('the address', () => {
  const state = parseFragment('#at=3,4&ball=1,2&theme=dark&hide=seam,ground&cut=30&figure&opacity=x');
  assert.deepEqual(state, {hide: ['seam', 'ground'], figure: true, theme: 'dark', at: [3, 4], ball: [1, 2], cut: [30]});
});

test('numbers', () => {
  assert.equal(niceStep(0.3), 0.5);
  assert.equal(niceStep(2), 2);
  assert.equal(text(-1.25, 0.05), '\u22121.25');
  assert.equal(text(-0.001, 0.5), '0.0');
  assert.equal(grouped(1234567), '1\u2009234\u2009567');
  assert.equal(rounded(412345.123456789, 300), '412345.1235');
  assert.equal(exact(0.1 + 0.2), '0.3');
});
