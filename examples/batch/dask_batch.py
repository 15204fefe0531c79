#!/usr/bin/env python3
"""Cages for all models of a folder, as `cagewright batch` makes them, by the workers of dask.distributed.

    dask_batch.py models -o cages --workers 8                           # processes of this machine
    dask_batch.py models -o cages --scheduler HOST:8786 --vertices 80   # workers anywhere that see the same folders

models/deep/er/b.ply becomes cages/deep/er/b.obj, with its report in cages/deep/er/b.json. With --poses FOLDER a posed
cage FOLDER/deep/er/b.obj makes cages/deep/er/b-posed.ply. One failure stops nothing; its reason stands in the report and
in cages/batch.csv. The same command goes on where it was stopped: a report that belongs to the same model and options is
not made again.
"""

import argparse
import csv
import hashlib
import json
import os
import pathlib
import sys

FORMATS = {".obj", ".ply", ".stl", ".off", ".glb", ".gltf"}


def named(models):
    """Names of cages, without extension, and their models. Models that differ in the extension alone keep theirs."""
    found = sorted(path for path in models.rglob("*") if path.suffix.lower() in FORMATS)
    stems = [path.relative_to(models).with_suffix("") for path in found]
    return {str(stem if stems.count(stem) == 1 and str(stem) != "batch" else path.relative_to(models)): path
            for path, stem in zip(found, stems)}


def key_of(model, options):
    """What a cage is made of: the bytes of the model, and the options."""
    return hashlib.sha256(model.read_bytes() + json.dumps(options, sort_keys=True).encode()).hexdigest()


def is_done(report, key):
    try:
        return json.loads(report.read_text())["batch_key"] == key
    except (OSError, ValueError, KeyError):
        return False


def write_whole(path, text):
    """A file that is there with all of its text, or not at all."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    part.write_text(text)
    part.replace(path)


def work(model, cage_path, pose, posed_path, key, options):
    """One model, on whichever worker: writes cage and report, and returns a row of the table."""
    import warnings

    import cagewright
    report_path = cage_path.with_suffix(".json")
    cage_path.parent.mkdir(parents=True, exist_ok=True)
    cage_path.unlink(missing_ok=True)
    row = {"status": "done", "reason": None, "message": None, "vertices": None, "faces": None, "volume_ratio": None}
    try:
        mesh = cagewright.read_mesh(model)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cagewright.NotAsAsked)  # it stands in the table
            cage = cagewright.generate(mesh, threads=1, **options)
        cagewright.write_mesh(cage_path, cage)
        report = cage.report
        if not cage.is_as_asked:
            row.update(status="not_as_asked", message=cage.remarks[0])
        row.update(vertices=report["cage"]["vertices"], faces=report["cage"]["faces"],
                   volume_ratio=report["cage"]["volume_ratio"])
        if pose:
            cagewright.deform_file(model, cage_path, pose, posed_path, threads=1)
    except cagewright.Error as error:
        report = {}
        row.update(status="failed", reason=error.code, message=str(error))
    write_whole(report_path, json.dumps({**report, "batch_key": key, "batch": row}, indent=1) + "\n")
    return row


def parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    parser.add_argument("--poses", type=pathlib.Path, help="a folder of posed cages, named as the cages")
    parser.add_argument("--scheduler", help="HOST:PORT of a dask-scheduler; without, --workers on this machine")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--vertices", type=int, default=100)
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                        help="any option of cagewright.generate(), such as quads=on or rounds=3")
    return parser.parse_args(words)


def main(words):
    from distributed import Client, as_completed
    arguments = parsed(words)
    options = {"num_vertices": arguments.vertices, **dict(option.split("=", 1) for option in arguments.option)}
    models, out = arguments.models, arguments.out
    rows, tasks = {}, []
    for name, model in named(models).items():
        report, key = out / f"{name}.json", key_of(model, options)
        pose = arguments.poses / f"{name}.obj" if arguments.poses else None
        pose = pose if pose and pose.exists() else None
        posed = out / f"{name}-posed{model.suffix}"
        if is_done(report, key) and (pose is None or posed.exists()):
            rows[name] = json.loads(report.read_text())["batch"]
        else:
            tasks.append((name, (model, out / f"{name}.obj", pose, posed, key, options)))
    total = len(rows) + len(tasks)
    print(f"{len(rows)} of {total} models are done already", flush=True)
    if tasks:
        client = Client(arguments.scheduler) if arguments.scheduler else \
            Client(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None)
        with client:
            futures = {client.submit(work, *given, pure=False): name for name, given in tasks}
            for future in as_completed(futures):
                name = futures[future]
                rows[name] = future.result() if future.status == "finished" else \
                    {"status": "failed", "reason": "crashed", "message": str(future.exception())}
                print(f"{len(rows)} of {total}: {name}: {rows[name]['status']}", flush=True)
    out.mkdir(parents=True, exist_ok=True)
    part = out / ".batch.csv.part"
    with part.open("w", newline="") as file:
        table = csv.DictWriter(file, ["model", "status", "vertices", "faces", "volume_ratio", "reason", "message"])
        table.writeheader()
        for name, model in named(models).items():
            table.writerow({"model": model.relative_to(models), **rows[name]})
    part.replace(out / "batch.csv")
    return 0 if all(row["status"] == "done" for row in rows.values()) else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
