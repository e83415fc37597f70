#!/usr/bin/env python3
"""Makes the table of free space in bench/README.md: clearances of placements in the plane and over terrains."""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from cases import machine, run_case, table  # noqa: E402

PLANE = ["streets_tempe", "river_new_hope_epsg32617_mm", "roads_monaco_epsg32632_mm", "ne_10m_rivers_europe_epsg3035_m"]
CELLS = {"jacksboro.asc": 92, "bigtujunga.asc": 30}  # sizes of their cells; the first is in degrees in its file
TERRAIN = ["jacksboro.asc", "bigtujunga.asc", "made:1000000"]
MANY, FEW = 100000, 50  # placements; for brute force


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="free_case")
    parser.add_argument("--vector", type=Path, required=True, help="directory of WKT files")
    parser.add_argument("--grids", type=Path, required=True, help="directory of ESRI ASCII grids")
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--output", type=Path, required=True, help="the table in Markdown")
    a = parser.parse_args()

    def measure(where, way, source, radius, places):
        print(f"  {where} {way} {source} x{radius}", file=sys.stderr)
        return run_case(a.program, a.limit, [where, way, source, CELLS.get(Path(source).name, 0), radius, places])

    def cost(case, ours):
        if "failed" in case:
            return case["failed"]
        micros = 1e6 * case["cpu"] / case["places"]
        return f"{micros:.3g}" if case is ours else f"{micros:.3g} ×{micros / (1e6 * ours['cpu'] / ours['places']):.3g}"

    def difference(case, ours):
        """Of the clearances that both tell, relative to the radius."""
        return max((abs(p - q) for p, q in zip(case["first"], ours["first"])), default=0) / ours["radius"] if "first" in case else 0

    rows = []
    for where, names, radii in (("plane", PLANE, (1, 10)), ("terrain", TERRAIN, (1, 10))):
        for name in names:
            source = name if name.startswith("made:") else str((a.vector / (name + ".wkt")) if where == "plane" else a.grids / name)
            if not name.startswith("made:") and not Path(source).exists():
                print(f"compare.py: {source} is not there and left out", file=sys.stderr)
                continue
            for radius in radii:
                ours = measure(where, "krepl", source, radius, MANY)
                if "failed" in ours:
                    continue
                brute = measure(where, "brute", source, radius, FEW)
                geos = measure(where, "geos", source, radius, MANY) if where == "plane" else None
                parts = measure(where, "components", source, radius, MANY) if where == "plane" else None
                off = max(difference(case, ours) for case in (brute, geos) if case)
                rows.append([f"{name.removesuffix('.asc')} ({ours['items']:,})", f"×{radius}", f"{100 * ours['free'] / ours['places']:.0f} %",
                             cost(ours, ours), cost(geos, ours) if geos else "–", cost(brute, ours), cost(parts, ours) if parts else "–",
                             f"{off:.1e}"])
    head = ["segments or triangles", "R in mean lengths or cells", "free", "krepl", "GEOS, prepared", "brute force", "krepl, components",
            "largest difference / R"]
    with open(a.output, "w") as out:
        out.write(machine(["libgeos-dev", "g++"]) + "\n\n" + table(head, rows) + "\n")


if __name__ == "__main__":
    main()
