"""Results appear whole or not at all: unwritable places, full disks, interrupts, kills."""
import os
import resource
import shutil
import signal
import stat
import subprocess
import time
import unittest

import support

OLD = "the old file\n"
EXTENSIONS = ("gpkg", "fgb", "wkt", "wkb", "geojson", "shp", "svg", "dxf", "gml", "kml", "tab")


def many_lines(count):
    """Short lines far apart: the result is large, the computation short."""
    return "".join(f"LINESTRING ({10 * (i % 400)} {10 * (i // 400)}, {10 * (i % 400) + 3} {10 * (i // 400) + 1})\n"
                   for i in range(count))


class Unwritable(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.wkt", "LINESTRING (0 0, 10 0)\n")

    def buffer(self, message, output):
        self.fail_with(1, message, "buffer", "in.wkt", output, "--radius", "1", output="nothing")

    def test_directory_that_does_not_exist(self):
        self.buffer("nowhere/out.gpkg: cannot be written: No such file or directory; create the directory first",
                    "nowhere/out.gpkg")

    def test_target_is_a_directory(self):
        (self.directory / "out.gpkg").mkdir()
        done = self.krepl("buffer", "in.wkt", "out.gpkg", "--radius", "1")
        self.assertEqual((done.returncode, done.stderr), (1, "krepl: out.gpkg: is a directory; name a file in it\n"))

    def test_binary_format_to_a_device(self):
        done = self.krepl("buffer", "in.wkt", "/dev/null", "--radius", "1", "--format", "gpkg")
        self.assertEqual((done.returncode, done.stderr),
                         (1, "krepl: /dev/null: is not an ordinary file; only text formats can be written to a stream\n"))
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_text_format_to_a_device(self):
        self.succeed("buffer", "in.wkt", "/dev/null", "--radius", "1", "--format", "wkt")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_full_device(self):
        for name in ("wkt", "geojson", "svg", "dxf"):
            done = self.krepl("buffer", "in.wkt", "/dev/full", "--radius", "1", "--format", name)
            self.assertEqual((done.returncode, done.stderr.splitlines()[-1]),
                             (1, "krepl: /dev/full: cannot be written: No space left on device; free some space or choose "
                                 "another place"))

    def test_full_standard_output(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run(self.command("buffer", "in.wkt", "-", "--radius", "1"), cwd=self.directory, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: standard output: cannot be written: No space left on device", done.stderr)

    def test_reader_that_goes_away(self):
        self.write("in.wkt", many_lines(20000))
        run = subprocess.Popen(self.command("buffer", "in.wkt", "-", "--radius", "1"), cwd=self.directory,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        run.stdout.close()
        self.assertIn("krepl: standard output: cannot be written: Broken pipe", run.stderr.read())
        run.stderr.close()
        self.assertEqual(run.wait(60), 1)

    @unittest.skipIf(os.geteuid() == 0, "the superuser may write everywhere")
    def test_no_permission(self):
        (self.directory / "closed").mkdir(mode=0o555)
        self.buffer("closed/out.gpkg: cannot be written: Permission denied", "closed/out.gpkg")
        self.write("out.gpkg", OLD)
        os.chmod(self.directory / "out.gpkg", 0o444)
        done = self.krepl("buffer", "in.wkt", "out.gpkg", "--radius", "1")
        self.assertEqual((done.returncode, done.stderr), (1, "krepl: out.gpkg: cannot be written: Permission denied\n"))

    def test_links_and_permissions_are_kept(self):
        self.write("real.wkt", OLD)
        os.chmod(self.directory / "real.wkt", 0o640)
        os.symlink("real.wkt", self.directory / "link.wkt")
        self.succeed("buffer", "in.wkt", "link.wkt", "--radius", "1")
        self.assertTrue((self.directory / "link.wkt").is_symlink())
        self.assertTrue(self.text("real.wkt").startswith("CURVEPOLYGON"))
        self.assertEqual(stat.S_IMODE(os.stat(self.directory / "real.wkt").st_mode), 0o640)

    def test_old_shapefile_leaves_no_side_files(self):
        for extension in ("qix", "sbn", "prj"):
            self.write(f"out.{extension}", OLD)
        self.succeed("buffer", "in.wkt", "out.shp", "--radius", "1")
        self.assertEqual(self.files(), ["in.wkt", "out.dbf", "out.shp", "out.shx"])

    def test_input_is_not_overwritten(self):
        os.link(self.directory / "in.wkt", self.directory / "same.wkt")
        for name in ("in.wkt", "./in.wkt", "same.wkt"):
            done = self.krepl("buffer", "in.wkt", name, "--radius", "1")
            self.assertEqual((done.returncode, done.stderr),
                             (2, f"krepl: {name}: is the input, which would be lost; name another file for the result\n"))
        self.assertEqual(self.text("in.wkt"), "LINESTRING (0 0, 10 0)\n")


class FullDisk(support.CliTest):
    """A write fails half way: by a limit on the size of files (anywhere), on a small file system (as the superuser)."""

    def refuse(self, directory, extension, **options):
        for name in (f"out.{extension}", "out.dbf"):
            (directory / name).write_text(OLD)
        before = sorted(p.name for p in directory.iterdir())
        done = self.krepl("buffer", self.directory / "in.wkt", directory / f"out.{extension}", "--radius", "1", **options)
        self.assertEqual(done.returncode, 1, f"{extension}: {done.stderr}")
        self.assertIn(f"krepl: {directory / f'out.{extension}'}: ", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(sorted(p.name for p in directory.iterdir()), before, extension)
        self.assertEqual((directory / f"out.{extension}").read_text(), OLD)

    def test_limit_on_file_size(self):
        self.write("in.wkt", many_lines(4000))
        target = self.directory / "target"
        target.mkdir()
        for extension in EXTENSIONS:
            with self.subTest(format=extension):
                self.refuse(target, extension, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (150000, 150000)))
                shutil.rmtree(target)
                target.mkdir()

    def test_small_file_system(self):
        if os.geteuid() != 0:
            self.skipTest("only the superuser can mount a small file system")
        self.write("in.wkt", many_lines(4000))
        target = self.directory / "mounted"
        target.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(target)], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("mounting is not allowed here")
        self.addCleanup(subprocess.run, ["umount", str(target)])
        for extension in EXTENSIONS:
            with self.subTest(format=extension):
                self.refuse(target, extension)
                for leftover in target.iterdir():
                    leftover.unlink()


class Interrupted(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.wkt", many_lines(40000))
        self.write("out.gpkg", OLD)

    # What has not ended in order within 0.6 s is ended without saying where it was: a matter of the machine's load.

    def stop(self, sent):
        """Sends the signal when the temporary file is half a megabyte large."""
        run = self.start("buffer", "in.wkt", "out.gpkg", "--radius", "1")
        self.wait_until(run, lambda: any(temporary.stat().st_size > 500000
                                         for temporary in self.directory.glob(".out.gpkg.krepl-*/out.gpkg")), "it writes")
        run.send_signal(sent)
        stdout, stderr = run.communicate(timeout=60)
        return run.returncode, stderr, stdout

    def test_interrupt_while_writing(self):
        for sent in (signal.SIGINT, signal.SIGTERM):
            status, stderr, stdout = self.stop(sent)
            self.assertEqual((status, stdout), (130, ""))
            self.assertRegex(stderr, r"^krepl: (out.gpkg: interrupted while writing|interrupted)\n$")
            self.assertEqual(self.text("out.gpkg"), OLD)
            self.assertEqual(self.files(), ["in.wkt", "out.gpkg"])

    def test_interrupt_while_computing(self):
        # Long lines that all cross each other: reading is short, the computation long.
        self.write("in.wkt", "".join(f"LINESTRING ({i} 0, {4000 - i} 4000)\nLINESTRING (0 {i}, 4000 {4000 - i})\n"
                                     for i in range(4000)))
        run = self.start("buffer", "in.wkt", "out.gpkg", "--radius", "0.01")
        self.wait_until_interruptible(run)
        time.sleep(0.6)
        self.assertIsNone(run.poll(), "finished before it could be stopped: the test needs more data")
        run.send_signal(signal.SIGINT)
        _, stderr = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 130, stderr)
        self.assertRegex(stderr, r"^krepl: (in.wkt: (cancelled|interrupted)[^\n]*|interrupted)\n$")
        self.assertEqual(self.files(), ["in.wkt", "out.gpkg"])

    def test_kill_leaves_the_old_file(self):
        status, _, _ = self.stop(signal.SIGKILL)
        self.assertEqual(status, -signal.SIGKILL)
        self.assertEqual(self.text("out.gpkg"), OLD)
        # The next run is not disturbed by what the killed one left.
        self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "1", "--no-pieces")
        self.assertTrue((self.directory / "out.gpkg").read_bytes().startswith(b"SQLite format 3"))

    def test_interrupt_while_reading_standard_input(self):
        run = self.start("buffer", "-", "out.gpkg", "--radius", "1", stdin=subprocess.PIPE)
        self.wait_until_interruptible(run)
        time.sleep(0.2)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(60), 130)
        self.assertRegex(run.stderr.read(), r"^krepl: (standard input: interrupted while reading|interrupted)\n$")
        for stream in (run.stdin, run.stdout, run.stderr):
            stream.close()


if __name__ == "__main__":
    support.main()
