"""How the program ends, what it says of failures in JSON, its limits, and what becomes of files.

Called as: robust_test.py PROGRAM SAMPLES_DIR [unittest arguments]
"""

import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
CREATURE = pathlib.Path(sys.argv[2]).resolve() / "creature.obj"

DONE, FAULTS, BAD_INPUT, NOT_SATISFIABLE, LIMIT, INTERRUPTED = 0, 1, 2, 3, 4, 130

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
QUADS = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]


def cube(size=1.0, faces=None):
    lines = ["v " + " ".join(repr(size * x) for x in corner) for corner in CORNERS]
    lines += ["f " + " ".join(map(str, face)) for face in faces or QUADS]
    return "\n".join(lines) + "\n"


def run(*arguments, **options):
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "errors": "replace", **options}
    return subprocess.run([str(PROGRAM), *[a if isinstance(a, bytes) else str(a) for a in arguments]],
                          text=True, timeout=300, check=False, **options)


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model = self.file("model.obj", cube())
        self.cage = self.file("cage.obj", cube(1.5))

    def file(self, name, content):
        path = self.folder / name
        path.write_text(content, encoding="utf-8")
        return path

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())


class Exits(InAFolder):
    def test_each_code_means_what_the_help_says(self):
        self.assertIn("Exit codes", run("--help").stdout)
        out = self.folder / "out.obj"
        tight = self.file("tight.obj", cube(0.5))
        for code, arguments in (
                (DONE, ("check", self.model, self.cage)),
                (FAULTS, ("check", self.model, tight)),
                (FAULTS, ("bind", self.model, tight, "-o", self.folder / "w.npz", "--strict")),
                (BAD_INPUT, ("check", self.model, self.folder / "none.obj")),
                (BAD_INPUT, ("check", self.model)),
                (BAD_INPUT, ("generate", self.model, "-o", out, "--depth", "x")),
                (LIMIT, ("generate", CREATURE, "-o", out, "--depth", 2, "--resolution", 512,
                         "--memory-limit", "300M")),
                (LIMIT, ("generate", CREATURE, "-o", out, "--depth", 8, "--resolution", 400,
                         "--time-limit", 0.05)),
        ):
            with self.subTest(arguments=arguments):
                ended = run(*arguments)
                self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        self.assertFalse(out.exists())

    def test_failures_are_told_in_json(self):
        bad = self.file("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        for command in (("info", bad), ("check", bad, self.cage), ("compare", bad, self.cage),
                        ("generate", bad, "-o", self.folder / "out.obj")):
            report = self.folder / "report.json"
            ended = run(*command, "--json", report)
            self.assertEqual(ended.returncode, BAD_INPUT)
            told = json.loads(report.read_text())
            self.assertEqual(told["exit_code"], BAD_INPUT)
            self.assertEqual(told["error"]["code"], "malformed")
            self.assertEqual(told["error"]["file"], str(bad))
            self.assertEqual(told["error"]["place"], {"line": 4})
            self.assertIn("export", told["error"]["remedy"])
            self.assertIn(told["error"]["message"], ended.stderr)
        misused = run("info", "--json", "-", "--resolution", "x", bad)
        self.assertEqual(json.loads(misused.stdout)["error"]["code"], "misuse")

    def test_json_on_stdout_stands_alone(self):
        told = run("check", self.model, self.cage, "--json", "-")
        self.assertTrue(json.loads(told.stdout)["valid"])
        self.assertIn("valid", told.stderr)

    def test_names_that_are_no_utf8_are_told_nevertheless(self):
        path = os.fsencode(self.folder) + b"/b\xe4d [1]\n.obj"
        with open(path, "w", encoding="utf-8") as file:
            file.write(cube())
        self.assertEqual(run("info", path, "--json", "-").returncode, DONE)
        made = run("compare", path, self.cage, "--no-poses", "--json", "-")
        self.assertEqual(made.returncode, DONE, made.stderr)
        self.assertEqual(len(json.loads(made.stdout)["cages"]), 1)


