#!/usr/bin/env python3
"""Runs river_case over data, sizes and engines, each case in a process of its own with a time limit, and writes the table
of bench/README.md: rivers taken apart by krepl, their lines cut and merged by GEOS.
"""
import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from cases import machine, run_case, table  # noqa: E402

PACKAGES = ["libgeos-dev", "g++", "libtbb-dev"]
FILES = ["river_walker", "river_new_hope_epsg32617_mm", "river_methow", "ne_10m_rivers_europe_epsg3035_m"]


class Bench:
    def __init__(self, arguments):
        self.program, self.limit = arguments.program.resolve(), arguments.limit
        self.log = open(arguments.log, "w")

    def case(self, engine, path, segments):
        print(f"  {engine:6} {path.stem:34} n={segments or 'all'}", file=sys.stderr, flush=True)
        result = run_case(self.program, self.limit, [engine, path, segments])
        self.log.write(json.dumps({"engine": engine, "data": path.stem, **result}) + "\n")
        self.log.flush()
        return result


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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True, help="the built river_case")
    parser.add_argument("--data", type=Path, required=True, help="directory of WKT files")
    parser.add_argument("--world", type=Path, help="GMT text of the world's rivers")
    parser.add_argument("--sizes", default="10000,100000,1000000", help="segments of the rows that grow")
    parser.add_argument("--limit", type=float, default=120, help="seconds a case may take (default: 120)")
    parser.add_argument("--log", type=Path, required=True, help="every measurement as a line of JSON")
    parser.add_argument("--output", type=Path, required=True, help="the table in Markdown")
    arguments = parser.parse_args()
    about, bench, rows = machine(PACKAGES), Bench(arguments), []
    cases = [(arguments.data / f"{name}.wkt", 0) for name in FILES]
    if arguments.world and arguments.world.exists():
        cases += [(arguments.world, int(size)) for size in arguments.sizes.split(",")]
    for path, size in cases:
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
