#!/usr/bin/env python3
"""Whether scenes have the same bits on several ranks as on one process: runs each on both, and
compares every file, the last state in the checkpoints and what run.json says of the body.

    scripts/ranks_identity.py                          # all examples that ranks can compute
    scripts/ranks_identity.py --ranks 2 3 examples/closed_crack/scene.json
    scripts/ranks_identity.py --share 0.2              # the first fifth of each
    scripts/ranks_identity.py --list                   # which are refused, and why

Runs stay in --scratch; those that are there and ended well are not repeated. The table at the end is
Markdown; the exit code is 1 where anything differs. PATH or --program says which ligament.
"""
import argparse
import json
import re
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# What a run computed. Logs and clocks differ.
TABLES = ["history.csv", "broken_bonds.csv", "cut_faces.csv", "fragments.csv", "packing.csv", "fields.pvd"]
RECORDED = ["status", "reason", "steps", "particles", "dt", "broken_bonds", "crack_length", "peak_load",
            "external_work", "energy_residual", "states", "warnings", "stiffness", "broken_time", "regime",
            "overlap_particles", "broken_in_overlap", "trusted_until", "gauges", "phases", "skipped"]


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=Path, default=sorted(ROOT.glob("examples/*/*.json")))
    parser.add_argument("--ranks", nargs="+", type=int, default=[2])
    parser.add_argument("--share", type=float, default=1.0, help="of the scene's duration")
    parser.add_argument("--scratch", type=Path, default=Path("ranks_identity"))
    parser.add_argument("--program", default="ligament")
    parser.add_argument("--list", action="store_true")
    return parser.parse_args()


def is_study(scene):
    return re.search(r'^\s*"scene"\s*:', scene.read_text(), re.MULTILINE) is not None


def answer_of(command):
    """The last line of what --json prints."""
    done = subprocess.run(command, capture_output=True, text=True)
    lines = done.stdout.strip().splitlines()
    return done.returncode, json.loads(lines[-1]) if lines else {}


def duration_of(scene, share):
    """As an option, with the scene's own unit."""
    if share == 1:
        return []
    value, unit = re.search(r'"duration"\s*:\s*"?([-+.0-9eE]+)\s*([a-zA-Z]*)', scene.read_text()).groups()
    value = f"{float(value) * share:.6g} {unit}".strip()
    return ["--set", "/time/duration=" + (json.dumps(value) if unit else value)]


def run(args, scene, folder, ranks):
    """Seconds, and the exit code."""
    if (folder / "run.json").exists():
        record = json.loads((folder / "run.json").read_text())
        if record.get("status") in ("done", "stopped"):
            return record.get("wall_seconds", float("nan")), 0 if record["status"] == "done" else 3
        shutil.rmtree(folder)
    # In every step that may have one: the last of both runs are of the same step.
    command = [args.program, "run", str(scene), "-o", str(folder), "--set", "/output/checkpoint_interval=1e-9"]
    command += duration_of(scene, args.share)
    if ranks > 1:
        command += ["-n", str(ranks)]
    folder.parent.mkdir(parents=True, exist_ok=True)
    began = time.monotonic()
    with open(str(folder) + ".out", "w", encoding="utf-8") as out:
        code = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT).returncode
    return time.monotonic() - began, code


def tables_of(path):
    """Keys and words of the tables of a file of states (core/state_file.h), by their names."""
    data = path.read_bytes()
    place = 32  # behind magic, version, bytes of the file and of its header

    def number():
        nonlocal place
        place += 8
        return struct.unpack_from("<Q", data, place - 8)[0]

    def name():
        nonlocal place
        n = number()
        place += n
        return data[place - n:place].decode()

    content = struct.unpack_from("<Q", data, 24)[0]
    tables = {}
    for _ in range(number()):
        table, n_keys, rows, columns, key_bytes = name(), number(), number(), number(), number()
        names = [name() for _ in range(columns)]
        n = key_bytes + 8 * rows * columns
        tables[table] = (n_keys, rows, names, data[content:content + n])
        content += n
    if content != len(data) - 8:
        raise ValueError(f"{path}: not a file of states")
    return tables


