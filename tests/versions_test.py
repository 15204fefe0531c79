#!/usr/bin/env python3
"""The version is the same wherever it is written: versions_test.py ROOT.

A tag v1.2.3, if the commit has one, names the version, too; a candidate for a release is v1.2.3-rc1.
"""

import pathlib
import re
import subprocess
import sys

WRITTEN = {
    "CMakeLists.txt": r"project\(cagewright VERSION (\d+\.\d+\.\d+)",
    "CITATION.cff": r"^version: (\d+\.\d+\.\d+)$",
    "CHANGELOG.md": r"^## (\d+\.\d+\.\d+)\b",
    "blender/cagewright/blender_manifest.toml": r'^version = "(\d+\.\d+\.\d+)"$',
    "blender/cagewright/__init__.py": r'"version": \((\d+, \d+, \d+)\)',
}


def main():
    root = pathlib.Path(sys.argv[1])
    versions = {}
    for name, pattern in WRITTEN.items():
        found = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        versions[name] = found.group(1).replace(", ", ".") if found else "none"
    # Not every copy of the sources is a clone.
    tags = subprocess.run(["git", "-C", root, "tag", "--points-at", "HEAD"], capture_output=True, text=True,
                          check=False).stdout.split()
    for tag in tags:
        found = re.fullmatch(r"v(\d+\.\d+\.\d+)(-rc\d+)?", tag)
        if found:
            versions[f"tag {tag}"] = found.group(1)
    for name, version in versions.items():
        print(f"{version}  {name}")
    return 0 if len(set(versions.values())) == 1 and "none" not in versions.values() else 1


if __name__ == "__main__":
    sys.exit(main())
