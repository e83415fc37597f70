"""scripts/extract-elevation: heights in the order of the array, and a message where the file is not what it should be.

usage: test_extract_elevation.py DIRECTORY_OF_SCRIPTS [unittest arguments]
"""
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

SCRIPTS = Path(sys.argv.pop(1)).resolve()
PACKAGED = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"


def numpy_array(descr, shape, data):
    header = repr({"descr": descr, "fortran_order": False, "shape": shape}).encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


class ExtractElevation(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def run_on(self, member, content, name="in.npz"):
        with zipfile.ZipFile(self.directory / name, "w") as archive:
            archive.writestr(member, content)
        return self.run_script(name)

    def run_script(self, *arguments):
        return subprocess.run([SCRIPTS / "extract-elevation", "out.asc", *arguments], cwd=self.directory, capture_output=True,
                              text=True)

    def test_heights_keep_their_order(self):
        for descr in ("<i2", ">i2"):
            data = struct.pack(descr[0] + "6h", 1, -2, 3, 400, 5, -600)
            done = self.run_on("elevation.npy", numpy_array(descr, (2, 3), data))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual((self.directory / "out.asc").read_text(),
                             "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 92\n"
                             "NODATA_value -32768\n1 -2 3\n400 5 -600\n")

    def test_what_it_cannot_read_is_refused(self):
        for member, content in (("other.npy", b""), ("elevation.npy", b"text"),
                                ("elevation.npy", numpy_array("<f8", (1, 1), bytes(8))),
                                ("elevation.npy", numpy_array("<i2", (2, 2), bytes(6)))):
            done = self.run_on(member, content)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, r"^extract-elevation: in\.npz: ")
            self.assertFalse((self.directory / "out.asc").exists())
        (self.directory / "no.npz").write_text("no archive")
        self.assertRegex(self.run_script("no.npz").stderr, r"^extract-elevation: no\.npz: ")
        self.assertRegex(self.run_script("absent.npz").stderr,
                         r"absent\.npz is missing; run scripts/install-packages surface\n$")

    @unittest.skipUnless(os.path.exists(PACKAGED), "python-matplotlib-data is not installed")
    def test_the_packaged_file(self):
        done = self.run_script()
        self.assertEqual(done.stdout, "out.asc: 403 x 344 heights of 236 to 1076 m, cells of 92 m\n")
        rows = (self.directory / "out.asc").read_text().split("\n")[6:]
        self.assertEqual(rows[0].split()[:3], ["483", "487", "491"])


if __name__ == "__main__":
    unittest.main()
