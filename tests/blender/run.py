#!/usr/bin/env python3
"""The tests of the add-on in a real Blender, without a window:  run.py ZIP PROGRAM [MODELS] [NAME...]

Each *_test.py beside this file runs in a Blender of its own, which has nothing but the add-on, installed from its zip.
Where there is no Blender they are skipped (exit code 77). ONLY=word in the environment runs the cases whose names have it.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def run(test, zip_file, program, models):
    with tempfile.TemporaryDirectory() as home:
        # Debian's Blender takes the python3 that comes first, and numpy with it.
        environment = {"PATH": "/usr/bin:/bin", "HOME": home, "BLENDER_USER_SCRIPTS": home + "/scripts",
                       "BLENDER_USER_CONFIG": home + "/config", "BLENDER_USER_DATAFILES": home + "/datafiles",
                       "LANG": os.environ.get("LANG", "C.UTF-8"), "GLTF_VALIDATOR": os.environ.get("GLTF_VALIDATOR", ""),
                       "ONLY": os.environ.get("ONLY", "")}
        (pathlib.Path(home) / "scripts" / "addons").mkdir(parents=True)
        # Without Blender's thread for every core: the tests share the machine.
        command = [shutil.which("blender") or "/usr/bin/blender", "--background", "--factory-startup", "--threads", "2",
                   "--python-exit-code", "1", "--python", str(test), "--", str(zip_file), str(program), str(models), home]
        ended = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               timeout=900)
    said = ended.stdout
    if ended.returncode != 0 or "OK" not in said:
        print(said)
        return False
    print(next(line for line in said.splitlines() if line.startswith("Ran ")), test.stem)
    return True


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if shutil.which("blender") is None:
        print("there is no Blender: skipped")
        sys.exit(77)
    zip_file, program = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    models = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else "/none")
    names = sys.argv[4:]
    tests = [test for test in sorted(HERE.glob("*_test.py")) if not names or test.stem in names]
    failed = [test.stem for test in tests if not run(test, zip_file, program, models)]
    if failed:
        sys.exit("failed: " + ", ".join(failed))


if __name__ == "__main__":
    main()