def last_state(run):
    """Step and tables of the newest checkpoint, but for what they say of blocks at rest, which each
    rank cuts otherwise; empty: there is none, as of runs shorter than 50 steps of the far field."""
    states = [path for path in (run / "checkpoints").glob("*/body.bin") if path.parent.suffix != ".tmp"]
    if not states:
        return {}
    tables = tables_of(max(states))
    state = {name: table for name, table in tables.items() if name not in ("blocks", "rest", "split_rest")}
    state["step"] = json.loads((max(states).parent / "manifest.json").read_text())["step"]
    return state


def results(folder):
    """Files by their names in the run."""
    names = [name for name in TABLES if (folder / name).exists()]
    names += [str(path.relative_to(folder)) for path in sorted(folder.glob("snapshot_*.bin"))]
    for part in ("fields", "pictures"):
        names += [str(path.relative_to(folder)) for path in sorted((folder / part).rglob("*")) if path.is_file()]
    return names


def said(record, key):
    """What a record says of the body: neither how long it took nor how much of it rested, as each rank cuts
    other blocks."""
    value = record.get(key)
    if key == "phases":
        return [{k: v for k, v in phase.items() if k != "seconds"} for phase in value or []]
    if key == "skipped":
        return [part for part in value or [] if not part["why"].startswith("at rest")]
    return value


def differences(one, many):
    found = [name for name in sorted(set(results(one)) ^ set(results(many)))]
    for name in set(results(one)) & set(results(many)):
        if (one / name).read_bytes() != (many / name).read_bytes():
            found.append(name)
    first, second = (json.loads((folder / "run.json").read_text()) for folder in (one, many))
    found += [key for key in RECORDED if said(first, key) != said(second, key)]
    if first.get("status") == "done":
        first, second = (last_state(folder) for folder in (one, many))
        found += [f"last state, {name}" for name in set(first) | set(second) if first.get(name) != second.get(name)]
    return sorted(found)


def main():
    args = parse()
    rows, refused, wrong = [], [], False
    for scene in args.scenes:
        if is_study(scene):
            continue
        scene = scene.resolve()
        name = "/".join(scene.parts[-2:])
        code, answer = answer_of([args.program, "check", str(scene), "-n", "2", "--json"] + duration_of(scene, args.share))
        if code:
            reasons = sorted({f"{error.get('key', '')}: {error.get('message', error)}"
                              for error in answer.get("errors", [])})
            refused.append((name, "; ".join(reasons)))
            continue
        if args.list:
            print(name, flush=True)
            continue
        base = args.scratch / name.replace("/", "_").removesuffix(".json")
        one = base / "on_1"
        seconds, code = run(args, scene, one, 1)
        for n in args.ranks:
            many = base / f"on_{n}"
            seconds_many, code_many = run(args, scene, many, n)
            differs = (differences(one, many) if code == code_many and code in (0, 3)
                       else [f"exit codes {code} and {code_many}"])
            wrong = wrong or bool(differs)
            record = json.loads((one / "run.json").read_text())
            rows.append((name, n, record.get("particles"), record.get("steps"), record.get("broken_bonds"),
                         f"{seconds:.0f}", f"{seconds_many:.0f}", len(results(one)),
                         "yes" if last_state(one) else "no", "none" if not differs else ", ".join(differs[:6])))
            print(rows[-1], flush=True)
    if rows:
        print("\n| scene | ranks | particles | steps | broken | one process, s | ranks, s | files | last state | differences |")
        print("|---|---|---|---|---|---|---|---|---|---|")
        for row in rows:
            print("| " + " | ".join(str(cell) for cell in row) + " |")
    if refused:
        print("\n| refused on ranks | why |\n|---|---|")
        for name, why in refused:
            print(f"| {name} | {why} |")
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())
