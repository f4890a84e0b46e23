#!/usr/bin/env python3
"""Turns the reference cases (tests/problems/cases/*.json) into models with `expect` lines (tests/problems/*.lag).

    scripts/convert_cases.py            write the models and docs/reference_cases.md
    scripts/convert_cases.py --check    fail if a file on disk differs from what would be written

A case becomes a model when its statement needs nothing that the language does not carry out yet; every expectation that
has a line of the language becomes one, the others are listed in docs/reference_cases.md with what they wait for.
"""
import copy
import json
import pathlib
import re
import sys
import textwrap

import case_math
from case_math import D, parse
from case_model import Model, tolerance
from case_tables import MORE, REWRITTEN, VARIANTS, WAITS
from convert_urdf import urdf_model

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "tests/problems/cases"
MODELS = ROOT / "tests/problems"
TABLE = ROOT / "docs/reference_cases.md"


def needed(case):
    """What the statement itself waits for: empty when it is a model of the language today."""
    statement = case["statement"]
    if "data_file" in statement:
        return "URDF import"
    if "fields" in statement or case.get("kind") == "field":
        return "fields"
    if "inequality" in statement.get("constraints", {}):
        return "contacts"
    if "quasi_velocities" in statement:
        return "rates"
    if case.get("kind") == "degenerate":
        return "degenerate"
    kinds = {e["kind"] for e in case["expected"]}
    return "" if kinds - set(WAITS) - {"note"} else WAITS[case["expected"][0]["kind"]]


def is_other_motion(case, expectation):
    """A closed form that does not start where the case does (or the case says no start) is a model of its own."""
    if expectation["kind"] != "analytic":
        return False
    start = case["statement"].get("initial")
    if not start:
        return True
    model = Model(case)
    values = model.constants(expectation)
    at_start = lambda text: case_math.evaluate(parse(text), {**values, "t": D(0)})
    slope = lambda text: case_math.derivative(parse(text), values, D(0))
    known = {name: case_math.evaluate(parse(text), values) for part in ("q", "dot") for name, text in
             ((f"{part} {n}", x) for n, x in start[part].items())}
    return any(abs(at_start(text) - known["q " + name]) > D("1e-12")
               or abs(slope(text) - known["dot " + name]) > D("1e-12")
               for name, text in expectation["values"].items())


def with_integral(case, expectation):
    """The same problem with one coordinate more, W, whose rate is the integrand: massless, its equation says λ = 0."""
    other = copy.deepcopy(case)
    statement = other["statement"]
    statement["coordinates"].append("W")
    statement["constraints"]["nonholonomic"] = [f"dot(W)-({expectation['expression']})"]
    statement["initial"]["q"]["W"] = statement["initial"]["dot"]["W"] = "0"
    end = re.search(r"over \[0,(\d+)\]", expectation["quantity"])[1]
    model = Model(other)
    model.write("_integral")
    model.claims = []
    model.add(f"# {expectation['quantity']}: a coordinate without inertia, whose constraint takes no force (Chetaev)")
    model.value(("name", "W"), end, D(expectation["value_recomputed"]), tolerance(expectation))
    return {f"{case['id']}_integral.lag": model.text()}


def with_initial_check(case, expectation):
    """Only the first velocity is written; the others must follow from the constraints."""
    other = copy.deepcopy(case)
    rates = other["statement"]["initial"]["dot"]
    for name in list(rates)[1:]:
        rates[name] = "0"
    model = Model(other)
    model.write("_start")
    model.add(f"# {expectation['quantity']}")
    for name, value in expectation["values"].items():
        if isinstance(value, str):
            model.value(parse(name), "0", D(value), "± 1e-14")
        else:  # R turns the body's rates to the axes of the world
            for i, component in enumerate(value, 1):
                model.add(f"expect R{i}1 wx + R{i}2 wy + R{i}3 wz at 0 s = {component} rad/s ± 1e-14")
    return {f"{case['id']}_start.lag": model.text()}


def variant(case, quantity):
    """The same system with other values, for what it says of an equilibrium."""
    suffix, formulas, start, lines = VARIANTS[case["id"]][quantity]
    other = copy.deepcopy(case)
    for name, formula in formulas.items():
        other["statement"]["parameters"][name] = {"value": formula, "unit": "1"}
    if start:
        other["statement"].pop("initial", None)
    model = Model(other)
    model.write(suffix)
    model.claims = []
    if start:
        model.add(f"start {start}")
    model.add()
    model.add(f"# {quantity}")
    for line in lines:
        model.add("expect " + line)
    return {f"{case['id']}{suffix}.lag": model.text()}


