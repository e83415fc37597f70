#!/usr/bin/env python3
"""Makes the table of tool paths in bench/README.md: krepl mill from file to G-code on one thread, CPU time of the process."""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from cases import machine, table  # noqa: E402

# Part, longest side, diameter, step-over, scallop: all at a tolerance of 0.01.
PARTS = [("mesh/mount_rush.off.gz", 86, 3, 0.3, 0.2), ("mesh/mount_rush.off.gz", 86, 6, 0.3, 0.2), ("mesh/demo.off", 10, 1, 0.02, 0.05),
         ("mesh/demo.off", 10, 3, 0.02, 0.05), ("mesh/ktoolcav.stl", 4, 0.2, 0.005, None), ("mesh/pycam-textbox.stl", 130, 1, 0.3, None)]
# OpenCAMLib's drop cutter over a part of 53,001 triangles, 100 mm long: radius in mm, microseconds a point.
OPENCAMLIB = [(0.5, 160), (1, 210), (3, 570), (10, 3600)]


def run(program, part, options, times=3):
    """CPU seconds, what it says, number of lines, and the deepest gouge of one run; the fastest of some."""
    best = None
    with tempfile.TemporaryDirectory() as directory:
        out = os.path.join(directory, "out.ngc")
        for _ in range(times):
            before = os.times()
            done = subprocess.run([program, "mill", part, out, "--threads", "1", "--verbose", *options], capture_output=True, text=True)
            after = os.times()
            if done.returncode != 0:
                sys.exit(done.stderr)
            cpu = after.children_user + after.children_system - before.children_user - before.children_system
            if best is None or cpu < best[0]:
                best = (cpu, done.stdout + done.stderr, sum(1 for _ in open(out)))
        tool = options[options.index("--tool") + 1]
        verified = subprocess.run([program, "verify", out, "--against", part, "--tool", tool], capture_output=True, text=True)
    return *best, "none" if verified.returncode == 0 else "**yes**"


def opencamlib(radius):
    """Microseconds a point at a radius on a part 100 long: between the measured ones in proportion."""
    for (r0, us0), (r1, us1) in zip(OPENCAMLIB, OPENCAMLIB[1:]):
        if radius <= r1:
            return us0 + max(0, radius - r0) / (r1 - r0) * (us1 - us0)
    return OPENCAMLIB[-1][1]


def number(text, pattern):
    return float(re.search(pattern, text)[1].replace(",", ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="krepl")
    parser.add_argument("--data", type=Path, required=True, help="directory of real data")
    parser.add_argument("--output", type=Path, required=True, help="the table in Markdown")
    a = parser.parse_args()
    rows, scallops = [], []
    for name, side, diameter, step, scallop in PARTS:
        part = a.data / name
        if not part.exists():
            print(f"compare.py: {name} is not in {a.data} and left out", file=sys.stderr)
            continue
        tool = ["--tool", f"ball:{diameter}", "--tolerance", "0.01"]
        options = [*tool, "--step-over", str(step)]
        chords_cpu, _, chords, _ = run(a.program, str(part), [*options, "--no-arcs"])
        cpu, said, lines, gouge = run(a.program, str(part), options)
        points = number(said, r"curves +([0-9]+) points")
        length, minutes = number(said, r"; ([0-9.e+]+) mm cut"), number(said, r"about ([0-9.]+) min")
        other = opencamlib(100 * diameter / 2 / side)
        rows.append([part.name, f"{diameter} mm", f"{step} mm", f"{points:,.0f}", f"{1e6 * cpu / points:.1f}", f"{points / cpu:,.0f}",
                     f"×{other / (1e6 * cpu / points):.0f}", f"{chords:,}", f"{1e6 * chords_cpu / chords:.1f}", f"{lines:,}", f"{cpu:.2f}",
                     f"{length / 1000:.1f} m", f"{minutes:.1f}", gouge])
        if scallop is None:
            continue
        cpu, said, lines, gouge = run(a.program, str(part), [*tool, "--scallop", str(scallop)], 1)
        length, minutes = number(said, r"; ([0-9.e+]+) mm cut"), number(said, r"about ([0-9.]+) min")
        scallops.append([part.name, f"{diameter} mm", f"{scallop} mm", f"{number(said, r'scallops +([0-9]+) pieces'):.0f}",
                         f"{number(said, r'added, ([0-9]+) places'):.0f}", f"{lines:,}", f"{cpu:.2f}", f"{length / 1000:.1f} m",
                         f"{minutes:.1f}", gouge])
    head = ["part", "ball", "step-over", "points", "µs a point", "points a second", "OpenCAMLib's time", "lines of chords alone", "µs a chord",
            "lines with arcs", "CPU s in all", "path", "minutes at 1000 mm/min", "gouge"]
    scallop_head = ["part", "ball", "scallop", "pieces of passes added", "places where it is not proven", "lines with arcs", "CPU s in all",
                    "path", "minutes at 1000 mm/min", "gouge"]
    with open(a.output, "w") as out:
        out.write(machine(["linuxcnc-uspace", "g++"]) + "\n\n" + table(head, rows) + "\n\n" + table(scallop_head, scallops) + "\n")


if __name__ == "__main__":
    main()
