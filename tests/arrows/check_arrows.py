#!/usr/bin/env python3
"""Checks every #include and every CMake dependency between rooms against the table in ARCHITECTURE.md.

usage: check_arrows.py ROOT      prints each violation as FILE:LINE: what; exit status 1 if there is any
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
ROOM_CALL = re.compile(r"krepl_room\(\s*(\w+)(.*?)\)", re.S)
SOURCE_SUFFIXES = {".c", ".cpp", ".hpp", ".h", ".inc"}
# How headers of outside libraries are recognised; what matches none of these and has no "/" is standard or POSIX.
LIBRARIES = [
    ("Boost", r"boost/"), ("oneTBB", r"(tbb|oneapi)/"), ("GDAL", r"(gdal|ogr|cpl_|vrt)\w*\.h$"), ("fmt", r"fmt/"),
    ("nlohmann-json", r"nlohmann/"), ("CLI11", r"CLI/"), ("GEOS", r"geos(/|_c\.h|\.h)"), ("CGAL", r"CGAL/"),
    ("Clipper", r"(polyclipping/)?clipper\.hpp"), ("OpenVDB", r"openvdb/"), ("benchmark", r"benchmark/"), ("zlib", r"zlib\.h$"),
    ("rapidcheck", r"rapidcheck"), ("GTest", r"g(test|mock)/"),
]
SYSTEM_DIRECTORIES = ("sys/", "linux/", "bits/", "ext/", "sanitizer/")


class Room:
    def __init__(self, path, headers, allowed, libraries):
        self.path, self.headers, self.allowed, self.libraries = path, headers, allowed, libraries
        self.name = path.rsplit("/", 1)[-1] if path.startswith("src/") else path


def words(cell):
    return [w for w in re.split(r"[,\s`]+", cell) if w]


def read_table(root):
    """The rooms in order, and what is wrong with the table itself."""
    text = (root / "ARCHITECTURE.md").read_text()
    try:
        table = text.split("<!-- rooms: begin -->")[1].split("<!-- rooms: end -->")[0]
    except IndexError:
        return [], ["ARCHITECTURE.md: the marks around the table of rooms are missing"]
    rooms, problems, known = [], [], set()
    for line in table.strip().splitlines()[2:]:
        cells = [c.strip() for c in line.strip().strip("|").split("|")]
        if len(cells) != 5:
            problems.append(f"ARCHITECTURE.md: not five columns: {line}")
            continue
        room = Room(words(cells[0])[0], words(cells[2]), set(words(cells[3])), set(words(cells[4])))
        for name in sorted(room.allowed - known):
            problems.append(f"ARCHITECTURE.md: {room.path} may include {name}, which is not in a row above it")
        known |= {room.name, *room.headers}
        rooms.append(room)
    if not rooms:
        problems.append("ARCHITECTURE.md: the table of rooms is empty")
    return rooms, problems


def library_of(header):
    for name, pattern in LIBRARIES:
        if re.match(pattern, header):
            return name
    if "/" in header and not header.startswith(SYSTEM_DIRECTORIES):
        return header.split("/")[0]
    return None


def room_of_file(relative, rooms):
    if relative.parts[:2] == ("include", "krepl"):
        return next((r for r in rooms if relative.stem in r.headers), None)
    owners = [r for r in rooms if relative.is_relative_to(r.path)]
    return max(owners, key=lambda r: len(r.path), default=None)


def judge_quoted(room, header, path, root, rooms):
    """What is wrong with #include "header" in a file of the room, or None."""
    first, _, rest = header.partition("/")
    if first == "krepl" and rest:
        owner = next((r for r in rooms if Path(rest).stem in r.headers), None)
        if owner is None or not (root / "include" / header).exists():
            return f'"{header}" is not a public header of the table'
        allowed = owner is room or owner.name in room.allowed or Path(rest).stem in room.allowed
        return None if allowed else f'"{header}" belongs to {owner.path}, which {room.path} may not include'
    owner = next((r for r in rooms if r.path == f"src/{first}"), None)
    if owner is not None and rest:
        if "include" in path.relative_to(root).parts[:1]:
            return f'a public header includes the private "{header}"'
        if not (root / "src" / header).exists():
            return f'"{header}" does not exist'
        allowed = owner is room or owner.name in room.allowed
        return None if allowed else f'"{header}" belongs to {owner.path}, which {room.path} may not include'
    if room.path.startswith("src/"):
        return f'"{header}" is neither "room/file.hpp" nor "krepl/file.hpp"'
    return None if any((base / header).resolve().is_relative_to((root / room.path).resolve()) and (base / header).exists()
                       for base in (path.parent, root / room.path, root)) else f'"{header}" is not a file of {room.path}'


def check_file(path, root, rooms):
    relative = path.relative_to(root)
    room = room_of_file(relative, rooms)
    if room is None:
        return [f"{relative}:1: belongs to no room of the table in ARCHITECTURE.md"]
    found = []
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, header = match.groups()
        library = library_of(header)
        if bracket == "<" and header.startswith("krepl/"):
            bracket, library = '"', None
        if bracket == '"' and library in (None, header.split("/")[0]):
            problem = judge_quoted(room, header, path, root, rooms)
        else:
            problem = f"{library} is not for {room.path}" if library and library not in room.libraries else None
        if problem:
            found.append(f"{relative}:{number}: {problem}")
    return found


def check_cmake(root, rooms):
    found = []
    for path in sorted((root / "src").rglob("CMakeLists.txt")):
        for name, rest in ROOM_CALL.findall(path.read_text()):
            room = next((r for r in rooms if r.path == f"src/{name}"), None)
            uses = re.search(r"\bUSES\b(.*?)(?=\b[A-Z]{4,}\b|$)", rest, re.S)
            for used in uses.group(1).split() if uses else []:
                if room is None or used not in room.allowed:
                    found.append(f"{path.relative_to(root)}: krepl_room({name}) USES {used}, which the table does not allow")
    return found


def check(root):
    rooms, problems = read_table(root)
    count = 0
    for room in rooms:
        if room.path.startswith("src/") and not (root / room.path).is_dir():
            problems.append(f"ARCHITECTURE.md: {room.path} is in the table and not in the tree")
    for top in ("include", "src", "apps", "examples", "bench"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SOURCE_SUFFIXES and path.is_file():
                count += 1
                problems += check_file(path, root, rooms)
    return count, problems + check_cmake(root, rooms)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    count, problems = check(Path(sys.argv[1]).resolve())
    print("\n".join(problems) or f"{count} files: every include is allowed by the table in ARCHITECTURE.md")
    sys.exit(1 if problems or count == 0 else 0)


if __name__ == "__main__":
    main()
