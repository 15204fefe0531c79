#!/usr/bin/env python3
"""Damages files and looks what the program makes of them: no crash, no hang, nothing said that is not so.

    tools/mutate.py build/release/cli/cagewright CAGE MODEL... [--count 500] [--seed 1] [--keep FOLDER]

Each MODEL is damaged --count times: bits flipped, bytes cut out or repeated, the end cut off, lines exchanged or left
out, numbers edited. What comes out goes through `info`, `check` (against CAGE) and, where it can be read, `generate`
with a small budget. Told as wrong are

    crash   the program ended by a signal, or by an internal error
    hang    it took longer than TIMEOUT seconds of processor time
    mute    it refused without a line that names the file
    other   commands disagree whether the file can be read, or `check` says of a cage that `generate` called valid that
            it is not

Files that something went wrong with are kept with --keep. Exit code 0 if there are none. The same seed damages alike.
"""

import argparse
import json
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile

TIMEOUT = 60
NUMBER = re.compile(rb"-?\d+(\.\d+)?([eE][-+]?\d+)?")
EDITS = [b"0", b"-1", b"1e308", b"-1e308", b"nan", b"inf", b"1e-320", b"4294967296", b"99999999999999999999", b"1,5",
         b"", b"-", b"1.5.5", b"0x10", b"2147483648"]
PARSED = {0, 1, 3, 4}


def flip_bits(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8, 64))):
        at = rng.randrange(len(data))
        data[at] ^= 1 << rng.randrange(8)
    return bytes(data)


def cut_end(data, rng):
    return data[:rng.randrange(len(data))]


def cut_piece(data, rng):
    at = rng.randrange(len(data))
    return data[:at] + data[at + rng.choice((1, 2, 4, 100)):]


def repeat_piece(data, rng):
    at = rng.randrange(len(data))
    piece = data[at:at + rng.choice((1, 4, 50))]
    return data[:at] + piece * rng.choice((2, 3, 50)) + data[at + len(piece):]


def exchange_lines(data, rng):
    lines = data.split(b"\n")
    for _ in range(rng.choice((1, 3, 20))):
        a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
        lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def drop_lines(data, rng):
    lines = data.split(b"\n")
    at = rng.randrange(len(lines))
    del lines[at:at + rng.choice((1, 2, 10))]
    return b"\n".join(lines)


def edit_number(data, rng):
    # Near a random place: most numbers of a long file are alike.
    start = rng.choice((0, rng.randrange(len(data))))
    found = NUMBER.search(data, start) or NUMBER.search(data)
    if not found:
        return flip_bits(data, rng)
    value = rng.choice([*EDITS, found.group() + b"0", b"-" + found.group()])
    return data[:found.start()] + value + data[found.end():]


DAMAGE = [flip_bits, cut_end, cut_piece, repeat_piece, exchange_lines, drop_lines, edit_number, edit_number]


def limit_time():
    resource.setrlimit(resource.RLIMIT_CPU, (TIMEOUT, TIMEOUT + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Campaign:
    def __init__(self, program, cage, folder):
        self.program, self.cage, self.folder = program, cage, folder

    def run(self, *arguments):
        return subprocess.run([self.program, *map(str, arguments), "--memory-limit", "1G", "--threads", "1"],
                              capture_output=True, text=True, errors="replace", check=False, preexec_fn=limit_time)

    def judge(self, ran, path):
        """What is wrong with one run, or nothing."""
        if ran.returncode in (-24, -9):  # SIGXCPU, SIGKILL
            return "hang"
        if ran.returncode < 0:
            return f"crash by signal {-ran.returncode}"
        if "internal error" in ran.stderr or ran.returncode not in {0, 1, 2, 3, 4}:
            return f"crash: exit code {ran.returncode}: {ran.stderr.strip()}"
        if ran.returncode == 2 and path.name not in ran.stderr:
            return f"mute: {ran.stderr.strip()!r}"
        return None

    def try_file(self, path):
        info = self.run("info", path, "--json", self.folder / "info.json")
        check = self.run("check", path, self.cage)
        for name, ran in (("info", info), ("check", check)):
            wrong = self.judge(ran, path)
            if wrong:
                return f"{name}: {wrong}"
        if (info.returncode in PARSED) != (check.returncode in PARSED):
            return f"other: info ends with {info.returncode}, check with {check.returncode}"
        if info.returncode != 0:
            return None
        try:
            json.loads((self.folder / "info.json").read_text())
        except ValueError as error:
            return f"other: info writes no JSON: {error}"
        cage = self.folder / "cage.obj"
        cage.unlink(missing_ok=True)
        made = self.run("generate", path, "-o", cage, "--vertices", 30, "--time-limit", 20)
        wrong = self.judge(made, path)
        if wrong:
            return f"generate: {wrong}"
        if cage.exists() != made.stdout.startswith("a valid cage"):
            return f"other: generate says {made.stdout[:60]!r}, and {'a' if cage.exists() else 'no'} file is there"
        if cage.exists():
            judged = self.run("check", path, cage, "--allow-pieces")
            if judged.returncode != 0:
                return f"other: a cage called valid is not: {judged.stdout[:300]!r}"
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("cage")
    parser.add_argument("models", nargs="+")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    options = parser.parse_args()
    failed = 0
    for model in map(pathlib.Path, options.models):
        data = model.read_bytes()
        for number in range(options.count):
            rng = random.Random(f"{options.seed} {model.name} {number}")
            damage = rng.choice(DAMAGE)
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, f"damaged{model.suffix}")
                path.write_bytes(damage(data, rng))
                wrong = Campaign(options.program, options.cage, pathlib.Path(folder)).try_file(path)
                if wrong:
                    failed += 1
                    print(f"{model.name} {number} ({damage.__name__}): {wrong}", flush=True)
                    if options.keep:
                        pathlib.Path(options.keep).mkdir(exist_ok=True)
                        kept = pathlib.Path(options.keep, f"{model.stem}_{number}{model.suffix}")
                        kept.write_bytes(path.read_bytes())
        print(f"{model.name}: {options.count} tried", flush=True)
    print(f"{failed} wrong")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
