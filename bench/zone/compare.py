#!/usr/bin/env python3
"""Runs zone_case over data, radii and engines, each case in a process of its own with a time limit, and writes the tables
of bench/README.md: krepl beside its peers on one thread, how far their answers are from krepl's, and growth with n.
"""
import itertools
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import cases  # noqa: E402
from cases import machine, table  # noqa: E402

FILES = ["streets_tempe", "roads_roxel_epsg32632_mm", "river_new_hope_epsg32617_mm", "river_methow",
         "roads_monaco_epsg32632_mm", "ne_10m_rivers_europe_epsg3035_m"]
RADII = [1, 10, 100]
PEERS = [("geos", 1e-3), ("geos", 1e-6), ("clipper", 1e-3), ("clipper", 1e-6), ("boost", 1e-3)]
NAMES = {"krepl": "krepl", "geos": "GEOS", "clipper": "Clipper", "boost": "Boost"}
PACKAGES = ["libgeos-dev", "libpolyclipping-dev", "libboost-dev", "g++", "libtbb-dev"]
BOOST_LIMIT = 20_000  # vertices; above, Boost never finishes within the time limit


class Bench(cases.Bench):
    def case(self, engine, path, radius, chord=1e-3, segments=0, threads=1, runs=1):
        record = {"engine": engine, "data": path.stem, "radius_lengths": radius, "chord": chord, "threads": threads}
        title = f"{engine:8} {path.stem:34} n={segments or 'all':>8} R={radius:<4g} chord={chord:g} threads={threads}"
        return self.measure(title, record, [engine, path, segments, repr(radius), repr(chord), threads, runs])


def cell(result, own=None):
    """Microseconds per input vertex (peak MB of the operation), and how many times krepl's time."""
    if result is None:
        return "–"
    if "failed" in result:
        return f"{result['failed']} ({result['peak'] / 1e6:.0f})"
    text = f"{1e6 * result['cpu'] / result['vertices']:.3g} ({result['bytes'] / 1e6:.0f})"
    return text + (f" ×{result['cpu'] / own['cpu']:.3g}" if own and "cpu" in own else "")


def difference(result, own):
    """Relative difference of the area from krepl's, and the number of holes."""
    if result is None or "failed" in result or "failed" in own:
        return "–"
    return f"{result['area'] / own['area'] - 1:+.1e}, {result['holes']}"


def vertices(path):
    """Of a WKT or GMT text."""
    with open(path) as lines:  # line by line: a child's peak memory starts from this process's
        first = next(lines)
        if first.startswith(">"):
            return sum(not line.startswith(">") for line in lines)
        return sum(line.count(",") + line.count("(") for line in itertools.chain([first], lines))


def growth_row(radius, size, one, two):
    if "failed" in one or "failed" in two:
        return [f"×{radius}", f"{size:,}", one.get("failed", ""), two.get("failed", ""), "", "", ""]
    return [f"×{radius}", f"{size:,}", f"{1e6 * one['wall'] / size:.3f}", f"{1e6 * two['wall'] / size:.3f}",
            f"{one['wall'] / two['wall']:.2f}", f"{one['bytes'] / size:.0f}", f"{two['bytes'] / size:.0f}"]


def compare(bench, paths):
    speed, answers = [], []
    for path in paths:
        given_up, count = set(), vertices(path)
        for radius in RADII:
            own = bench.case("krepl", path, radius)
            results = {}
            for engine, chord in PEERS:
                # GEOS at the coarse chord is always run; the others not again where they were hopeless already.
                hopeless = any(e == engine and c >= chord for e, c in given_up) and (engine, chord) != ("geos", 1e-3)
                if hopeless or (engine == "boost" and count > BOOST_LIMIT):
                    results[engine, chord] = None
                    continue
                results[engine, chord] = bench.case(engine, path, radius, chord)
                if "failed" in results[engine, chord]:
                    given_up.add((engine, chord))
            name = f"{path.stem} ({count:,})" if radius == RADII[0] else ""
            speed.append([name, f"×{radius}", cell(own), *(cell(results[p], own) for p in PEERS)])
            answers.append([name, f"×{radius}", "failed" if "failed" in own else f"{own['area']:.9g}, {own['holes']}",
                            *(difference(results[p], own) for p in PEERS)])
    return speed, answers


def growth(bench, path, sizes):
    rows = []
    for radius in RADII:
        for size in sizes:
            one = bench.case("krepl", path, radius, segments=size, runs=4)
            two = bench.case("krepl", path, radius, segments=size, threads=2, runs=4)
            rows.append(growth_row(radius, size, one, two))
    return rows


def write_tables(out, about, speed, answers, grown, limit):
    peers = [f"{NAMES[engine]} {chord:g} R" for engine, chord in PEERS]
    out.write(f"{about}\n\n")
    if speed:
        out.write("Microseconds of CPU time per input vertex on one thread, the operation alone (peak memory of the operation, "
                  f"MB), × = times krepl's; – = not run, a smaller radius or coarser chord already took over {limit:g} s "
                  f"or (Boost) over {BOOST_LIMIT:,} vertices.\n\n")
        out.write(table(["data (vertices)", "R in mean lengths", "krepl, true arcs", *peers], speed) + "\n\n")
        out.write("Do they answer the same question? Area and holes; for the peers the relative difference from "
                  "krepl's area.\n\n")
        out.write(table(["data (vertices)", "R in mean lengths", "krepl: area, holes", *peers], answers) + "\n\n")
    if grown:
        out.write("Growth: the world's rivers cut or repeated to n segments, wall time of the fastest of at least four "
                  "runs; bytes are the peak of the operation.\n\n")
        out.write(table(["R in mean lengths", "segments", "µs/segment, 1 thread", "2 threads", "speed-up",
                         "bytes/segment, 1 thread", "2 threads"], grown) + "\n")


def main():
    parser = cases.bench_arguments(__doc__, "zone_case", "100000,1000000,10000000")
    parser.add_argument("--only", default="compare,growth", help="which tables to make")
    arguments = parser.parse_args()
    about, bench = machine(PACKAGES), Bench(arguments)
    paths = [p for p in (arguments.data / f"{name}.wkt" for name in FILES) if p.exists()]
    for name in sorted(set(FILES) - {p.stem for p in paths}):
        print(f"compare.py: {name} is not in {arguments.data} and left out", file=sys.stderr)
    speed = answers = grown = []
    if "compare" in arguments.only:
        speed, answers = compare(bench, paths + ([arguments.world] if arguments.world else []))
    if "growth" in arguments.only and arguments.world:
        grown = growth(bench, arguments.world, [int(size) for size in arguments.sizes.split(",")])
    with open(arguments.output, "w") as out:
        write_tables(out, about, speed, answers, grown, arguments.limit)


if __name__ == "__main__":
    main()
