// The tiles of a layer as meshes and lines in the scene, made when they are first wanted, a few milliseconds a frame.

import * as THREE from 'three';

import {leafGeometry, leafLines, middleOf, sampleGeometry} from './geometry.js';
import {Lines} from './lines.js';
import {chooseTiles, distanceTo} from './lod.js';

const MOST_KEPT = 1200;  // meshes
const FIRST_LINES = 6;   // pixels of a face at which its lines begin to show
const FULL_LINES = 24;   // and at which they are as strong as they get

// Side of a square as large as the faces of a tile are on average.
function sizeOfFaces(tile) {
  return Math.sqrt((tile.high[0] - tile.low[0]) * (tile.high[1] - tile.low[1]) / tile.faces);
}

export class TileSet {
  // lineMaterials: by kind of line, from faint to strong.
  constructor(layer, radius, material, lineMaterials) {
    Object.assign(this, {layer, radius, material, lineMaterials});
    this.group = new THREE.Group();
    this.meshes = new Map();  // by index of the tile: { mesh, lines, arrays, used }
    this.lineKinds = [true, true, true];
    this.chosen = [];
    this.meanFace = sizeOfFaces(layer.tiles[0]);
    this.until = 0;  // no new meshes after this time
    this.clock = 0;
  }

  ready(tile) {
    let made = this.meshes.get(tile.index);
    if (!made) {
      if (performance.now() > this.until) return false;
      this.meshes.set(tile.index, made = this.make(tile));
    }
    made.used = this.clock;
    return true;
  }

  make(tile) {
    const data = this.layer.decoded(tile);
    const arrays = tile.leaf ? leafGeometry(data, tile, this.radius) : sampleGeometry(data, tile);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(arrays.position, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(arrays.normal, 4, true));
    geometry.setAttribute('mix4', new THREE.BufferAttribute(arrays.mix, 4, true));
    geometry.setIndex(new THREE.BufferAttribute(arrays.index, 1));
    const mesh = new THREE.Mesh(geometry, this.material);
    mesh.position.fromArray(middleOf(tile));
    mesh.frustumCulled = false;  // chooseTiles has done that
    mesh.matrixAutoUpdate = false;
    mesh.updateMatrix();
    return {mesh, arrays, lines: null, used: this.clock};
  }

  linesOf(tile, made) {
    if (made.lines) return made.lines;
    made.lines = leafLines(this.layer.decoded(tile), tile).map((points, kind) => {
      if (points.length === 0) return null;
      const lines = new Lines(this.lineMaterials[kind][0], 1 + kind);
      lines.replace(points);
      lines.position.fromArray(middleOf(tile));
      return lines;
    });
    return made.lines;
  }

  // view: as for chooseTiles, and lineBudget. Returns what is drawn.
  update(view, milliseconds) {
    ++this.clock;
    this.until = performance.now() + milliseconds;
    const {chosen, waiting} = chooseTiles(this.layer, {...view, ready: tile => this.ready(tile)});
    this.chosen = chosen;
    this.group.clear();
    let triangles = 0, segments = 0;
    for (const tile of chosen) {
      const made = this.meshes.get(tile.index);
      this.group.add(made.mesh);
      triangles += made.arrays.index.length / 3;
    }
    if (this.lineMaterials) segments = this.addLines(view, chosen);
    this.forget();
    return {tiles: chosen.length, triangles, segments, waiting};
  }

  // Lines of the largest faces first.
  addLines(view, chosen) {
    let segments = 0;
    const sized = chosen.filter(tile => tile.leaf)
                      .map(tile => {
                        // Between the tile's own and the mean one, so that neighbours do not differ too much.
                        const face = sizeOfFaces(tile) ** 0.7 * this.meanFace ** 0.3;
                        return {tile, size: view.pixels * face / Math.max(distanceTo(tile, view.eye), face)};
                      })
                      .filter(({size}) => size > FIRST_LINES)
                      .sort((a, b) => b.size - a.size);
    for (const {tile, size} of sized) {
      if (segments > view.lineBudget) break;
      this.linesOf(tile, this.meshes.get(tile.index)).forEach((lines, kind) => {
        if (!lines || !this.lineKinds[kind]) return;
        const materials = this.lineMaterials[kind],
              share = Math.min(1, (size - FIRST_LINES) / (FULL_LINES - FIRST_LINES));
        lines.material = materials[Math.round(share * (materials.length - 1))];
        this.group.add(lines);
        segments += lines.geometry.index.count / 6;
      });
    }
    return segments;
  }

  forget() {
    if (this.meshes.size <= MOST_KEPT) return;
    const old = [...this.meshes].filter(([, made]) => made.used < this.clock).sort((a, b) => a[1].used - b[1].used);
    for (const [index, made] of old.slice(0, this.meshes.size - MOST_KEPT)) {
      made.mesh.geometry.dispose();
      for (const lines of made.lines ?? []) lines?.geometry.dispose();
      this.meshes.delete(index);
    }
  }
}
