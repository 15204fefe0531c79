#!/usr/bin/env python3
"""Makes the same cages with several builds of cagewright, on several processors as it were, and with
one thread and many: all of them must be the same, byte for byte.

  same_bytes.py g++=build/release/cli/cagewright clang=build/clang-release/cli/cagewright
  same_bytes.py program=PATH --models samples ../models/bunny.obj --cases triangles:100 quads:120

A case is a kind of cage and its budget, joined by ':': triangles:100 (vertices), quads:100 (faces),
boxes:5 (depth), weights:20 (a cage of so many vertices, and the weights of every kind of coordinates in it:
the same on any number of threads; programs that choose other vector instructions may differ in the last digit, see
docs/coordinates.md). A variant is a program in a setting: with `threads`, 1 or 4 threads; with `plain`, the
C library is told that the processor has neither AVX2 nor FMA (GLIBC_TUNABLES), and picks other code
for its mathematics. The first program with 1 thread is what all others are compared with: itself in
both settings, each other program with 4 threads and plain (--every: all of them in all settings).
(Highway picks its instructions by the processor alone: build one of the programs with
CAGEWRIGHT_SIMD_DEFINITIONS=HWY_COMPILE_ONLY_STATIC.) Models that need longer than --limit seconds are left out, and counted.
Exits with 1 if any two differ; with --keep DIR, their files are left there.
"""

import argparse
import concurrent.futures
import hashlib
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from table import SUFFIXES

CASES = {
    "triangles": lambda n: ["--vertices", n],
    "quads": lambda n: ["--quads", "--faces", n],
    "boxes": lambda n: ["--depth", n],
    "weights": lambda n: ["--vertices", n],
}
WITHOUT_FMA = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"


def variants(programs, every):
    """(name, program, threads, plain), the one to compare with first."""
    settings = list(itertools.product((1, 4), (False, True)))
    for number, (name, program) in enumerate(programs):
        kept = settings if every else [(1, False), (4, False), (1, True)] if number == 0 else [(4, True)]
        for threads, plain in kept:
            yield f"{name}, {threads} thread{'s' * (threads > 1)}{', without FMA' * plain}", program, threads, plain


def made(program, threads, plain, model, case, to, limit):
    """What stands for the cage: a hash of its bytes, or the exit code and the message without one."""
    kind, _, size = case.partition(":")
    environment = {k: v for k, v in os.environ.items() if k != "GLIBC_TUNABLES"}
    if plain:
        environment["GLIBC_TUNABLES"] = WITHOUT_FMA

    def run(*arguments):
        command = [program, "--threads", threads, "-q", *arguments]
        return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False,
                              env=environment, timeout=limit)

    try:
        done = run("generate", model, "-o", to, *CASES[kind](size))
        if done.returncode != 0:
            return f"exit code {done.returncode}: {done.stderr.strip()}"
        hashes = hashlib.sha256(to.read_bytes())
        for name in kinds_of(program) if kind == "weights" else []:
            weights = to.with_suffix(".npz")
            done = run("bind", model, to, "-o", weights, "--coordinates", name)
            hashes.update(weights.read_bytes() if done.returncode == 0 else f"{name}: {done.returncode}".encode())
    except subprocess.TimeoutExpired:
        return None
    return hashes.hexdigest()


def kinds_of(program):
    listed = subprocess.run([str(program), "coordinates", "--json", "-", "-q"], capture_output=True, text=True, check=True)
    return [kind["name"] for kind in json.loads(listed.stdout)["kinds"]]


def differing(model, case, all_variants, limit, keep):
    """The variants that give other bytes than the first; None where the first takes too long."""
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder, f"{number}.obj") for number in range(len(all_variants))]
        first, different = None, []
        for number, (name, program, threads, plain) in enumerate(all_variants):
            # The others may run beside more, or be debug builds.
            result = made(program, threads, plain, model, case, files[number], limit if number == 0 else 40 * limit)
            if number == 0:
                if result is None:
                    return None
                first = result
            elif result != first:
                different.append(name)
                if keep:
                    for n in (0, number):
                        if files[n].exists():
                            safe = f"{model.stem}-{case}-{all_variants[n][0]}.obj".replace(" ", "_").replace(":", "").replace(",", "")
                            shutil.copy(files[n], pathlib.Path(keep, safe))
        return different


def models_of(paths):
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            yield from (p for p in sorted(path.iterdir()) if p.suffix.lower() in SUFFIXES)
        elif path.exists():
            yield path


def main():
    sample = pathlib.Path(__file__).parent.parent / "samples"
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="NAME=PROGRAM")
    parser.add_argument("--models", nargs="+", default=[sample], help="files, and folders of them; those that are missing are passed over")
    parser.add_argument("--cases", nargs="+", default=["triangles:60", "quads:60", "boxes:4"])
    parser.add_argument("--every", action="store_true", help="every program in every setting")
    parser.add_argument("--limit", type=float, default=60, help="seconds for one cage by the first program")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="folder for the files that differ")
    arguments = parser.parse_args()
    programs = []
    for text in arguments.programs:
        name, found, program = text.partition("=")
        if not found or not os.access(program, os.X_OK):
            parser.error(f"{text}: not NAME=PROGRAM, or no such program")
        programs.append((name, pathlib.Path(program).resolve()))
    for case in arguments.cases:
        if case.partition(":")[0] not in CASES or not case.partition(":")[2].isdigit():
            parser.error(f"{case}: a case is one of {', '.join(CASES)}, a colon and a number")
    models = list(models_of(arguments.models))
    if not models:
        parser.error("there are no models")
    if arguments.keep:
        os.makedirs(arguments.keep, exist_ok=True)
    all_variants = list(variants(programs, arguments.every))
    work = list(itertools.product(models, arguments.cases))
    compared = bad = slow = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = pool.map(lambda w: differing(*w, all_variants, arguments.limit, arguments.keep), work)
        for (model, case), different in zip(work, results):
            slow += different is None
            compared += different is not None
            bad += bool(different)
            if different:
                print(f"{model.name}, {case}: other bytes than {all_variants[0][0]}:", flush=True)
                for name in different:
                    print(f"  {name}", flush=True)
    print(f"{compared} cages of {len(models)} models in {len(all_variants)} variants: {bad} differ"
          + (f"; {slow} took too long and were left out" if slow else ""))
    sys.exit(1 if bad or compared == 0 else 0)


if __name__ == "__main__":
    main()