class Limits(InAFolder):
    def test_too_fine_a_grid_is_refused_with_the_figure(self):
        ended = run("generate", CREATURE, "-o", self.folder / "out.obj", "--depth", 2,
                    "--resolution", 512, "--memory-limit", "200M")
        self.assertEqual(ended.returncode, LIMIT)
        self.assertIn("million voxels", ended.stderr)
        self.assertIn("0.2 GB", ended.stderr)

    def test_so_little_memory_ends_well(self):
        for limit in ("1M", "8M", "24M", "48M"):
            ended = run("generate", CREATURE, "-o", self.folder / "out.obj", "--vertices", 100,
                        "--memory-limit", limit)
            self.assertIn(ended.returncode, (DONE, LIMIT), f"{limit}: {ended.stderr}")
            if ended.returncode == LIMIT:
                self.assertIn("memory", ended.stderr)

    def test_what_is_no_limit_is_refused(self):
        for option in (("--time-limit", "x"), ("--time-limit", "-1"), ("--time-limit", "1y"),
                       ("--memory-limit", "much"), ("--memory-limit", "3X"), ("--memory-limit", "nan")):
            self.assertEqual(run("info", self.model, *option).returncode, BAD_INPUT, option)
        for option in (("--time-limit", "0"), ("--time-limit", "1.5m"), ("--memory-limit", "50%"),
                       ("--memory-limit", "4GB"), ("--memory-limit", "0")):
            self.assertEqual(run("info", self.model, *option).returncode, DONE, option)


