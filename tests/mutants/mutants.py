#!/usr/bin/env python3
"""Changes one line of the sources at a time, and tells whether the tests see it.

The tree and its build are read and never written: a mutant is compiled from a copy of its file, linked before the
library that holds the original, and run under a limit of processor time. What was found is kept in
build/mutants/found.jsonl, so that a
measurement goes on where it was interrupted. docs/design/mutants.md says what is measured and how.
"""
import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import sites
from suites import SUITES, suites_of
from trial import Build, Trial, run

MODULES = ["equations", "certificate", "symbolic", "system", "simulation", "verification", "integrator/taylor"]
MOST_READERS = 4  # a header that many files read would cost more than it tells
NO_RESULT = {"does not compile"}
TOOL = Path(__file__).resolve().parent


def options():
    p = argparse.ArgumentParser(prog="scripts/mutants", description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--count", type=int, default=200, help="mutants, the same number of every module (200)")
    p.add_argument("--seed", default="1744", help="of the draw (1744)")
    p.add_argument("--modules", default=",".join(MODULES), help="modules or files below src, by commas")
    p.add_argument("--without", default="", help="files below src that are left out, by commas")
    p.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at a time")
    p.add_argument("--tree", type=Path, default=TOOL.parents[1],
                   help="the sources (those that this program belongs to)")
    p.add_argument("--build", type=Path, help="their build by the preset `test` (TREE/build)")
    p.add_argument("--folder", type=Path, help="where what was found is kept (BUILD/mutants)")
    p.add_argument("--as-built", action="store_true", help="take the build as it is")
    p.add_argument("--again", action="store_true", help="those that survived once more, after new tests")
    p.add_argument("--list", action="store_true", help="name the mutants, try none")
    p.add_argument("--table", action="store_true", help="print what was found, try none")
    arguments = p.parse_args()
    arguments.build = arguments.build or arguments.tree / "build"
    arguments.folder = arguments.folder or arguments.build / "mutants"
    return arguments


def files_of(tree, module, without):
    here = tree / "src" / module
    found = [here] if here.is_file() else here.rglob("*.[ch]pp")
    return [str(f.relative_to(tree)) for f in sorted(found) if str(f.relative_to(tree / "src")) not in without]


class Draw:
    """The mutants of a module in the order in which they are tried, at most one of a line."""

    def __init__(self, tree, module, seed, without):
        texts = {f: (tree / f).read_text() for f in files_of(tree, module, without)}
        everything = sorted((m for f, text in texts.items() for m in sites.mutants(f, text)),
                            key=lambda m: m.order(seed))
        lines = {}
        for m in everything:
            lines.setdefault((m.path, m.line), m)
        self.all, self.texts = list(lines.values()), texts


class Ledger:
    """What was found, one line a mutant, by the mutant's name and the text of its file."""

    def __init__(self, path):
        self.path, self.lock, self.found = path, threading.Lock(), {}
        path.parent.mkdir(parents=True, exist_ok=True)
        for line in path.read_text().splitlines() if path.exists() else []:
            entry = json.loads(line)
            self.found[entry["name"], entry["file"]] = entry

    def get(self, mutant, text):
        return self.found.get((mutant.name, digest(text)))

    def add(self, mutant, text, verdict, by, detail):
        entry = {"name": mutant.name, "file": digest(text), "line": mutant.line, "kind": mutant.kind,
                 "verdict": verdict, "by": by, "detail": detail}
        with self.lock, self.path.open("a") as out:
            self.found[mutant.name, entry["file"]] = entry
            out.write(json.dumps(entry, ensure_ascii=False) + "\n")
        return entry


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def equivalents():
    """Changes that no test can see, each with its reason: a name, and below it, indented, why."""
    out, name = {}, None
    for line in (TOOL / "equivalent.txt").read_text().splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        if line[0] != " ":
            name = line.strip()
            out[name] = ""
        else:
            out[name] = f"{out[name]} {line.strip()}".strip()
    return out


def processor_limits(build, suites, keep):
    """Four times the processor time of the unchanged program, and 10 s; a suite that fails by itself judges nothing."""
    known = json.loads(keep.read_text()) if keep.exists() else {}
    for suite in suites:
        program = build.build / "bin" / suite.target
        stamp = program.stat().st_mtime
        if known.get(suite.name, [0])[0] == stamp:
            continue
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        word, detail = run(build, suite, program, 3600)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if word != "passed":
            sys.exit(f"{suite.name} does not pass on the unchanged tree: {detail}")
        known[suite.name] = [stamp, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime]
        print(f"{suite.name}: {known[suite.name][1]:.1f} s", file=sys.stderr)
    keep.write_text(json.dumps(known))
    return {suite.name: 10 + 4 * known[suite.name][1] for suite in suites}


def measure(module, wanted, draw, work):
    """Tries mutants of a module until `wanted` compile."""
    position, lock, counted = iter(draw.all), threading.Lock(), [0]

    def worker(number):
        trial = Trial(work.build, work.folder / f"trial-{os.getpid()}-{number}")
        while True:
            with lock:
                mutant = next(position, None) if counted[0] < wanted else None
                if mutant is None:
                    return
                if len(work.build.readers(mutant.path)) > MOST_READERS:
                    continue
                counted[0] += 1
            entry = work.judge(trial, mutant, draw.texts[mutant.path])
            if entry["verdict"] in NO_RESULT:
                with lock:
                    counted[0] -= 1

    with ThreadPoolExecutor(work.jobs) as pool:
        for done in [pool.submit(worker, i) for i in range(work.jobs)]:
            done.result()


class Work:
    def __init__(self, arguments, ledger, build, limits):
        self.folder, self.ledger, self.build, self.limits = arguments.folder, ledger, build, limits
        self.jobs, self.again, self.tried = arguments.jobs, arguments.again, set(equivalents())

    def judge(self, trial, mutant, text):
        known = self.ledger.get(mutant, text)
        # Or no test can see it.
        if known and (known["verdict"] != "survived" or not self.again or mutant.name in self.tried):
            return known
        self.tried.add(mutant.name)
        entry = self.ledger.add(mutant, text, *trial.judge(mutant, text, suites_of(mutant.path), self.limits))
        change = mutant.name.split(': ', 1)[1][:150]
        print(f"{entry['verdict']:<17}{mutant.path}:{mutant.line}: {change}   {entry['by']}", flush=True)
        return entry


def table(draws, wanted, ledger):
    """What was found of the draw, as Markdown; (killed, judged without equivalents)."""
    known, lists = equivalents(), {"Survivors": [], "Equivalent": []}
    print("| module | mutants | killed | equivalent | survived | killed of the others |")
    print("|---|---|---|---|---|---|")
    total = [0] * 4
    for module, draw in draws.items():
        judged = [e for m in draw.all if (e := ledger.get(m, draw.texts[m.path]))]
        entries = [e for e in judged if e["verdict"] not in NO_RESULT][:wanted[module]]
        killed = sum(e["verdict"] == "killed" for e in entries)
        same = [e for e in entries if e["verdict"] == "same code" or e["verdict"] == "survived" and e["name"] in known]
        left = [e for e in entries if e["verdict"] == "survived" and e["name"] not in known]
        row = [len(entries), killed, len(same), len(left)]
        total = [a + b for a, b in zip(total, row)]
        print_row(module, row)
        lists["Survivors"] += [f"- {e['name']}" for e in left]
        lists["Equivalent"] += [
            f"- {e['name']}: {known.get(e['name'], 'the compiler makes the same code')}" for e in same]
    print_row("**all**", total)
    for title, lines in lists.items():
        print(f"\n{title}:\n" + "\n".join(lines) if lines else f"\n{title}: none")
    return total[1], total[0] - total[2]


def print_row(name, row):
    others = row[0] - row[2]
    seen = f"{' | '.join(map(str, row))} | {100 * row[1] / others:.0f} %" if others else "0 | | | |"
    print(f"| {name} | {seen} |")


def main():
    arguments = options()
    modules = arguments.modules.split(",")
    without = set(filter(None, arguments.without.split(",")))
    draws = {module: Draw(arguments.tree, module, arguments.seed, without) for module in modules}
    wanted = {m: arguments.count // len(modules) + (i < arguments.count % len(modules)) for i, m in enumerate(modules)}
    if arguments.list:
        for module in modules:
            for m in draws[module].all[:wanted[module]]:
                print(f"{m.path}:{m.line}: {m.name.split(': ', 1)[1]}")
        return
    ledger = Ledger(arguments.folder / "found.jsonl")
    if not arguments.table:
        needed = {s.name: s for d in draws.values() for path in d.texts for s in suites_of(path)}
        if not arguments.as_built:
            targets = sorted({s.target for s in needed.values()})
            subprocess.run(["cmake", "--build", arguments.build, "--target", *targets],
                           check=True, stdout=subprocess.DEVNULL)
        build = Build(arguments.tree, arguments.build)
        limits = processor_limits(build, needed.values(), arguments.folder / "seconds.json")
        work = Work(arguments, ledger, build, limits)
        for module in modules:
            measure(module, wanted[module], draws[module], work)
    killed, judged = table(draws, wanted, ledger)
    sys.exit(0 if 10 * killed >= 9 * judged else 1)


if __name__ == "__main__":
    main()
