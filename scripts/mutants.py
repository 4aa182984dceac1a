#!/usr/bin/env python3
"""Whether the unit tests notice small faults: changes one place of a kernel at a time and runs them.

    scripts/mutants.py --seed 1 --number 50            # some minutes each
    scripts/mutants.py --seed 1 --number 50 --resume   # goes on after an interruption
    scripts/mutants.py --seed 1 --number 50 --list     # only says which they are

Works in a copy of the tree beside it (--scratch), and touches nothing else; --resume goes on with the
copy as it is, whatever has become of the tree. Results are appended to mutants.csv there as they come;
the table at the end is Markdown. A fault is "killed" by a test that
fails, crashes or takes too long, "survived" where all pass, "same code" where the compiler makes the
same programs of it, or "did not compile".
"""
import argparse
import csv
import hashlib
import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

FILES = ["dem/**/*.cc", "dem/**/*.h", "coupling/**/*.cc", "coupling/**/*.h", "particles/*.cc",
         "particles/*.h", "core/ranks*.cc", "core/ranks*.h", "packings/packing_part.cc"]

# Where a file begins with this, these targets are built and these ctests run, those first that end
# soonest where they notice a fault: one process stops at the first failure, ranks don't.
RANKS = ["test_ranks_on_2", "test_ranks_on_3"]
COUPLING = ["test_unit_coupling", "test_unit_coupling_crystal", "test_zone_parts"]
COUPLING_TESTS = ["test_unit_coupling", "test_unit_coupling_crystal", "test_zone_parts_on_2",
                  "test_zone_parts_on_3"]
TESTS = [("core/", ["test_ranks"], RANKS),
         ("packings/", ["test_packings", "test_ranks"], ["test_packings"] + RANKS),
         ("particles/orientation.h", COUPLING, COUPLING_TESTS),  # no other unit test includes it
         ("particles/", ["test_particles", "test_ranks", "test_dem"],
          ["test_particles", "test_dem"] + RANKS),
         ("dem/contacts.cc", ["test_ranks", "test_dem", "test_simulation"],
          ["test_dem", "test_simulation"] + RANKS),
         ("dem/", ["test_ranks", "test_dem"], ["test_dem"] + RANKS),
         ("coupling/fine_scale_split_static.cc", COUPLING + ["test_simulation"],
          COUPLING_TESTS + ["test_simulation"]),
         ("coupling/bridging_domain_static.cc", COUPLING + ["test_simulation"],
          COUPLING_TESTS + ["test_simulation"]),
         ("coupling/", COUPLING, COUPLING_TESTS)]

COLUMNS = ["number", "seed", "tree", "file", "line", "kind", "old", "new", "result", "by", "seconds"]


# --- which faults there are

