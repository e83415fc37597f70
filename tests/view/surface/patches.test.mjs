// The closed forms of planes, cylinders and spheres against the definition: the ball touches, and does not cut.
import assert from 'node:assert/strict';
import test from 'node:test';

import {module, randomFrom} from './support.mjs';

const {makePatch, touch, normalAt} = await module('patches');

const minus = (a, b) => a.map((v, i) => v - b[i]);
const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);

// Distance of a point from a segment, triangle or point, by clamping and brute force on the triangle's sides.
function distance(p, points) {
  const toSegment = (a, b) => {
    const d = minus(b, a), t = Math.min(1, Math.max(0, dot(minus(p, a), d) / dot(d, d)));
    return Math.hypot(...minus(p, a.map((v, i) => v + t * d[i])));
  };
  if (points.length === 1) return Math.hypot(...minus(p, points[0]));
  if (points.length === 2) return toSegment(...points);
  const [a, b, c] = points, u = minus(b, a), v = minus(c, a);
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const inside = [[a, b], [b, c], [c, a]].every(([q, r]) => {
    const d = minus(r, q), w = minus(p, q);
    return dot([d[1] * w[2] - d[2] * w[1], d[2] * w[0] - d[0] * w[2], d[0] * w[1] - d[1] * w[0]], n) >= 0;
  });
  const sides = Math.min(toSegment(a, b), toSegment(b, c), toSegment(c, a));
  return inside ? Math.min(sides, Math.abs(dot(minus(p, a), n)) / Math.hypot(...n)) : sides;
}

for (const count of [1, 2, 3]) {
  test(`a ball over a feature of ${count} points touches it`, () => {
    const random = randomFrom(count);
    let touched = 0;
    for (let i = 0; i < 3000; ++i) {
      const points = Array.from({length: count}, () => [0, 0, 0].map(() => 4 * random() - 2)),
            radius = 0.2 + 2 * random();
      const patch = makePatch(points, radius), x = 4 * random() - 2, y = 4 * random() - 2, hit = touch(patch, x, y);
      if (!hit) continue;
      ++touched;
      const center = [x, y, hit.height];
      assert.ok(
          Math.abs(Math.hypot(...minus(center, hit.at)) - radius) < 1e-9 * radius, 'the contact is at the radius');
      assert.ok(Math.abs(distance(center, points) - radius) < 1e-9, 'and nothing is nearer');
      assert.ok(distance(hit.at, points) < 1e-7, 'the contact is on the feature');
      const n = normalAt(patch, ...center, [0, 0, 0]);
      minus(center, hit.at).forEach((v, k) => assert.ok(Math.abs(v - radius * n[k]) < 1e-7 * radius));
    }
    assert.ok(touched > 100);
  });
}

test('beyond its reach a feature is not touched', () => {
  assert.equal(touch(makePatch([[0, 0, 5]], 1), 1.001, 0), null);
  assert.ok(Math.abs(touch(makePatch([[0, 0, 5]], 1), 1, 0).height - 5) < 1e-12);
  assert.equal(touch(makePatch([[0, 0, 0], [4, 0, 0]], 1), -0.001, 0), null);
  assert.equal(touch(makePatch([[0, 0, 0], [0, 0, 4]], 1), 0, 0), null, 'an upright edge has no cylinder above it');
  assert.equal(touch(makePatch([[0, 0, 0], [4, 0, 0], [0, 4, 0]], 1), 2.1, 2.1), null);
});
