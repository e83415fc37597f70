#!/usr/bin/env python3
"""Runs terrain_case over terrains, radii and ways, each case in a process of its own with a time limit, and writes the
tables of bench/README.md: the surface, its growth with the number of triangles, the drop cutter, and peers beside both.
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import cases  # noqa: E402
from cases import machine, table  # noqa: E402

CELLS = {"jacksboro": 92, "bigtujunga": 30}  # sizes of their cells; the first is in degrees in its file
RADII = [1, 3, 10, 30]
STEPS = [1 / 8, 1 / 32]  # of peers, in radii
GROWTH = [10_000, 100_000, 1_000_000]
PACKAGES = ["libopenvdb-dev", "g++", "libtbb-dev"]


class Terrain:
    def __init__(self, name, source, cell=0, form="grid"):
        self.name, self.source, self.cell, self.form = name, str(source), cell, form

    def title(self, result):
        count = f" ({result['triangles']:,})" if "triangles" in result else ""
        return self.name + (" as a mesh" if self.form == "mesh" else "") + count


class Bench(cases.Bench):
    def __init__(self, arguments):
        super().__init__(arguments)
        self.radii, self.growth = arguments.radii, arguments.growth
        self.given_up = set()

    def case(self, operation, terrain, radius, step=1.0, threads=1):
        record = {"operation": operation, "terrain": terrain.name, "form": terrain.form, "radius_cells": radius, "step": step,
                  "threads": threads}
        title = f"{operation:9} {terrain.name:16} {terrain.form} R={radius:<4g} step={step:g} threads={threads}"
        return self.measure(title, record, [operation, terrain.source, terrain.form, terrain.cell, repr(radius), repr(step),
                                            threads, 1])

    def peer(self, operation, terrain, radius, step):
        """None where a coarser step was too much already."""
        if any((operation, terrain.name, radius, s) in self.given_up for s in STEPS):
            return None
        result = self.case(operation, terrain, radius, step)
        if "failed" in result:
            self.given_up.add((operation, terrain.name, radius, step))
        return result


def per(result, unit, what="cpu"):
    """Microseconds per triangle or point."""
    return result["failed"] if "failed" in result else f"{1e6 * result[what] / result[unit]:.3g}"


def with_error(result, unit):
    """The same, with the largest error in radii."""
    if result is None:
        return "–"
    error = "" if "failed" in result else f" ({result['largest_error'] / result['radius']:.1e})"
    return per(result, unit) + error


def surface_rows(bench, terrains):
    rows = []
    for terrain in terrains:
        for radius in bench.radii:
            one, every = bench.case("surface", terrain, radius), bench.case("surface", terrain, radius, threads=0)
            peers = [bench.peer("openvdb", terrain, radius, step) for step in STEPS]
            failed = "failed" in one
            rows.append([terrain.title(one) if radius == bench.radii[0] else "", f"{radius:g}", per(one, "triangles"),
                         per(every, "triangles", "wall"),
                         "" if failed else f"{one['vertices']:,} / {one['edges']:,} / {one['faces']:,}",
                         "" if failed else f"{one['bytes'] / one['triangles']:.0f}",
                         *(with_error(p, "triangles") for p in peers)])
    return rows


def growth_rows(bench):
    rows = []
    for size in bench.growth:
        one, every = (bench.case("surface", Terrain(f"made {size}", f"made:{size}"), 3, threads=t) for t in (1, 0))
        failed = "failed" in one or "failed" in every
        rows.append([f"{one.get('triangles', size):,}", per(one, "triangles"), per(every, "triangles", "wall"),
                     "" if failed else f"{one['wall'] / every['wall']:.2f}",
                     "" if failed else f"{one['bytes'] / one['triangles']:.0f}",
                     "" if failed else f"{every['bytes'] / every['triangles']:.0f}"])
    return rows


def drop_rows(bench, terrains):
    rows = []
    for terrain in terrains:
        for radius in bench.radii:
            first = radius == bench.radii[0]
            build = bench.case("build", terrain, radius) if first else None
            ways = [bench.case(way, terrain, radius) for way in ("quarters", "cells", "list", "single")]
            peers = [bench.peer("dilation", terrain, radius, step) if terrain.form == "grid" else None for step in STEPS]
            rows.append([terrain.title(build) if first else "", f"{radius:g}", per(build, "triangles") if first else "",
                         *(per(way, "points") for way in ways), *(with_error(p, "points") for p in peers)])
    return rows


def write_tables(out, about, surface, grown, drop, limit):
    out.write(f"{about}\n\n")
    if surface:
        out.write("Surface: microseconds per triangle, CPU time on one thread and wall time on all; bytes are the peak of the "
                  "operation on one thread. OpenVDB: microseconds of CPU time per triangle (largest error of a height, in "
                  f"radii), by the distance of its voxels; – = not run, the coarser one took over {limit:g} s or too much "
                  "memory.\n\n")
        out.write(table(["terrain (triangles)", "R in cells", "krepl, 1 thread", "all threads", "vertices / edges / faces",
                         "bytes/triangle", *(f"OpenVDB R/{1 / s:g}" for s in STEPS)], surface) + "\n\n")
    if grown:
        out.write("Growth: corners of one made terrain, R = 3 cells.\n\n")
        out.write(table(["triangles", "µs/triangle, 1 thread", "all threads, wall", "speed-up", "bytes/triangle, 1 thread",
                         "all threads"], grown) + "\n\n")
    if drop:
        out.write("Drop cutter: microseconds of CPU time per place on one thread. Rasters of four places a cell side and of "
                  "one, in bulk; random places, in bulk and one by one; the hierarchy, per triangle. Grey dilation of the "
                  "samples by a sampled ball: the same per sample (largest error, in radii), by the distance of samples, which "
                  "is a cell at most; – = not run.\n\n")
        out.write(table(["terrain (triangles)", "R in cells", "hierarchy", "raster, ¼ cell", "raster, 1 cell", "random, bulk",
                         "random, single", *(f"dilation R/{1 / s:g}" for s in STEPS)], drop) + "\n")


def numbers(text):
    return [int(x) if float(x) == int(x) else float(x) for x in (float(part) for part in text.split(","))]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True, help="the built terrain_case")
    parser.add_argument("--data", type=Path, required=True, help="directory of ASCII grids")
    parser.add_argument("--limit", type=float, default=120, help="seconds a case may take (default: 120)")
    parser.add_argument("--radii", type=numbers, default=RADII, help="in cells")
    parser.add_argument("--made", type=int, default=1_000_000, help="triangles of the made terrain")
    parser.add_argument("--growth", type=numbers, default=GROWTH, help="triangles of the growth table")
    parser.add_argument("--only", default="surface,growth,drop", help="which tables to make")
    parser.add_argument("--log", type=Path, required=True, help="every measurement as a line of JSON")
    parser.add_argument("--output", type=Path, required=True, help="the tables in Markdown")
    arguments = parser.parse_args()
    about, bench = machine(PACKAGES), Bench(arguments)
    terrains = []
    for name, cell in CELLS.items():
        path = arguments.data / f"{name}.asc"
        if path.exists():
            terrains.append(Terrain(name, path, cell))
        else:
            print(f"compare.py: {name} is not in {arguments.data} and left out", file=sys.stderr)
    terrains.append(Terrain("made", f"made:{arguments.made}"))
    meshes = [Terrain(t.name, t.source, t.cell, "mesh") for t in terrains[:1]]
    only = arguments.only.split(",")
    surface = surface_rows(bench, terrains) if "surface" in only else []
    grown = growth_rows(bench) if "growth" in only else []
    drop = drop_rows(bench, terrains + meshes) if "drop" in only else []
    with open(arguments.output, "w") as out:
        write_tables(out, about, surface, grown, drop, arguments.limit)


if __name__ == "__main__":
    main()
