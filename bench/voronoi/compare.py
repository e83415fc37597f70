#!/usr/bin/env python3
"""Runs voronoi_case over data, sizes and engines, each case in a process of its own with a time limit, and writes the
table of bench/README.md: segment Voronoi diagrams by krepl, Boost.Polygon and CGAL.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import cases  # noqa: E402
from cases import machine, table  # noqa: E402

PACKAGES = ["libboost-dev", "libcgal-dev", "g++", "libtbb-dev"]
FILES = ["river_new_hope_epsg32617_mm", "river_methow", "roads_monaco_epsg32632_mm", "ne_10m_rivers_europe_epsg3035_m",
         "ne_10m_railroads_north_america", "streets_tempe"]


class Bench(cases.Bench):
    def case(self, engine, data, segments):
        name = Path(data).stem
        return self.measure(f"{engine:6} {name:34} n={segments or 'all'}", {"engine": engine, "data": name},
                            [engine, data, segments])


def cell(result, own=None):
    """Microseconds per segment (bytes per segment), and how many times krepl's time."""
    if result is None:
        return "–"
    if "failed" in result:
        return result["failed"]
    n = result["segments"]
    text = f"{1e6 * result['cpu'] / n:.3g} ({result['bytes'] / n:.0f})"
    return text + (f" ×{result['cpu'] / n / (own['cpu'] / own['segments']):.3g}" if own and "cpu" in own else "")


def row(name, own, boost=None, cgal=None):
    if "failed" in own:
        return [name, "", own["failed"], cell(boost), cell(cgal), "", ""]
    return [name, f"{own['segments']:,}", cell(own), cell(boost, own), cell(cgal, own),
            f"{1e6 * own['radius'] / own['segments']:.3g}" if "radius" in own else "", f"{100 * own['again'] / own['faces']:.2g} %"]


def main():
    arguments = cases.bench_arguments(__doc__, "voronoi_case", "10000,100000,1000000").parse_args()
    about, bench, rows = machine(PACKAGES), Bench(arguments), []
    sizes = [int(size) for size in arguments.sizes.split(",")]
    for size in sizes:
        rows.append(row("meanders", *(bench.case(e, "meanders", size) for e in ("krepl", "boost", "cgal"))))
    if arguments.world and arguments.world.exists():
        rows += [row("world_rivers", bench.case("krepl", arguments.world, size)) for size in sizes]
    for size in sizes[:2]:
        rows.append(row("street grid", *(bench.case(e, "grid", size) for e in ("krepl", "boost", "cgal"))))
        rows.append(row("outlines of pixels", *(bench.case(e, "pixels", size) for e in ("krepl", "boost", "cgal"))))
    for path in (arguments.data / f"{name}.wkt" for name in FILES):
        if path.exists():
            rows.append(row(path.stem, bench.case("krepl", path, 0)))
    with open(arguments.output, "w") as out:
        out.write(f"{about}\n\nMicroseconds of CPU time per segment on one thread (bytes per segment, the peak of the operation), "
                  "× = times krepl's; – = not run: these lines cross or touch, or are no integers. Extraction: one radius "
                  "out of the diagram, the mean of ten from 0.2 to 2 mean segment lengths.\n\n")
        out.write(table(["data", "segments", "krepl", "Boost.Polygon", "CGAL", "extraction, µs", "faces done again"], rows) + "\n")


if __name__ == "__main__":
    main()