def masked(text):
    """The text with comments, strings, characters and preprocessor lines as blanks."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*'
    blank = lambda found: re.sub(r"[^\n]", " ", found.group())
    return re.sub(pattern, blank, text, flags=re.DOTALL | re.MULTILINE)


def swapped(pairs):
    both = dict(pairs)
    both.update({new: old for old, new in pairs})
    return both


OPERATORS = [("plus", swapped([(" + ", " - "), (" += ", " -= ")])),
             ("comparison", swapped([(" < ", " <= "), (" > ", " >= "), (" == ", " != ")])),
             ("logic", swapped([(" && ", " || ")]))]


def other_number(text):
    """Another constant: whole numbers are one larger, others twice as large, zero is one."""
    if re.fullmatch(r"[0-9]+", text):
        return str(int(text) + 1)
    return "1." if float(text) == 0 else "(2 * %s)" % text


def faults_of(path, text):
    """All faults of one file as tuples (kind, file, begin, old, new); begin counts characters."""
    code = masked(text)
    for kind, others in OPERATORS:
        for old, new in others.items():
            for at in re.finditer(re.escape(old), code):
                yield kind, path, at.start(), old, new
    for at in re.finditer(r"(?<![\w.])(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+]?[0-9]+)?(?![\w.])", code):
        yield "constant", path, at.start(), at.group(), other_number(at.group())
    for at in re.finditer(r"(?<=[\w)\]])\[([^][&=,]+)\]", code):
        for step in (" + 1", " - 1"):
            yield "index", path, at.start(), at.group(), "[%s%s]" % (at.group(1), step)
    # A statement on a line of its own that assigns or calls, behind the end of another one.
    no_statement = r"(?!return|const|auto|using|case|break|continue|for|if|else|while|static|throw|template)"
    for at in re.finditer(r"(?<=[;{}]\n)[ ]+" + no_statement + r"[\w][^;{}\n]*(?:=|\()[^;{}\n]*;(?=\n)",
                          code):
        begin = at.start() + len(at.group()) - len(at.group().lstrip())
        yield "statement", path, begin, text[begin:at.end()], ";"


def drawn_faults(tree, patterns, seed):
    """All faults of the files in a random order, in which all kinds come equally often."""
    paths = sorted({p.relative_to(tree).as_posix() for g in patterns for p in tree.glob(g)})
    of_kind = {}
    for path in paths:
        for fault in faults_of(path, (tree / path).read_text()):
            of_kind.setdefault(fault[0], []).append(fault)
    draw = random.Random(seed)
    for kind in sorted(of_kind):
        of_kind[kind].sort()
        draw.shuffle(of_kind[kind])
    while of_kind:
        kinds = sorted(of_kind)
        draw.shuffle(kinds)
        for kind in kinds:
            yield of_kind[kind].pop()
            if not of_kind[kind]:
                del of_kind[kind]


# --- the copy of the tree

def source_files():
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=ROOT, check=True, capture_output=True).stdout.decode()
    return [p for p in listed.split("\0") if p and (ROOT / p).is_file()]


def copy_tree(tree):
    """Makes the copy equal to the tree; files that are equal keep their time. Returns a checksum."""
    sums = hashlib.sha256()
    names = sorted(source_files())
    for name in names:
        content = (ROOT / name).read_bytes()
        sums.update(name.encode() + b"\0" + content)
        target = tree / name
        if not target.exists() or target.read_bytes() != content:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
            shutil.copymode(ROOT / name, target)
    kept = set(names)
    for path in list(tree.rglob("*")):
        name = path.relative_to(tree).as_posix()
        if path.is_file() and name not in kept and not name.startswith("build/"):
            path.unlink()
    return sums.hexdigest()[:12]


def write_whole(path, text):
    """In one step, whenever the process ends."""
    part = path.with_suffix(".part")
    part.write_text(text)
    os.replace(part, path)


class Timeout(Exception):
    pass


def run(command, cwd, limit, log, variables=()):
    """The exit code of one command, see run_beside."""
    return run_beside([command], cwd, limit, log, [variables])


def run_beside(commands, cwd, limit, log, variables):
    """Runs commands at once, each with its own variables: 0, or the exit code of the first to fail,
    which ends the others. Ends all with what they started when they take longer (s)."""
    end = time.time() + limit
    with open(log, "ab") as out:
        processes = [subprocess.Popen(c, cwd=cwd, stdout=out, stderr=out, start_new_session=True,
                                      env=dict(os.environ, **dict(v.split("=", 1) for v in own)))
                     for c, own in zip(commands, variables)]
        try:
            while True:
                codes = [p.poll() for p in processes]
                failed = [c for c in codes if c]
                if failed or None not in codes:
                    return failed[0] if failed else 0
                if time.time() > end:
                    raise Timeout()
                time.sleep(0.1)
        finally:
            for process in processes:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGTERM)
                    try:
                        process.wait(10)
                    except subprocess.TimeoutExpired:
                        os.killpg(process.pid, signal.SIGKILL)
                        process.wait()


class Bench:
    """Builds and runs the tests of the copy."""

    def __init__(self, scratch, jobs, build_limit):
        self.tree = scratch / "tree"
        self.build = self.tree / "build" / "release"
        self.log = scratch / "mutants.log"
        self.original = scratch / "original.json"  # of the file that has a fault
        self.jobs, self.build_limit = jobs, build_limit
        self.seconds, self.sums = {}, {}  # of tests and programs without a fault
        self.commands = {}  # of ctests

    def configure(self):
        command = ["cmake", "--preset", "release"]  # as ever, so that what a compiler cache has is used
        if shutil.which("ccache"):
            command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        if run(command, self.tree, 600, self.log) != 0:
            sys.exit("error: cmake failed, see %s" % self.log)

    def make(self, targets):
        return run(["ninja", "-C", str(self.build), "-j%d" % self.jobs] + targets, self.tree,
                   self.build_limit, self.log) == 0

    def sum_of(self, target):
        return hashlib.sha256((self.build / "bin" / target).read_bytes()).hexdigest()

    def passes(self, test, limit):
        """Runs what ctest would run, whose own limit of time is a long one."""
        if "command" not in self.commands.get(test, {}):  # programs that aren't built have none
            shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.build, check=True,
                                   capture_output=True).stdout
            self.commands = {t["name"]: t for t in json.loads(shown)["tests"]}
        command = self.commands[test]["command"]
        of = {p["name"]: p["value"] for p in self.commands[test]["properties"]}
        if re.search(r"_on_[0-9]+$", test):  # all ranks must run the same tests, to their ends
            return run(command, of["WORKING_DIRECTORY"], limit, self.log, of["ENVIRONMENT"]) == 0
        parts = [of["ENVIRONMENT"] + ["GTEST_FAIL_FAST=1", "GTEST_TOTAL_SHARDS=%d" % self.jobs,
                                      "GTEST_SHARD_INDEX=%d" % i] for i in range(self.jobs)]
        return run_beside([command] * self.jobs, of["WORKING_DIRECTORY"], limit, self.log, parts) == 0

    def measure(self, path):
        """Builds and runs what the file's faults need, once without any."""
        targets, tests = tests_of(path)
        if not all(t in self.sums for t in targets):
            if not self.make(targets):
                sys.exit("error: the tree without faults does not compile, see %s" % self.log)
            self.sums.update({t: self.sum_of(t) for t in targets})
        for test in tests:
            if test not in self.seconds:
                start = time.time()
                try:
                    good = self.passes(test, 3600)
                except Timeout:
                    good = False
                if not good:
                    sys.exit("error: %s fails without a fault, see %s" % (test, self.log))
                self.seconds[test] = time.time() - start

    def judge(self, fault):
        """(result, the test that noticed it) of a fault, which is in the copy for that time only."""
        kind, path, begin, old, new = fault
        targets, tests = tests_of(path)
        file = self.tree / path
        text = file.read_text()
        assert text[begin:begin + len(old)] == old
        write_whole(self.original, json.dumps([path, text]))
        file.write_text(text[:begin] + new + text[begin + len(old):])
        try:
            if not self.make(targets):
                return "did not compile", ""
            if all(self.sum_of(t) == self.sums[t] for t in targets):
                return "same code", ""
            for test in tests:
                try:
                    if not self.passes(test, 3 * self.seconds[test] + 30):
                        return "killed", test
                except Timeout:
                    return "killed", test + " (time)"
            return "survived", ""
        except Timeout:
            return "did not compile", "time"
        finally:
            self.restore()

    def restore(self):
        """Takes back the fault that is in the copy, if any is: also after a sudden end."""
        if self.original.exists():
            path, text = json.loads(self.original.read_text())
            (self.tree / path).write_text(text)
            self.original.unlink()


