#!/usr/bin/env python3
"""Lines that ran, per folder, from the counters that programs of an instrumented build left.

    scripts/coverage_table.py build/coverage     (GCC: what gcov says)
    scripts/coverage_table.py build/trust        (Clang: what llvm-cov says)

A line counts once, however many programs and instances of a template have it: it ran when any of
them ran it. Prints a table in Markdown, and writes coverage.csv into the build folder.
"""
import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def counts_by_gcov(build):
    """(file, line, count) of all object files."""
    for gcda in sorted(build.rglob("*.gcda")):
        if gcda.with_suffix(".gcno").stat().st_mtime > gcda.stat().st_mtime:
            print("%s is older than its object file: left out" % gcda, file=sys.stderr)
            continue
        text = subprocess.run(["gcov", "--json-format", "--stdout", str(gcda)], cwd=gcda.parent,
                              capture_output=True, text=True, check=True).stdout
        for document in text.splitlines():
            data = json.loads(document)
            folder = Path(data["current_working_directory"])
            for file in data["files"]:
                for line in file["lines"]:
                    yield (folder / file["file"]).resolve(), line["line_number"], line["count"]


def llvm_tool(name):
    for candidate in [name] + ["%s-%d" % (name, version) for version in range(25, 13, -1)]:
        if shutil.which(candidate):
            return candidate
    sys.exit("error: no %s: install the package llvm" % name)


def counts_by_llvm(build, profiles):
    """The same of all programs; each counts for itself."""
    merged = build / "all.profdata"
    subprocess.run([llvm_tool("llvm-profdata"), "merge", "-sparse", "-o", str(merged)]
                   + [str(p) for p in profiles], check=True)
    for program in sorted((build / "bin").iterdir()):
        found = subprocess.run([llvm_tool("llvm-cov"), "export", "-format=lcov",
                                "-instr-profile=%s" % merged, str(program)],
                               capture_output=True, text=True)
        if found.returncode != 0:  # a program without counters
            continue
        file = None
        for row in found.stdout.splitlines():
            if row.startswith("SF:"):
                file = Path(row[3:]).resolve()
            elif row.startswith("DA:"):
                line, count = row[3:].split(",")[:2]
                yield file, int(line), int(count)


def main():
    build = Path(sys.argv[1]).resolve()
    profiles = sorted(build.rglob("*.profraw"))
    ran = {}  # by file and line
    for file, line, count in counts_by_llvm(build, profiles) if profiles else counts_by_gcov(build):
        if ROOT in file.parents and build not in file.parents:
            lines = ran.setdefault(file.relative_to(ROOT).as_posix(), {})
            lines[line] = lines.get(line, 0) + count
    if not ran:
        sys.exit("error: no counters in %s: run its tests first" % build)
    folders = {}
    with open(build / "coverage.csv", "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["file", "lines", "ran", "first lines that did not"])
        for file, lines in sorted(ran.items()):
            missed = sorted(n for n, count in lines.items() if count == 0)
            writer.writerow([file, len(lines), len(lines) - len(missed), " ".join(map(str, missed[:20]))])
            sums = folders.setdefault(file.rsplit("/", 1)[0], [0, 0])
            sums[0] += len(lines)
            sums[1] += len(lines) - len(missed)
    print("| folder | lines | ran | share |\n|---|---|---|---|")
    for folder, (lines, good) in sorted(folders.items()):
        if not folder.startswith("tests"):
            print("| %s | %d | %d | %.1f %% |" % (folder, lines, good, 100 * good / lines))


if __name__ == "__main__":
    main()
