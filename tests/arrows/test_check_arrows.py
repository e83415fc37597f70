#!/usr/bin/env python3
"""Self-test of check_arrows.py: a clean little tree passes, and every planted violation is named with its place."""
import tempfile
import unittest
from pathlib import Path

from check_arrows import check

TABLE = """<!-- rooms: begin -->
| room | what | public headers | may include | outside libraries |
|---|---|---|---|---|
| `src/kernel` | k | `point` | | Boost |
| `src/left` | l | `left` | kernel | |
| `src/right` | r | | kernel | GDAL |
| `examples` | e | | point | |
<!-- rooms: end -->
"""
CLEAN = {
    "ARCHITECTURE.md": TABLE,
    "include/krepl/point.hpp": "#pragma once\n#include <cmath>\n",
    "include/krepl/left.hpp": '#include "krepl/point.hpp"\n',
    "src/kernel/a.hpp": '#include <boost/version.hpp>\n#include "krepl/point.hpp"\n',
    "src/left/l.cpp": '#include "krepl/left.hpp"\n#include "kernel/a.hpp"\n#include <vector>\n#include <sys/stat.h>\n',
    "src/right/r.cpp": '#include "kernel/a.hpp"\n#include <ogrsf_frmts.h>\n',
    "src/CMakeLists.txt": "krepl_room(left SOURCES left/l.cpp USES kernel LIBRARIES Boost::headers)\n",
    "examples/01.cpp": '#include <krepl/point.hpp>\n',
}


class CheckArrows(unittest.TestCase):
    def problems(self, **planted):
        with tempfile.TemporaryDirectory() as directory:
            root = Path(directory).resolve()
            for name, text in {**CLEAN, **planted.get("files", {})}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            count, problems = check(root)
            self.assertGreater(count, 0)
            return problems

    def assert_named(self, problems, *parts):
        self.assertEqual(len(problems), 1, problems)
        for part in parts:
            self.assertIn(part, problems[0])

    def test_clean_tree_passes(self):
        self.assertEqual(self.problems(), [])

    def test_sibling_private_header(self):
        found = self.problems(files={"src/left/x.hpp": "", "src/right/r.cpp": '\n  # include "left/x.hpp"\n'})
        self.assert_named(found, "src/right/r.cpp:2:", "src/left", "src/right may not include")

    def test_sibling_public_header(self):
        self.assert_named(self.problems(files={"src/right/r.cpp": '#include "krepl/left.hpp"\n'}), "src/right/r.cpp:1:")

    def test_sibling_in_angle_brackets(self):
        self.assert_named(self.problems(files={"src/right/r.cpp": "#include <krepl/left.hpp>\n"}), "src/right/r.cpp:1:")

    def test_upward_arrow(self):
        found = self.problems(files={"src/left/x.hpp": "", "src/kernel/a.hpp": '#include "left/x.hpp"\n'})
        self.assert_named(found, "src/kernel/a.hpp:1:")

    def test_public_header_includes_private_one(self):
        self.assert_named(self.problems(files={"include/krepl/left.hpp": '#include "kernel/a.hpp"\n'}), "private")

    def test_public_header_of_no_room(self):
        self.assert_named(self.problems(files={"include/krepl/extra.hpp": ""}), "include/krepl/extra.hpp", "no room")

    def test_library_in_the_wrong_room(self):
        self.assert_named(self.problems(files={"src/left/l.cpp": "#include <gdal.h>\n"}), "GDAL is not for src/left")

    def test_unheard_of_library(self):
        self.assert_named(self.problems(files={"src/left/l.cpp": "#include <eigen3/Eigen/Core>\n"}), "eigen3")

    def test_relative_include(self):
        self.assert_named(self.problems(files={"src/left/x.hpp": "", "src/left/l.cpp": '#include "x.hpp"\n'}), "neither")

    def test_missing_header(self):
        self.assert_named(self.problems(files={"src/left/l.cpp": '#include "kernel/gone.hpp"\n'}), "does not exist")

    def test_example_sees_private_header(self):
        self.assert_named(self.problems(files={"examples/01.cpp": '#include "kernel/a.hpp"\n'}), "examples/01.cpp:1:")

    def test_room_without_a_row(self):
        self.assert_named(self.problems(files={"src/attic/a.cpp": ""}), "src/attic/a.cpp", "no room")

    def test_table_that_points_upward(self):
        table = TABLE.replace("| k | `point` | |", "| k | `point` | left |")
        self.assert_named(self.problems(files={"ARCHITECTURE.md": table}), "src/kernel may include left")

    def test_cmake_dependency(self):
        cmake = "krepl_room(left SOURCES left/l.cpp USES kernel right\n  LIBRARIES Boost::headers)\n"
        self.assert_named(self.problems(files={"src/CMakeLists.txt": cmake}), "krepl_room(left) USES right")


if __name__ == "__main__":
    unittest.main()
