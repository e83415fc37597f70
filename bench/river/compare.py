#!/usr/bin/env python3
"""Runs river_case over data, sizes and engines, each case in a process of its own with a time limit, and writes the table
of bench/README.md: rivers taken apart by krepl, their lines cut and merged by GEOS.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import cases  # noqa: E402
from cases import machine, table  # noqa: E402

PACKAGES = ["libgeos-dev", "g++", "libtbb-dev"]
FILES = ["river_walker", "river_new_hope_epsg32617_mm", "river_methow", "ne_10m_rivers_europe_epsg3035_m"]


class Bench(cases.Bench):
    def case(self, engine, path, segments):
        name = path.stem
        return self.measure(f"{engine:6} {name:34} n={segments or 'all'}", {"engine": engine, "data": name},
                            [engine, path, segments])


def row(name, own, peer):
    if "failed" in own:
        return [name, "", own["failed"]] + [""] * 5
    n = own["segments"]
    each = own["cpu"] / n
    other = peer["failed"] if "failed" in peer else \
        f"{1e6 * peer['cpu'] / n:.3g} ({peer['bytes'] / n:.0f}) ×{peer['cpu'] / n / each:.3g}"
    return [name, f"{n:,}", f"{1e6 * each:.3g} ({own['bytes'] / n:.0f})", other, f"{1e6 * own['zones'] / n:.3g}",
            f"{own['crossings']:,}", f"{own['reaches']:,}", f"{own['sub_rivers']:,}"]


def main():
    arguments = cases.bench_arguments(__doc__, "river_case", "10000,100000,1000000").parse_args()
    about, bench, rows = machine(PACKAGES), Bench(arguments), []
    runs = [(arguments.data / f"{name}.wkt", 0) for name in FILES]
    if arguments.world and arguments.world.exists():
        runs += [(arguments.world, int(size)) for size in arguments.sizes.split(",")]
    for path, size in runs:
        if path.exists():
            rows.append(row(path.stem, bench.case("krepl", path, size), bench.case("geos", path, size)))
    with open(arguments.output, "w") as out:
        out.write(f"{about}\n\nMicroseconds of CPU time per segment of the input on one thread (bytes per segment, the peak of the "
                  "operation), × = times krepl's. krepl cuts the lines where they meet, directs them to guessed outlets, and takes them "
                  "apart into sub-rivers with orders and main stems; GEOS cuts and merges (`GEOSNode`, `GEOSLineMerge`). Zones: "
                  "of every sub-river on its own, R one mean segment length.\n\n")
        head = ["data", "segments", "krepl", "GEOS: reaches only", "zones, µs", "cuts", "reaches", "sub-rivers"]
        out.write(table(head, rows) + "\n")


if __name__ == "__main__":
    main()
