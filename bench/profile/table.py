#!/usr/bin/env python3
"""Turns the JSON of profile_bench into Markdown.

usage: table.py RESULTS.json >TABLE.md
"""
import json
import math
import re
import sys

WAYS = [("one", "one thread"), ("all", "all threads"), ("stream", "stream"), ("bytes", "moving the bytes")]
NAME = re.compile(r"profile/(\w+)/(\w+)/R:([^/]+)/n:([^/]+)")


def nanoseconds(run):
    """Per segment: CPU time of one thread; wall time where several work."""
    unit = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[run["time_unit"]]
    time = run["real_time"] if run["name"].startswith("profile/all/") else run["cpu_time"]
    return time * unit / float(NAME.match(run["name"]).group(4))


def power(n):
    return "1e%d" % round(math.log10(float(n)))


def row(cells):
    return "| " + " | ".join(cells) + " |"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        data = json.load(file)
    runs = {}
    for run in data["benchmarks"]:
        match = NAME.match(run["name"])
        if match and not run.get("error_occurred"):
            runs.setdefault(match.groups(), run)
    context = data["context"]
    print(f"{context['num_cpus']} cores at {context['mhz_per_cpu'] / 1000:.1f} GHz (nominal), load "
          f"{context['load_avg'][0]:.1f}. ns per segment; CPU time, but wall time for all threads.\n")

    print("Rough terrain:\n")
    print(row(["segments", "R", *[label for _, label in WAYS], "speed-up", "pieces", "pops", "largest stack"]))
    print("|" + "---|" * (len(WAYS) + 6))
    sizes = sorted({(float(n), float(r), n, r) for way, kind, r, n in runs if way == "all" and kind == "rough"})
    for _, _, n, r in sizes:
        one, times = runs["one", "rough", r, n], {}
        for way, _ in WAYS:
            if (way, "rough", r, n) in runs:
                times[way] = nanoseconds(runs[way, "rough", r, n])
        cells = [f"{times[way]:.1f}" if way in times else "-" for way, _ in WAYS]
        unit = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[one["time_unit"]]
        wall = one["real_time"] * unit / float(n)
        print(row([power(n), r, *cells, f"{wall / times['all']:.2f}", f"{one['pieces_per_segment']:.2f}",
                   f"{one['pops_per_segment']:.2f}", f"{one['stack']:.0f}"]))

    radii = sorted({r for way, kind, r, n in runs if kind == "flat"}, key=float)
    print("\nKinds of terrain, 1e6 segments, one thread (pieces per segment; share decided with twice the digits):\n")
    print(row(["terrain", *[f"R = {r}" for r in radii]]))
    print("|" + "---|" * (len(radii) + 1))
    for kind in dict.fromkeys(kind for _, kind, _, _ in runs):
        cells = []
        for r in radii:
            run = next((v for (way, k, rr, n), v in runs.items()
                        if way == "one" and k == kind and rr == r and power(n) == "1e6"), None)
            cells.append(f"{nanoseconds(run):.1f} ({run['pieces_per_segment']:.2f}; {run['higher_precision']:.2f})"
                         if run else "-")
        print(row([kind, *cells]))


if __name__ == "__main__":
    main()
