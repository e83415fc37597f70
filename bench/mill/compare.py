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

# Part, diameter, step-over: all at a tolerance of 0.01.
PARTS = [("mesh/mount_rush.off.gz", 3, 0.3), ("mesh/mount_rush.off.gz", 6, 0.3), ("mesh/demo.off", 1, 0.02),
         ("mesh/demo.off", 3, 0.02), ("mesh/ktoolcav.stl", 0.2, 0.005), ("mesh/pycam-textbox.stl", 1, 0.3)]


def run(program, part, options):
    """CPU seconds, summary and number of lines of one run; the fastest of three."""
    best = None
    with tempfile.TemporaryDirectory() as directory:
        out = os.path.join(directory, "out.ngc")
        for _ in range(3):
            before = os.times()
            done = subprocess.run([program, "mill", part, out, "--threads", "1", *options], capture_output=True, text=True)
            after = os.times()
            if done.returncode != 0:
                sys.exit(done.stderr)
            cpu = after.children_user + after.children_system - before.children_user - before.children_system
            if best is None or cpu < best[0]:
                best = (cpu, done.stdout, sum(1 for _ in open(out)))
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="krepl")
    parser.add_argument("--data", type=Path, required=True, help="directory of real data")
    parser.add_argument("--output", type=Path, required=True, help="the table in Markdown")
    a = parser.parse_args()
    rows = []
    for name, diameter, step in PARTS:
        part = a.data / name
        if not part.exists():
            print(f"compare.py: {name} is not in {a.data} and left out", file=sys.stderr)
            continue
        options = ["--tool", f"ball:{diameter}", "--step-over", str(step), "--tolerance", "0.01"]
        chords_cpu, _, chords = run(a.program, str(part), [*options, "--no-arcs"])
        cpu, summary, lines = run(a.program, str(part), options)
        length, minutes = re.search(r"; ([0-9.e+]+) mm cut", summary)[1], re.search(r"about ([0-9.]+) min", summary)[1]
        rows.append([part.name, f"{diameter} mm", f"{step} mm", f"{chords:,}", f"{1e6 * chords_cpu / chords:.1f}", f"{lines:,}",
                     f"{1e6 * cpu / chords:.1f}", f"{cpu:.2f}", f"{float(length) / 1000:.1f} m", minutes])
    head = ["part", "ball", "step-over", "lines of chords alone", "µs a chord", "lines with arcs", "µs, by the same number", "CPU s in all",
            "path", "minutes at 1000 mm/min"]
    with open(a.output, "w") as out:
        out.write(machine(["linuxcnc-uspace", "g++"]) + "\n\n" + table(head, rows) + "\n")


if __name__ == "__main__":
    main()
