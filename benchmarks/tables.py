#!/usr/bin/env python3
"""tables.py FOLDER: the tables of docs/benchmarks.md from what scripts/bench has measured there, and all of it in
FOLDER/measured.json."""
import json, math, statistics, sys
from pathlib import Path


def google(folder, program):
    """{name: counters} of the medians over repetitions; a benchmark with an error has {"error": message}."""
    try:
        rows = json.loads((folder / f"{program}.json").read_text())["benchmarks"]
    except (OSError, ValueError):
        return {}
    found = {}
    for row in rows:
        name = row["run_name"].removesuffix("/repeats:7")
        if row.get("error_occurred"):
            found[name] = {"error": row["error_message"]}
        elif row.get("aggregate_name") == "median":
            known = ("name", "family_index", "per_family_instance_index", "repetitions", "threads", "iterations")
            found[name] = {key: value for key, value in row.items()
                           if key not in known and not key.startswith(("run_", "aggregate"))}
    return found


def lines(path):
    try:
        return [json.loads(line) for line in path.read_text().splitlines()]
    except (OSError, ValueError):
        return []


def collect(folder):
    data = {program: google(folder, program)
            for program in ("peak", "stepping", "ensemble", "forward_dynamics", "peers")}
    data["first_step"] = lines(folder / "first_step.txt")
    data["derivation"] = (lines(folder / "derivation.txt") or [None])[0]
    return data


def time(seconds):
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def step_rows(data, backend, order=0):
    """{links: counters} of one backend; order 0: the one that follows from the tolerance."""
    rows = {}
    for name, row in data["stepping"].items():
        if name.startswith(f"steps/{backend}/") and name.endswith(f"/order:{order}"):
            rows[int(name.split("links:")[1].split("/")[0])] = row
    return rows


def peak(data):
    return max((row["flops"] for row in data["peak"].values() if "flops" in row), default=None)


def useful_flops(links, order):
    """Of the convolutions alone: four a link, 2 (k + 1) operations at order k."""
    return 4 * links * (order + 1) * (order + 2)


def verdict(value, reach):
    return "" if value <= reach else f" ({value / reach:.1f} ×)"


def print_row(what, value, reach, remark="", show=time):
    print(f"| {what} | {show(value)}{verdict(value, reach)} | {show(reach)} | {remark} |")


def missing(what, why="not measured"):
    print(f"| {what} | {why} | | |")


def print_steps(data):
    reaches = {"compiled": {1: 0.20e-6, 2: 0.38e-6, 4: 0.60e-6, 8: 0.95e-6, 32: 3.5e-6, 100: 14e-6},
               "interpreter": {8: 1.6e-6, 100: 50e-6}}
    top = peak(data)
    for backend, sizes in reaches.items():
        rows = step_rows(data, backend)
        for links, reach in sizes.items():
            what = f"n={links}, {'a step' if backend == 'compiled' else 'a step by the interpreter alone'}"
            row = rows.get(links, {})
            if "step" not in row:
                missing(what, row.get("error", "not measured"))
                continue
            share = f", {useful_flops(links, row['order']) / row['step'] / top:.1%} of the peak" if top else ""
            by = ", by the interpreter" if backend == "compiled" and row["label"] != "compiled" else ""
            print_row(what, row["step"], reach, f"energy {row['energy_drift']:.1e}{share}{by}")
    for order, what in ((0, "n=2, 1000 s of motion"), (26, "the same at order 26")):
        row = step_rows(data, "compiled", order).get(2, {})
        if "step" in row:
            print_row(what, row["cpu_time"] * 1e-3, 16e-3, f"energy {row['energy_drift']:.1e}, at most 2e-12")


def print_batches(data):
    for links, order, reach in ((2, 0, 270e3), (2, 26, 270e3), (4, 0, 60e3), (4, 26, 60e3)):
        ours = lambda name: f"links:{links}/" in name and name.endswith(f"/order:{order}")
        rates = {name.removesuffix(f"/order:{order}"): row["trajectory_seconds_per_second"]
                 for name, row in data["ensemble"].items()
                 if ours(name) and "trajectory_seconds_per_second" in row}
        what = f"n={links} batch, one core, trajectory·s/s" if order == 0 else f"the same at order {order}"
        if not rates:
            missing(what)
            continue
        best = max(rates, key=rates.get)
        remark = best.removeprefix("ensemble/").replace("/links", ", links")
        remark = remark.replace(f", links:{links}/width:", ", width ")
        short = "" if rates[best] >= reach else f" ({reach / rates[best]:.1f} × below)"
        print(f"| {what} | {rates[best]:,.0f}{short} | {reach:,.0f} | {remark} |")


