"""A STEP file of krepl opened with FreeCAD in console mode.

usage: freecad_test.py PROGRAM, with PROGRAM the built krepl
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77  # what CTest takes for "skipped"
SOURCE = Path(__file__).resolve().parents[2]
SCRIPT = """
import json, Part
shape = Part.Shape()
shape.read({file!r})
kinds = [type(face.Surface).__name__ for face in shape.Faces]
print("found " + json.dumps({{"valid": shape.isValid(), "area": shape.Area, "volume": shape.Volume, "solids": len(shape.Solids),
                             "faces": {{kind: kinds.count(kind) for kind in set(kinds)}}}}))
"""


def opened(console, directory, file):
    script = directory / "open.py"
    script.write_text(SCRIPT.format(file=str(file)))
    done = subprocess.run([console, str(script)], capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)
    found = re.search(r"^found (.*)$", done.stdout, re.M)
    assert found, done.stdout + done.stderr
    return json.loads(found.group(1))


def main(program):
    console = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if console is None:
        print("skipped: FreeCAD is missing; as root: apt-get install --no-install-recommends freecad-python3")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(prefix="krepl-freecad-") as name:
        directory = Path(name)
        subprocess.run([SOURCE / "scripts" / "make-part", directory / "part.stl"], check=True, stdout=subprocess.DEVNULL)
        for options in ([], ["--solid"]):
            made = subprocess.run([program, "terrain", "part.stl", "part.step", "--radius", "3", *options], cwd=directory,
                                  check=True, capture_output=True, text=True).stdout
            planes, cylinders, spheres, walls = map(int, re.search(
                r"(\d+) planes, (\d+) cylinders and (\d+) spheres written, (\d+) walls", made).groups())
            found = opened(console, directory, directory / "part.step")
            assert found["valid"], found
            assert found["solids"] == len(options), found
            assert found["faces"]["Sphere"] == spheres, found
            assert sum(found["faces"].values()) == planes + cylinders + spheres + walls + len(options), found
            assert not options or found["volume"] > 0, found
            print(options, found)


if __name__ == "__main__":
    main(sys.argv[1])
