#!/usr/bin/env python3
"""Makes cages of all models at all budgets in all modes, has each certified by `cagewright check`,
and writes a table and a list of the failures.

  sweep.py --models DIR ... [--budgets 50 100] [--modes envelope boxes-improved] [--jobs 2] [--output sweep.md]

A mode is a method, and options of generate after it, joined by '+': envelope, boxes-improved, envelope+quads
(--quads), envelope+symmetry=off (--symmetry off). Times are seconds of processor time, so that they hold
on a busy machine; --baseline compares them, and the figures, with an earlier run's JSON. Exits with
1 when a cage is missing or not certified.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from limited_run import limited_run
from table import models_in

# What generate answers without a cage, and rightly: there is nothing to build a cage around.
UNFIT = ("lie on one line", "all vertices of the model coincide", "has no faces")


def mode_options(mode):
    method, *rest = mode.split("+")
    options = ["--method", method]
    for part in rest:
        name, _, value = part.partition("=")
        options += [f"--{name}"] + ([value] if value else [])
    return options


def one(program, model, budget, mode, limit, extra):
    """A row of figures, or what went wrong."""
    row = {"model": model.name, "budget": budget, "mode": mode}
    with tempfile.TemporaryDirectory() as folder:
        cage, figures = pathlib.Path(folder, "cage.obj"), pathlib.Path(folder, "cage.json")
        ran = limited_run([program, "generate", model, "-o", cage, "--json", figures, "--vertices", budget,
                           *mode_options(mode), *extra], limit)
        row.update(user=ran.seconds, wall=ran.wall)
        if ran.code is None:
            row["failure"] = f"stopped after {limit} s"
            return row
        if ran.code not in (0, 3):  # 3: the smallest cage there was, but over the budget
            is_unfit = ran.code == 2 and any(words in ran.said for words in UNFIT)
            row["unfit" if is_unfit else "failure"] = (ran.said.strip().splitlines() or [f"exit code {ran.code}"])[-1]
            return row
        judged = subprocess.run([program, "check", model, cage], capture_output=True, text=True, check=False)
        if judged.returncode != 0:
            row["failure"] = "not certified: " + " ".join(judged.stdout.split())[:300]
            return row
        data = json.loads(figures.read_text())
        row.update({k: data["cage"].get(k) for k in ("vertices", "faces", "volume_ratio", "mean_distance", "max_distance",
                                                     "min_quality", "low_quality", "max_valence", "model_volume_method")})
        row["reached"] = not any(r["reason"] == "budget_not_reached" for r in data["remarks"])
        row["clearance"] = data["budget"]["clearance"]
        row["symmetry"] = data.get("symmetry")
        return row


def cells(row):
    return (row["model"], row["mode"], row["budget"], row["vertices"] if row["reached"] else f"**{row['vertices']}**",
            f"{row['volume_ratio']:.3f}", f"{100 * row['mean_distance']:.2f}", f"{100 * row['max_distance']:.2f}",
            f"{row['min_quality']:.3f}", f"{row['low_quality']:.2f}", row["max_valence"], f"{row['user']:.1f}")


def summary(rows, wording):
    """Medians by mode and budget, of what was certified."""
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["mode"], row["budget"]].append(row)
    lines = [wording, "", "| mode | budget | cages | over budget | volume ratio | mean gap % | 2r/R least | least of all | 5th percentile | user s |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for (mode, budget), group in groups.items():
        middle = {k: statistics.median(r[k] for r in group)
                  for k in ("volume_ratio", "mean_distance", "min_quality", "low_quality", "user")}
        lines.append(f"| {mode} | {budget} | {len(group)} | {sum(not r['reached'] for r in group)} | {middle['volume_ratio']:.3f} "
                     f"| {100 * middle['mean_distance']:.2f} | {middle['min_quality']:.3f} | {min(r['min_quality'] for r in group):.3f} "
                     f"| {middle['low_quality']:.2f} | {middle['user']:.1f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/cli/cagewright")
    parser.add_argument("--models", nargs="+", required=True, help="folders, or files")
    parser.add_argument("--all", action="store_true", help="also the package's small test files")
    parser.add_argument("--budgets", nargs="+", type=int, default=[50, 100, 200, 400])
    parser.add_argument("--modes", nargs="+", default=["envelope", "boxes-improved"])
    parser.add_argument("--options", default="", help="more options of generate, for every mode")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=600, help="seconds after which a run is stopped")
    parser.add_argument("--baseline", help="JSON of an earlier run")
    parser.add_argument("--output", default="build/sweep.md", help="the table; the figures go beside it as .json")
    arguments = parser.parse_args()

    folders = [m for m in arguments.models if pathlib.Path(m).is_dir()]
    files = [pathlib.Path(m) for m in arguments.models if not pathlib.Path(m).is_dir()]
    models = [m for m in files + list(models_in(folders, arguments.all)) if not m.stem.endswith("_cage")]
    jobs = [(m, b, mode) for m in models for b in arguments.budgets for mode in arguments.modes]
    rows = []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        running = [pool.submit(one, arguments.program, *job, arguments.limit, arguments.options.split()) for job in jobs]
        for number, future in enumerate(running, 1):
            rows.append(future.result())
            row = rows[-1]
            note = row.get("failure") or row.get("unfit") or f"{row['vertices']} vertices, {row['user']:.1f} s"
            print(f"{number}/{len(jobs)} {row['model']} {row['budget']} {row['mode']}: {note}", file=sys.stderr, flush=True)

    made = [r for r in rows if "vertices" in r]
    failures = [r for r in rows if "failure" in r]
    unfit = sorted({f"{r['model']}: {r['unfit']}" for r in rows if "unfit" in r})
    lines = ["# Cages within a budget: every model and mode", "",
             f"{len(made)} cages certified by `cagewright check`, {len(failures)} failures. Gaps in % of the model's diagonal;",
             "2 r / R least and 5th percentile; times in seconds of user CPU. Bold: more vertices than asked for.", ""]
    lines += summary(made, "Medians:") if made else []
    if failures:
        lines += ["", "## Failures", ""] + [f"- {r['model']}, {r['budget']}, {r['mode']}: {r['failure']}" for r in failures]
    if unfit:
        lines += ["", "## No cage possible", ""] + [f"- {u}" for u in unfit]
    lines += ["", "## All cages", "", "| model | mode | budget | vertices | volume ratio | mean gap % | max gap % | 2r/R | 5 % | valence | user s |",
              "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    lines += ["| " + " | ".join(map(str, cells(r))) + " |" for r in made]
    if arguments.baseline:
        before = {(r["model"], r["budget"], r["mode"]): r for r in json.loads(pathlib.Path(arguments.baseline).read_text())}
        pairs = [(before[k], r) for r in made if (k := (r["model"], r["budget"], r["mode"])) in before and "vertices" in before[k]]
        for key, name in (("volume_ratio", "volume ratio"), ("mean_distance", "mean gap"), ("user", "user CPU")):
            ratios = sorted((new[key] / old[key], new["model"], new["budget"], new["mode"]) for old, new in pairs if old[key])
            if ratios:
                lines += ["", f"Against the baseline, {name}: median {statistics.median(r[0] for r in ratios):.3f}, worst {ratios[-1]}"]
    pathlib.Path(arguments.output).write_text("\n".join(lines) + "\n", encoding="utf-8")
    pathlib.Path(arguments.output).with_suffix(".json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    print(f"{len(made)} cages certified, {len(failures)} failures; see {arguments.output}")
    sys.exit(1 if failures or not made else 0)


if __name__ == "__main__":
    main()
