// Tiles as they come out of a page, and which of them are drawn.
import assert from 'node:assert/strict';
import test from 'node:test';

import {hills, module, pageOf} from './support.mjs';

const {undoBelowHighest, undoDifferences, ROW} = await module('decode');
const {leafGeometry, sampleGeometry, middleOf} = await module('geometry');
const {makePatch, touch} = await module('patches');
const {pointsOf} = await module('envelope');
const {chooseTiles, distanceTo} = await module('lod');
const {Pace} = await module('pace');

const radius = 1.25, mesh = hills('tiles', 60, 3, 11);
const {page, layers: [surface, terrain]} = await pageOf('tiles', mesh, radius);
const leaves = [...surface.leaves(() => true)];

test('codes of numbers', () => {
  assert.deepEqual([...undoDifferences(Uint32Array.of(10, 1, 0, 7))], [5, 4, 4, 0]);
  assert.deepEqual([...undoBelowHighest(Uint32Array.of(0, 0, 0, 3, 1, 0))], [0, 1, 2, 0, 2, 3]);
});

test('every face is in one leaf', () => {
  let triangles = 0, faces = 0, lines = 0;
  for (const tile of leaves) {
    const leaf = surface.decoded(tile);
    triangles += leaf.corner.length / 3;
    faces += leaf.faceKind.filter(kind => kind < 3).length;
    lines += leaf.lineKind.length;
  }
  assert.equal(triangles, page.layers[0].triangles);
  assert.equal(faces, page.faces.plane + page.faces.cylinder + page.faces.sphere);
  assert.equal(lines, page.edges.seam + page.edges.valley + page.edges.rim);
  assert.ok(leaves.length > 4);
});

test('vertices lie on their patches to within the rounding of the tile', () => {
  for (const tile of leaves) {
    const leaf = surface.decoded(tile), rounding = Math.max(...[0, 1, 2].map(i => tile.high[i] - tile.low[i])) / 65535;
    for (let f = 0; f < leaf.faceKind.length; ++f) {
      if (leaf.featureOf[f] < 0) continue;
      const patch = makePatch(pointsOf(leaf, f), radius);
      for (let c = 3 * leaf.faceFirst[f]; c < 3 * leaf.faceFirst[f + 1]; ++c) {
        const v = leaf.corner[c], off = offOf(patch, [leaf.x[v], leaf.y[v], leaf.z[v]]);
        assert.ok(off < 2 * rounding, `${off} of ${rounding}`);
      }
    }
  }
});

// How far a point is from a patch's plane, cylinder or sphere.
function offOf(patch, p) {
  const w = p.map((v, i) => v - patch.a[i]), dot = q => w.reduce((sum, v, i) => sum + v * q[i], 0);
  if (patch.normal) return Math.abs(dot(patch.normal) - radius);
  const along = patch.direction ? dot(patch.direction) : 0;
  return Math.abs(Math.sqrt(Math.max(0, dot(w) - along * along)) - radius);
}

test('the terrain is there as it was', () => {
  const heights = new Set();
  for (const tile of terrain.leaves(() => true)) terrain.decoded(tile).z.forEach(z => heights.add(z + page.origin[2]));
  for (const z of heights) assert.equal(z * 4, Math.round(z * 4));
  assert.equal(page.layers[1].triangles, 2 * 59 * 59);
});

test('samples are heights of the surface', () => {
  const tile = surface.tiles[0], {z} = surface.decoded(tile);
  assert.ok(tile.sampled);
  let compared = 0;
  for (let row = 1; row < ROW - 1; row += 3) {
    for (let column = 1; column < ROW - 1; column += 3) {
      const x = tile.origin[0] + (column - 1) * tile.cell, y = tile.origin[1] + (row - 1) * tile.cell;
      const highest = Math.max(
          ...leaves.flatMap(t => {
            const leaf = surface.decoded(t), found = [];
            if (x < t.low[0] || x > t.high[0] || y < t.low[1] || y > t.high[1]) return found;
            for (let f = 0; f < leaf.faceKind.length; ++f)
              if (leaf.featureOf[f] >= 0)
                found.push(touch(makePatch(pointsOf(leaf, f), radius), x, y)?.height ?? -Infinity);
            return found;
          }),
          -Infinity);
      const sample = z[row * ROW + column];
      if (Number.isNaN(sample) || highest === -Infinity) continue;
      assert.ok(Math.abs(sample - highest) < 2 * page.maxError, `${sample} ${highest}`);
      ++compared;
    }
  }
  assert.ok(compared > 50);
});

test('arrays for drawing', () => {
  for (const tile of surface.tiles.slice(0, 8)) {
    const data = surface.decoded(tile);
    const {position, normal, mix, index} = tile.leaf ? leafGeometry(data, tile, radius) : sampleGeometry(data, tile);
    const count = position.length / 3;
    assert.equal(normal.length, 4 * count);
    assert.equal(mix.length, 4 * count);
    assert.ok(index.every(i => i < count));
    for (let i = 0; i < count; ++i)
      assert.ok(Math.abs(Math.hypot(...normal.subarray(4 * i, 4 * i + 3)) / 127 - 1) < 0.02);
    const middle = middleOf(tile);
    for (let i = 0; i < 3; ++i) assert.ok(Math.abs(position[i]) <= tile.high[i] - middle[i] + 2 * tile.cell + 1e-4);
  }
});

function choose(options) {
  return chooseTiles(
      surface,
      {eye: [30, 30, 100], pixels: 1000, visible: () => true, ready: () => true, detail: 1, budget: 1e9, ...options});
}
const covers = chosen => {
  const under = tile => chosen.includes(tile) || (!tile.leaf && tile.children.every(i => under(surface.tiles[i])));
  return under(surface.tiles[0]);
};

test('tiles are finer the nearer they are, and cover everything once', () => {
  for (const eye of [[30, 30, 1e5], [30, 30, 300], [0, 0, 10], [30, 30, 3]]) {
    const {chosen, waiting} = choose({eye});
    assert.ok(covers(chosen) && !waiting);
    assert.equal(new Set(chosen).size, chosen.length);
    for (const tile of chosen) {
      let up = surface.tiles.find(t => t.children.includes(tile.index));
      for (; up; up = surface.tiles.find(t => t.children.includes(up.index))) assert.ok(!chosen.includes(up));
    }
  }
  assert.equal(choose({eye: [30, 30, 1e6]}).chosen.length, 1);
  assert.ok(choose({eye: [30, 30, 3]}).chosen.every(tile => tile.leaf));
});

test('a budget is kept to within a tile, and the nearest tiles get it', () => {
  const {chosen} = choose({eye: [0, 0, 6], budget: 12000});
  assert.ok(chosen.length <= 12 && covers(chosen));
  const byDistance = chosen.sort((a, b) => distanceTo(a, [0, 0, 6]) - distanceTo(b, [0, 0, 6]));
  assert.ok(byDistance[0].depth > byDistance[byDistance.length - 1].depth);
});

test('a tile stays until all that replace it are there', () => {
  const there = new Set([surface.tiles[0]]);
  const {chosen, waiting} = choose({ready: tile => there.has(tile)});
  assert.deepEqual(chosen, [surface.tiles[0]]);
  assert.ok(waiting);
});

test('the pace of pictures', () => {
  const pace = new Pace(), before = pace.budget;
  for (let i = 0; i < 30; ++i) pace.took(200);
  assert.ok(pace.budget < before / 3 && pace.scale < 1);
  for (let i = 0; i < 60; ++i) pace.took(16);
  assert.ok(pace.budget > before && pace.scale === 1);
});