def rewritten(case, quantity):
    """The same system in other coordinates."""
    suffix, text = REWRITTEN[case["id"]][quantity]
    model = Model(case)
    model.add(f"# Generated from tests/problems/cases/{case['id']}.json by scripts/convert_cases.py: do not edit.")
    model.add(f"system {case['id']}{suffix} \"{case['title']}\"")
    model.add(f"source \"{case['source']['where']}\"")
    return {f"{case['id']}{suffix}.lag": "\n".join(model.lines) + "\n\n" + text}


WITH = {"integral": with_integral, "initial_check": with_initial_check}


def convert(case):
    """({file name: text}, passing expectations, [(expectation, capability)]) of a case."""
    others = [e for e in case["expected"] if is_other_motion(case, e)]
    main, more = Model(case), {}
    main.write()
    for expectation in case["expected"]:
        if expectation in others or (case["id"] in MORE and expectation["kind"] in ("scalar", "scalars", "expression")):
            continue
        if expectation["quantity"] in VARIANTS.get(case["id"], {}):
            more.update(variant(case, expectation["quantity"]))
            main.passes.append(expectation["quantity"])
        elif expectation["quantity"] in REWRITTEN.get(case["id"], {}):
            more.update(rewritten(case, expectation["quantity"]))
            main.passes.append(expectation["quantity"])
        elif expectation["kind"] in WITH:
            more.update(WITH[expectation["kind"]](case, expectation))
            main.passes.append(expectation["quantity"])
        else:
            main.expect(expectation)
    if case["id"] in MORE:
        title, lines = MORE[case["id"]]
        main.add(f"# {title}")
        for line in lines:
            main.add("expect " + line)
            if " at " in line:
                main.end = max(main.end, D(re.search(r" at (\S+)", line)[1]))
        main.passes.append(title)
    files = {f"{case['id']}.lag": main.text(), **more}
    for i, expectation in enumerate(others):
        suffix = "_closed_form" if len(others) == 1 else f"_closed_form_{i + 1}"
        other = Model(case)
        other.write(suffix, expectation)
        other.expect(expectation)
        files[f"{case['id']}{suffix}.lag"] = other.text()
        main.passes += other.passes
    return files, main.passes, main.waits


def convert_all():
    """{path: text} of every file that this script writes."""
    files, rows = {}, []
    for path in sorted(CASES.glob("*.json")):
        case = json.loads(path.read_text(encoding="utf-8"))
        missing = needed(case)
        if missing == "URDF import":
            texts = urdf_model(case, CASES)
            passes = ["the accelerations that the torques of the inverse dynamics, and at rest M q̈ + g, give"]
            waits = [("reading the robot's file", "URDF import"), ("M entry by entry", WAITS["matrix"])]
        elif missing in ("contacts", "rates", "fields", "degenerate") \
                and (MODELS / path.with_suffix(".lag").name).exists():
            models = sorted(p.name for p in MODELS.glob(f"{path.stem}*.lag"))
            models = models if missing in ("rates", "degenerate") else models[:1]
            rows.append((case, models, ["all; the model is written by hand"], []))
            continue
        elif missing:
            texts, passes, waits = {}, [], [("all", missing)]
        else:
            texts, passes, waits = convert(case)
        for name, text in texts.items():
            files[MODELS / name] = text
        rows.append((case, sorted(texts), passes, waits))
    files[TABLE] = table(rows)
    return files


def table(rows):
    full = sum(1 for _, models, _, waits in rows if models and not waits)
    part = sum(1 for _, models, _, waits in rows if models and waits)
    text = (f"{len(rows)} problems from the literature and from the published tests of other systems; the statements "
            f"and values are in `tests/problems/cases/`. {full} pass whole, {part} in part, "
            f"{len(rows) - full - part} wait for a capability. A case that passes is a model in `tests/problems/`, run "
            "by `maup test`; both the models and this page are generated by `scripts/convert_cases.py`.")
    lines = ["# Reference cases", "", *textwrap.wrap(text, 120, break_on_hyphens=False), "",
             "| case | model | passes | waits for |", "|---|---|---|---|"]
    for case, models, passes, waits in rows:
        names_of = ", ".join(f"[{m[:-4]}](../tests/problems/{m})" for m in models) or "–"
        wait = "; ".join(capability if what == "all" else f"{capability}: {what}" for what, capability in waits) or "–"
        done = "; ".join(passes) or "–"
        title, done, wait = (text.replace('|', '∣') for text in (case['title'], done, wait))
        lines.append(f"| {title} | {names_of} | {done} | {wait} |")
    return "\n".join(lines) + "\n"


def main():
    files = convert_all()
    if "--check" in sys.argv:
        stale = [p for p, text in files.items() if not p.exists() or p.read_text(encoding="utf-8") != text]
        for path in stale:
            print(f"{path.relative_to(ROOT)} differs: run scripts/convert_cases.py", file=sys.stderr)
        sys.exit(1 if stale else 0)
    for path, text in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    print(f"{len(files)} files written")


if __name__ == "__main__":
    main()
