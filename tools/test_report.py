#!/usr/bin/env python3
"""Sums up what the parts of `./dev test` did: failures, and the cases that were skipped and why.

  test_report.py FOLDER

The folder holds PART.xml as ctest --output-junit writes it, and may hold a file `failed` with the
parts that ended with an error, one a line. The last line is "N passed, N failed"; a part that failed
without a failing case (it did not compile, say) counts as one. Exits with 1 if anything failed, or if
nothing passed.
"""

import collections
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


def reason_of_skip(case):
    """What the case said when it skipped itself: after the place of GTEST_SKIP, or last of all."""
    lines = [line.strip() for line in "".join(case.itertext()).splitlines() if line.strip()]
    for line, following in zip(lines, lines[1:]):
        if re.search(r":\d+: Skipped$", line):
            return following
    return lines[-1] if lines else "no reason given"


def main():
    folder = pathlib.Path(sys.argv[1])
    ended_badly = (folder / "failed").read_text().split() if (folder / "failed").exists() else []
    passed, failures, skipped = 0, [], collections.Counter()
    with_failures = set()
    for report in sorted(folder.glob("*.xml")):
        for case in ElementTree.parse(report).getroot().iter("testcase"):
            if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
                skipped[reason_of_skip(case)] += 1
            elif case.find("failure") is not None or case.get("status") == "fail":
                failures.append(f"{report.stem}: {case.get('name')}")
                with_failures.add(report.stem)
            else:
                passed += 1
    failures += [f"{part}: ended with an error" for part in ended_badly if part not in with_failures]

    if skipped:
        print(f"{sum(skipped.values())} cases were skipped:")
        for reason, count in sorted(skipped.items(), key=lambda item: (-item[1], item[0])):
            print(f"  {count:4} {reason}")
    for failure in failures:
        print(f"FAILED {failure}")
    print(f"{passed} passed, {len(failures)} failed")
    sys.exit(1 if failures or passed == 0 else 0)


if __name__ == "__main__":
    main()
