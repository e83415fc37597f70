"""What the tables of bench/README.md share: one measurement in a process of its own with limits on time and memory."""
import json
import os
import platform
import resource
import subprocess
import sys
import threading


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
