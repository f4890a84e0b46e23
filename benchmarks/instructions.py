#!/usr/bin/env python3
"""instructions.py WORKLOAD COUNTS [--keep]: instructions a step, a call, a derivation, counted by valgrind's callgrind.

Each count is the difference of two runs, divided by the difference of their turns, so that start-up and set-up drop
out. Valgrind knows no AVX-512, and not all that compilers make of AVX2: plain code is counted. Counts depend on the
compiler, and are compared for the same one alone."""
import json, os, re, shutil, subprocess, sys, tempfile
from pathlib import Path

TOLERANCE = 0.03
WORK = [("steps", 2, 50, 250), ("steps", 8, 50, 250), ("steps", 100, 5, 15), ("forward", 2, 1000, 5000),
        ("forward", 100, 100, 500), ("derive", 8, 1, 3)]


def instructions(workload, what, links, count):
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out",
                             workload, what, str(links), str(count)],
                             capture_output=True, text=True, env=os.environ | {"MAUPERTUIS_INSTRUCTIONS": "none"})
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not found:
        sys.exit(f"{what} {links} failed under valgrind:\n{run.stderr}")
    return int(found.group(1))


def measure(workload):
    counts = {}
    for what, links, few, many in WORK:
        difference = instructions(workload, what, links, many) - instructions(workload, what, links, few)
        counts[f"{what} {links}"] = round(difference / (many - few))
    return counts


def compiler(workload):
    comment = subprocess.run(["readelf", "-p", ".comment", workload], capture_output=True, text=True).stdout
    return " ".join(sorted(set(re.findall(r"GCC: \([^)]*\) [\d.]+|clang version [\d.]+", comment))))


def main():
    if not shutil.which("valgrind"):
        sys.exit("instructions are not counted: valgrind is not installed")
    workload, path = sys.argv[1], Path(sys.argv[2])
    counts, built_by = measure(workload), compiler(workload)
    if "--keep" in sys.argv:
        path.write_text(json.dumps({"compiler": built_by, "counts": counts}, indent=2) + "\n")
    kept = json.loads(path.read_text())
    grown = []
    print("| work | instructions | kept | change |\n|---|---|---|---|")
    for name, count in counts.items():
        before = kept["counts"].get(name)
        change = count / before - 1 if before else 0
        print(f"| {name} | {count} | {before if before else 'new'} | {change:+.1%} |")
        if change > TOLERANCE:
            grown.append(name)
    if kept["compiler"] != built_by:
        print(f"Built by {built_by}, kept counts are of {kept['compiler']}: not compared.")
    elif grown:
        sys.exit(f"More than {TOLERANCE:.0%} above the kept counts: {', '.join(grown)}")


main()
