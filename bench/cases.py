"""What the tables of bench/README.md share: one measurement in a process of its own with limits on time and memory."""
import argparse
import json
import os
import platform
import resource
import subprocess
import sys
import threading
from pathlib import Path


def run_case(program, limit, arguments):
    """The measurement that the program prints, or {"failed": why}, and the peak memory of its process."""
    most = int(0.85 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    child = subprocess.Popen([str(program), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
    late = threading.Event()
    timer = threading.Timer(limit, lambda: (late.set(), child.kill()))
    timer.start()
    output, complaint = child.stdout.read(), child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    timer.cancel()
    child.returncode = os.waitstatus_to_exitcode(status)
    peak = 1024 * usage.ru_maxrss
    if child.returncode == 0:
        return {**json.loads(output), "peak": peak}
    reason = f"> {limit:g} s" if late.is_set() else "failed"
    print(f"    {reason}: {complaint.strip()}", file=sys.stderr)
    return {"failed": reason, "peak": peak}


class Bench:
    """Runs cases of one program and keeps every measurement as a line of JSON."""

    def __init__(self, arguments):
        self.program, self.limit = arguments.program.resolve(), arguments.limit
        self.log = open(arguments.log, "w")

    def measure(self, title, record, arguments):
        """`record`: what the line tells of the case besides the measurement."""
        print(f"  {title}", file=sys.stderr, flush=True)
        result = run_case(self.program, self.limit, arguments)
        self.log.write(json.dumps({**record, **result}) + "\n")
        self.log.flush()
        return result


def bench_arguments(description, program, sizes):
    """The options that the tables of zones, diagrams and rivers have in common; more may be added."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--program", type=Path, required=True, help=f"the built {program}")
    parser.add_argument("--data", type=Path, required=True, help="directory of WKT files")
    parser.add_argument("--world", type=Path, help="GMT text of the world's rivers")
    parser.add_argument("--sizes", default=sizes, help="segments of the rows that grow")
    parser.add_argument("--limit", type=float, default=120, help="seconds a case may take (default: 120)")
    parser.add_argument("--log", type=Path, required=True, help="every measurement as a line of JSON")
    parser.add_argument("--output", type=Path, required=True, help="the tables in Markdown")
    return parser


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def machine(packages):
    """The machine, its load and the versions of packages, as a sentence."""
    model = next((l.split(":", 1)[1].strip() for l in open("/proc/cpuinfo") if l.startswith("model name")), "unknown")
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    versions = []
    for package in packages:
        query = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}", package], capture_output=True, text=True)
        versions.append(query.stdout or f"{package}: not from Debian")
    return (f"Machine: {model}, {os.cpu_count()} logical cores, {memory:.0f} GiB, {platform.system()} {platform.release()}; "
            f"load at the start {os.getloadavg()[0]:.1f}. {'; '.join(versions)}.")