def print_first_steps(data):
    for links, reach in ((2, 0.060), (8, 0.090), (100, 0.6)):
        rows = [row for row in data["first_step"] if row["links"] == links]
        what = f"n={links}, model text to first compiled step"
        if not rows:
            missing(what)
            continue
        remark = ("processor time of a whole process" if rows[0]["compiled"] else
                  "no compiled code for this size: the interpreter's step")
        print_row(what, statistics.median(row["cpu_seconds"] for row in rows), reach, remark)


def print_forward(data):
    rows = data["forward_dynamics"]
    for name, what, reach in (("chain/2", "chain n=2", 28e-9), ("chain/20", "chain n=20", 0.8e-6),
                              ("chain/100", "chain n=100", 5e-6),
                              ("arm", "arm with 7 joints", 0.29e-6)):
        compiled, interpreted = rows.get("compiled_" + name, {}), rows.get(name, {})
        if "cpu_time" not in compiled or "cpu_time" not in interpreted:
            missing(f"forward dynamics, {what}", compiled.get("error", "not measured"))
        else:
            remark = f"the interpreter {time(interpreted['cpu_time'] * 1e-9)}"
            print_row(f"forward dynamics, {what}", compiled["cpu_time"] * 1e-9, reach, remark)


def print_exponent(data):
    rows = step_rows(data, "compiled")
    points = [(math.log(n), math.log(rows[n]["step"])) for n in sorted(rows) if n >= 50 and "step" in rows[n]]
    if len(points) < 2:
        missing("cost a step against n, 50 → 1000 links")
        return
    x, y = [p[0] for p in points], [p[1] for p in points]
    slope = statistics.linear_regression(x, y).slope
    print_row("cost a step against n, 50 → 1000 links, exponent", slope, 1.2, show=lambda value: f"{value:.2f}")


def print_peers(data):
    print("\n| 100 s of the double pendulum | error of the energy | a second of motion |\n|---|---|---|")
    for name, row in data["peers"].items():
        who, digits = name.removeprefix("motion/").split("/digits:")
        if "error" in row:
            print(f"| {who}, 1e-{digits} | {row['error']} | |")
        else:
            print(f"| {who}, 1e-{digits} | {row['energy_error']:.1e} | {time(row['second_of_motion'])} |")
    if not any("cvode" in name for name in data["peers"]):
        print("| CVODE | skipped: SUNDIALS 6 is not installed | |")
    print("\n| accelerations of the chain | compiled | interpreted | MuJoCo's mj_forward |\n|---|---|---|---|")
    forward = data["forward_dynamics"]
    if not any(name.startswith("mujoco/") for name in forward):
        print("| MuJoCo | skipped: libmujoco-dev is not installed | | |")
    for name, row in forward.items():
        if name.startswith("mujoco/") and "cpu_time" in row:
            ours = [forward.get(name.replace("mujoco", who), {}) for who in ("compiled_chain", "chain")]
            cells = [time(mine["cpu_time"] * 1e-9) if "cpu_time" in mine else "not measured" for mine in ours]
            print(f"| n={name.split('/')[1]} | {' | '.join(cells)} | {time(row['cpu_time'] * 1e-9)} |")
    print("\n| derivation of the chain | `maup derive`, whole process | SymPy's LagrangesMethod |\n|---|---|---|")
    if data["derivation"] is None:
        print("| SymPy | skipped: python3-sympy is not installed | |")
    else:
        for row in data["derivation"]["rows"]:
            print(f"| n={row['links']} | {time(row['maup_seconds'])} | {time(row['sympy_seconds'])} |")


def main():
    folder = Path(sys.argv[1])
    data = collect(folder)
    (folder / "measured.json").write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n")
    for name, row in data["peak"].items():
        print(f"{name}: {row['flops'] / 1e9:.0f} GFLOP/s" if "flops" in row else f"{name}: {row['error']}")
    print("\n| what | measured | to reach | |\n|---|---|---|---|")
    for section in (print_steps, print_batches, print_first_steps, print_forward, print_exponent):
        section(data)
    print_peers(data)
    wrong = [f"{program}/{name}" for program, rows in data.items() if isinstance(rows, dict) and program != "derivation"
             for name, row in rows.items() if "error" in row and row["error"] != "the processor lacks it"]
    sys.exit(f"failed: {', '.join(wrong)}" if wrong else 0)


main()
