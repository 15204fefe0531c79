"""Every row of docs/formats.md, tried.

Called as: formats_test.py PROGRAM PAGE           tries all samples, and that PAGE says what the rows say
           formats_test.py --write PAGE           writes the rows to PAGE: ./dev formats
"""

import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from formats_rows import SECTIONS, tables


def page_with_tables(text):
    for title, table in tables().items():
        begin, end = f"<!-- rows of {title}: ./dev formats -->\n", "<!-- end of rows -->\n"
        if begin not in text:
            sys.exit(f"the page has no line {begin}")
        text = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: begin + table + end, text, flags=re.S)
    return text


def faults(program, name, content, wanted):
    """What the program makes of a sample that it should not."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / name).write_bytes(content)
        done = subprocess.run([program, "info", name, "--json", "-"], cwd=folder, capture_output=True, timeout=60)
    report = json.loads(done.stdout) if done.stdout else {}
    found = []
    if done.returncode != wanted["code"]:
        found.append(f"exit code {done.returncode}: {done.stderr.decode(errors='replace').strip() or report}")
    elif wanted["code"] == 0:
        notes = [note["code"] for note in report["notes"]]
        for what, value in (("vertices", report["vertices"]), ("faces", report["faces"])):
            found += [f"{value} {what}"] if value != wanted[what] else []
        found += [f"notes {notes}"] if notes != ([wanted["note"]] if wanted["note"] else []) else []
        found += [f"area {report['area']}"] if abs(report["area"] - wanted.get("area", report["area"])) > 1e-9 else []
    else:
        message = report["error"]["message"]
        found += [f"'{text}' is not in: {message}" for text in wanted["texts"] if text not in message]
        found += [f"no remedy: {message}"] if not report["error"].get("remedy") else []
        found += ["the JSON and stderr differ"] if message not in done.stderr.decode(errors="replace") else []
    return found


def main():
    if sys.argv[1] == "--write":
        page = pathlib.Path(sys.argv[2])
        page.write_text(page_with_tables(page.read_text()))
        return 0
    program, page = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).read_text()
    samples = [(f"{title}: {file} (sample {i})", *s) for title, rows in SECTIONS for file, _, group in rows for i, s in enumerate(group)]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for label, found in zip((s[0] for s in samples), pool.map(lambda s: faults(program, *s[1:]), samples)):
            failed += bool(found)
            for fault in found:
                print(f"{label}\n    {fault}")
    if page_with_tables(page) != page:
        failed += 1
        print("docs/formats.md does not say what the rows say: ./dev formats")
    print(f"{failed} of {len(samples)} samples fail")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
