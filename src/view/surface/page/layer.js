// A surface or terrain as its quadtree of tiles, each decoded when it is first asked for.

import {bytesOf, CELLS, decodeLeaf, decodeSamples} from './decode.js';

const COLUMNS = 12;
const MOST_KEPT = 800;  // decoded tiles

export class Layer {
  // text(id): the base64 text of an array of the page.
  constructor(page, description, text) {
    this.role = description.role;
    this.low = description.low;
    this.side = description.side;
    this.triangles = description.triangles;
    this.text = text;
    this.kept = new Map();
    const table = new Float64Array(bytesOf(text(description.tiles)).buffer);
    this.tiles = [];
    for (let i = 0; i * COLUMNS < table.length; ++i) {
      const [depth, column, row, firstChild, children, faces, ...box] = table.subarray(i * COLUMNS, (i + 1) * COLUMNS);
      const leaf = children === 0, sampled = !leaf && depth < description.sampledLevels;
      const side = this.side / 2 ** depth;
      this.tiles.push({
        index: i,
        depth,
        leaf,
        sampled,
        faces,
        low: Array.from(box.slice(0, 3)),
        high: Array.from(box.slice(3)),
        origin: [this.low[0] + column * side, this.low[1] + row * side],
        side,
        cell: side / CELLS,
        children: Array.from({length: children}, (_, k) => firstChild + k)
      });
    }
    this.exact = description.role === 'terrain';
  }

  get low3() { return this.tiles[0].low; }
  get high3() { return this.tiles[0].high; }

  // The arrays of a leaf or of samples; the oldest ones are forgotten.
  decoded(tile) {
    let data = this.kept.get(tile.index);
    if (data) {
      this.kept.delete(tile.index);
    } else {
      const packed = bytesOf(this.text(`${this.role}-${tile.index}`));
      data = tile.leaf ? decodeLeaf(packed, tile, this.exact) : decodeSamples(packed);
      if (this.kept.size >= MOST_KEPT) this.kept.delete(this.kept.keys().next().value);
    }
    this.kept.set(tile.index, data);
    return data;
  }

  // Leaves whose box may meet something: goes down where meets(tile) is true.
  * leaves(meets, index = 0) {
    const tile = this.tiles[index];
    if (!meets(tile)) return;
    if (tile.leaf)
      yield tile;
    else
      for (const child of tile.children) yield* this.leaves(meets, child);
  }
}