class Writing(InAFolder):
    def test_a_full_output_is_noticed(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            for command in (("info", self.model), ("check", self.model, self.cage), ("--help",),
                            ("info", self.model, "--json", "-")):
                ended = run(*command, stdout=full)
                self.assertEqual(ended.returncode, BAD_INPUT, command)
                self.assertIn("output", ended.stderr)

    def test_figures_that_cannot_be_written_leave_no_cage(self):
        ended = run("generate", self.model, "-o", self.folder / "out.obj", "--depth", 0,
                    "--json", "/dev/full")
        self.assertEqual(ended.returncode, BAD_INPUT)
        self.assertIn("/dev/full", ended.stderr)
        self.assertEqual(self.names(), ["cage.obj", "model.obj"])

    def test_a_reader_that_goes_away_costs_no_result(self):
        poses = [self.file(f"pose{i}.obj", cube(1.5 + i)) for i in range(3)]
        reader, writer = os.pipe()
        os.close(reader)
        made = run("deform", self.model, self.cage, *poses, "-o", f"{self.folder}/out/", stdout=writer)
        os.close(writer)
        self.assertNotIn(made.returncode, (-signal.SIGPIPE, DONE))
        self.assertEqual(sorted(os.listdir(self.folder / "out")), [f"pose{i}.obj" for i in range(3)])

    def test_a_disk_that_fills_up_leaves_what_was_there(self):
        # A limit of file sizes stops writing where a full disk would.
        def fill_up():
            resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))
        old = self.file("old", "old")
        posed = self.file("posed.obj", cube(1.8))
        before = self.names()
        for name, command in (("w.npz", ("bind", self.model, self.cage, "-o")), ("w.csv", ("bind", self.model, self.cage, "-o")),
                              ("w.json", ("bind", self.model, self.cage, "-o")), ("w.dmat", ("bind", self.model, self.cage, "-o")),
                              ("c.obj", ("generate", self.model, "--method", "boxes", "--depth", 0, "-o")),
                              ("d.obj", ("deform", self.model, self.cage, posed, "-o")), ("m.obj", ("weld", self.model)),
                              ("m.ply", ("convert", self.model)), ("m.glb", ("convert", self.model)), ("m.gltf", ("convert", self.model)),
                              ("i.json", ("info", self.model, "--json"))):
            for is_there in (False, True):
                target = self.folder / name
                if is_there:
                    target.write_bytes(old.read_bytes())
                ended = run(*command, target, preexec_fn=fill_up)
                self.assertEqual(ended.returncode, BAD_INPUT, f"{name}: {ended.stderr}")
                self.assertIn(name, ended.stderr)
                self.assertIn("; ", ended.stderr)
                self.assertEqual(target.exists(), is_there)
                if is_there:
                    self.assertEqual(target.read_text(), "old")
                    target.unlink()
                self.assertEqual(self.names(), before, name)

    def test_folders_that_cannot_be_made_are_told_with_a_remedy(self):
        taken = self.file("taken", "")
        posed = self.file("posed.obj", cube(1.8))
        for command in (("deform", self.model, self.cage, posed, "-o", f"{taken}/in/"), ("batch", self.model, "-o", f"{taken}/in")):
            ended = run(*command)
            self.assertEqual(ended.returncode, BAD_INPUT, ended.stderr)
            self.assertIn("create it first", ended.stderr)
        long = self.folder / ("x" * 300 + ".obj")
        self.assertIn("shorter", run("deform", self.model, self.cage, posed, "-o", long).stderr)

    def test_parts_are_cleared_away_by_signals(self):
        # Where the file system has nameless files there are no parts at all; a killed one is passed by.
        part = self.file(".cagewright-0.part", "of a program that was killed")
        out = self.folder / "d.obj"
        self.assertEqual(run("deform", self.model, self.cage, self.cage, "-o", out).returncode, DONE)
        self.assertEqual(part.read_text(), "of a program that was killed")
        self.assertEqual(self.names(), [".cagewright-0.part", "cage.obj", "d.obj", "model.obj"])

    def test_inputs_are_not_written_over(self):
        (self.folder / "link.obj").symlink_to("model.obj")
        before = self.model.read_bytes(), self.cage.read_bytes()
        for command in (("generate", self.model, "-o", self.model),
                        ("generate", self.model, "-o", self.folder / "link.obj"),
                        ("generate", self.model, "-o", self.folder / "out.obj", "--json", self.model),
                        ("deform", self.model, self.cage, self.cage, "-o", self.model),
                        ("deform", self.model, self.cage, self.cage, "-o", self.cage),
                        ("bind", self.model, self.cage, "-o", self.model),
                        ("weld", self.model, self.model)):
            ended = run(*command)
            self.assertEqual(ended.returncode, BAD_INPUT, command)
            self.assertIn("another name", ended.stderr)
        self.assertEqual((self.model.read_bytes(), self.cage.read_bytes()), before)

    def test_a_protected_file_is_not_replaced(self):
        for name, command in (("w.npz", ("bind", self.model, self.cage)),
                              ("c.obj", ("generate", self.model)),
                              ("d.obj", ("deform", self.model, self.cage, self.cage))):
            target = self.file(name, "old")
            target.chmod(0o444)
            ended = run(*command, "-o", target)
            self.assertEqual(ended.returncode, BAD_INPUT, name)
            self.assertIn("chmod u+w", ended.stderr)
            self.assertEqual(target.read_text(), "old")

    def test_killed_at_any_moment_leaves_the_old_or_the_new(self):
        weights = self.folder / "w.npz"
        names = self.names()
        for moment in range(8):
            process = subprocess.Popen([str(PROGRAM), "bind", str(CREATURE), str(CREATURE), "-o", str(weights)],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.05 + 0.04 * moment)
            process.kill()
            process.wait(timeout=60)
            self.assertIn(self.names(), (names, sorted([*names, "w.npz"])))

    def test_stops_at_other_signals_too(self):
        for sent in (signal.SIGTERM, signal.SIGHUP):
            process = subprocess.Popen([str(PROGRAM), "bind", str(CREATURE), str(CREATURE), "-o",
                                        str(self.folder / "w.npz")],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.3)
            process.send_signal(sent)
            self.assertIn(process.wait(timeout=60), (INTERRUPTED, DONE, -sent))
            (self.folder / "w.npz").unlink(missing_ok=True)
            self.assertEqual(self.names(), ["cage.obj", "model.obj"])

    def test_two_writers_leave_one_whole_file(self):
        out = self.folder / "out.obj"
        writers = [subprocess.Popen([str(PROGRAM), "deform", str(self.model), str(self.cage), str(self.cage),
                                     "-o", str(out)], stdout=subprocess.DEVNULL) for _ in range(4)]
        self.assertEqual([writer.wait(timeout=60) for writer in writers], [DONE] * 4)
        self.assertEqual(run("info", out).returncode, DONE)
        self.assertEqual(self.names(), ["cage.obj", "model.obj", "out.obj"])

    def test_any_name_and_any_locale(self):
        for name in ("with blank.obj", "br[ack]et*?.obj", "new\nline.obj", "-dash.obj", "ümläut.obj", "%s.obj"):
            model = self.file(name, cube())
            out = self.folder / f"out {name}".replace("*", "")
            for locale in ("C", "de_DE.UTF-8", "xx"):
                made = run("deform", "-o", out, "--", name, "cage.obj", "cage.obj",
                           cwd=self.folder, env={**os.environ, "LC_ALL": locale})
                self.assertEqual(made.returncode, DONE, f"{name}: {made.stderr}")
                self.assertEqual(out.read_text().count("\nf "), 6)
                self.assertIn("v -1 -1 -1", out.read_text().replace(".0", ""))
            model.unlink()

    def test_names_that_are_no_utf8_are_written_to(self):
        folder = os.fsencode(self.folder)
        for command in (("deform", self.model, self.cage, self.cage), ("generate", self.model, "--method", "boxes", "--depth", 0)):
            out = folder + b"/b\xe4d\xff.obj"
            made = run(*command, "-o", out, "--json", folder + b"/r\xe4.json") if command[0] == "generate" else run(*command, "-o", out)
            self.assertEqual(made.returncode, DONE, made.stderr)
            self.assertTrue(os.path.exists(out))
            os.unlink(out)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