def tests_of(path):
    for begin, targets, tests in TESTS:
        if path.startswith(begin):
            return targets, tests
    sys.exit("error: no test is known for %s: add its folder to TESTS" % path)


# --- results

def read_results(file, seed):
    if not file.exists():
        sys.exit("error: there is no %s to go on with; leave out --resume" % file)
    with open(file, newline="") as rows:
        results = [r for r in csv.DictReader(rows) if r.get("seconds")]  # a cut last row is none
    for row in results:
        if row["seed"] != str(seed):
            sys.exit("error: %s is of seed %s; give that, or another --scratch" % (file, row["seed"]))
    return results


def write_results(file, results):
    """All of them anew, so that a cut row is gone."""
    out = io.StringIO(newline="")
    writer = csv.DictWriter(out, COLUMNS)
    writer.writeheader()
    writer.writerows(results)
    write_whole(file, out.getvalue())


def one_line(text):
    return " ".join(text.split())


def print_table(results):
    words = ["killed", "survived", "same code", "did not compile"]
    for title, key in (("kind", lambda r: r["kind"]), ("folder", lambda r: r["file"].split("/")[0])):
        print("\n| %s | %s |\n|---|%s" % (title, " | ".join(words), "---|" * len(words)))
        names = sorted({key(r) for r in results})
        for name in names + ["all"]:
            counts = [sum(r["result"] == w and name in (key(r), "all") for r in results) for w in words]
            print("| %s | %s |" % (name, " | ".join(map(str, counts))))
    survivors = [r for r in results if r["result"] == "survived"]
    if survivors:
        print("\n| survived | place | was | became |\n|---|---|---|---|")
    for r in survivors:
        cells = [one_line(r[c]).replace("|", "\\|") for c in ("old", "new")]
        print("| %s | %s:%s | `%s` | `%s` |" % (r["number"], r["file"], r["line"], *cells))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--number", type=int, required=True, help="how many faults are drawn")
    parser.add_argument("--scratch", type=Path, default=ROOT.parent / (ROOT.name + "-mutants"))
    parser.add_argument("--files", nargs="+", default=FILES, help="patterns of files below the root")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--build-limit", type=float, default=3600, help="s for one build")
    parser.add_argument("--resume", action="store_true", help="go on with mutants.csv")
    parser.add_argument("--list", action="store_true", help="say which faults, and stop")
    line = parser.parse_args()
    signal.signal(signal.SIGTERM, signal.default_int_handler)

    if line.list:
        for number, fault in zip(range(line.number), drawn_faults(ROOT, line.files, line.seed)):
            print(number, fault[1], fault[0], one_line(fault[3]), "->", one_line(fault[4]))
        return
    scratch = line.scratch.resolve()
    if scratch == ROOT or ROOT in scratch.parents:
        sys.exit("error: --scratch lies in the tree; it would copy itself")
    bench = Bench(scratch, line.jobs, line.build_limit)
    file, measured = scratch / "mutants.csv", scratch / "measured.json"
    if line.resume:
        results = read_results(file, line.seed)
        bench.restore()
        tree, bench.seconds, bench.sums = json.loads(measured.read_text())
    else:
        results = []
        bench.tree.mkdir(parents=True, exist_ok=True)
        bench.original.unlink(missing_ok=True)
        tree = copy_tree(bench.tree)
        write_whole(measured, json.dumps([tree, {}, {}]))
    write_results(file, results)
    done = {int(r["number"]) for r in results}
    bench.configure()
    try:
        for number, fault in zip(range(line.number), drawn_faults(bench.tree, line.files, line.seed)):
            if number in done:
                continue
            kind, path, begin, old, new = fault
            bench.measure(path)
            write_whole(measured, json.dumps([tree, bench.seconds, bench.sums]))
            start = time.time()
            at = (bench.tree / path).read_text().count("\n", 0, begin) + 1
            result, by = bench.judge(fault)
            row = dict(zip(COLUMNS, [number, line.seed, tree, path, at, kind, old, new, result, by,
                                     "%.0f" % (time.time() - start)]))
            results.append({k: str(v) for k, v in row.items()})
            with open(file, "a", newline="") as out:
                csv.DictWriter(out, COLUMNS).writerow(row)
            print("%d %s:%d %s: %s -> %s: %s %s, %s s" %
                  (number, path, at, kind, one_line(old), one_line(new), result, by, row["seconds"]),
                  flush=True)
    except KeyboardInterrupt:
        print("interrupted: go on with --resume", file=sys.stderr)
    print_table(results)


if __name__ == "__main__":
    main()
