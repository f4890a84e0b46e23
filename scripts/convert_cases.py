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

import case_math
from case_math import D, greek, parse, show, show_long
from convert_urdf import urdf_model, wrapped
from precise import ellipk

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "tests/problems/cases"
MODELS = ROOT / "tests/problems"
TABLE = ROOT / "docs/reference_cases.md"

# The cases do not say what kind of quantity a coordinate is: here for the cases with units; the others are dimensionless.
KINDS = {
    "bead_rotating_hoop": {"theta": "angle"},
    "celest_kepler_e06": {"x": "length", "y": "length"},
    "double_atwood": {"x": "length", "y": "length"},
    "double_pendulum_equal": {"q1": "angle", "q2": "angle"},
    "elastic_pendulum": {"r": "length", "theta": "angle"},
    "electro_condenser_microphone": {"q": "charge", "x": "length"},
    "electro_dc_motor": {"q": "charge", "theta": "angle"},
    "foucault_linear": {"x": "length", "y": "length"},
    "gear_planetary_ring_fixed": dict.fromkeys(("ts", "tr", "tc", "tp"), "angle"),
    "iftomm_a01_pendulum": {"x": "length", "y": "length"},
    "iftomm_a05_flyball": {"phi": "angle", "b1": "angle", "b2": "angle", "s": "length"},
    "iftomm_spatial_slider_crank": {"th": "angle", "s": "length", "a1": "angle", "a2": "angle", "a3": "angle"},
    "ivp_andrews": dict.fromkeys(("beta", "theta", "gamma", "phi", "delta", "omega", "epsilon"), "angle"),
    "lagrange_top": {"theta": "angle", "phi": "angle", "psi": "angle"},
    "noether_caldirola_kanai": {"x": "length"},
    "nonhol_knife_edge": {"x": "length", "y": "length", "phi": "angle"},
    "nonhol_rolling_disc": {"x": "length", "y": "length", "q1": "angle", "q2": "angle", "q3": "angle"},
    "sympy_four_bar_linkage": {"q1": "angle", "q2": "angle", "q3": "angle"},
}
UNITS = {"angle": ("rad", "rad/s", "rad/s^2"), "length": ("m", "m/s", "m/s^2"), "charge": ("C", "A", "A/s")}
MULTIPLIER_UNIT = {"ivp_andrews": "N", "iftomm_a01_pendulum": "N/m"}

# Numbers of a statement that carry a unit which the statement leaves unsaid.
UNSAID = {"iftomm_a05_flyball": {"0.3*wd^2/6": "0.3 [kg] wd^2/6"}}

# What a case states as a scalar, an expression or an integral and what the language says otherwise.
MORE = {
    "gear_planetary_ring_fixed": ("Willis: the ratio of sun and carrier, the speed of the planets",
                                  ["equation ts'' = (1 + rr/rs) tc''", "equation tp'' = (1 - rr/rp) tc''"]),
    "iftomm_a01_pendulum": ("the period; the tension in the rod, -3 m g y/L = -2 L λ, at the turning points and at the bottom",
                            ["energy conserved rel 5e-14   # of the sum of its terms: 1e-12 J",
                             "x at 2.3678419475762374493 s = -1 m ± 1e-11", "y at 2.3678419475762374493 s = 0 m ± 1e-11",
                             "-2 L multiplier(c1) at 0 s = 0 N ± 1e-11",
                             "-2 L multiplier(c1) at 0.591960486894059362 s = 29.43 N ± 1e-10",
                             "-2 L multiplier(c1) at 1.18392097378811872 s = 0 N ± 1e-10"]),
    "celest_kepler_e06": ("the period 2π", ["x at 6.2831853071795864769 s = 0.4 m ± 1e-11",
                                            "y at 6.2831853071795864769 s = 0 m ± 1e-11"]),
    "electro_dc_motor": ("the steady speed K V/(R b + K²) and current b V/(R b + K²)",
                         ["θ' at 20 s = 104.347826086956521739 rad/s ± 1e-9",
                          "q' at 20 s = 1.04347826086956521739 A ± 1e-9"]),
    "euler_top_elliptic": ("the period of the body rates", ["wa at 6.485572551922631999 = 0.6 ± 1e-12",
                                                            "wb at 6.485572551922631999 = 0 ± 1e-12",
                                                            "wc at 6.485572551922631999 = 1 ± 1e-12"]),
}

WAITS = {  # kind of an expectation → the capability that it waits for
    "normal_modes_omega_squared": "modes", "eigenvalues": "modes", "linearisation": "modes", "equilibria": "modes",
    "characteristic_polynomial": "modes", "floquet_trace": "modes", "hamiltonian": "hamiltonian",
    "symmetry": "invariants", "action": "action", "extremal_path": "action", "identity": "analysis",
    "field_equations": "fields", "field_solution": "fields", "conservation_law": "fields",
    "boundary_conditions": "fields", "event": "contacts", "event_times": "contacts",
    "matrix": "mass matrix on the command line", "expression": "analysis", "scalar": "analysis", "scalars": "analysis",
}
SCALARS = {  # what a scalar or an expression of a case waits for, where the general word does not say it
    "bead_rotating_hoop": "modes", "lagrange_top": "modes", "electro_condenser_microphone": "modes",
    "nonhol_rolling_disc": "modes", "sicm_routhian": "hamiltonian", "sicm_free_rigid_body": "mass matrix on the command line",
}


def needed(case):
    """What the statement itself waits for: empty when it is a model of the language today."""
    statement = case["statement"]
    if "data_file" in statement:
        return "URDF import"
    if "fields" in statement:
        return "fields"
    if statement.get("independent", "t") != "t":
        return "action"
    if "inequality" in statement.get("constraints", {}):
        return "contacts"
    kinds = {e["kind"] for e in case["expected"]}
    return "" if kinds - set(WAITS) - {"note"} else WAITS[case["expected"][0]["kind"]]


def tolerance(expectation):
    """The tolerance in doubles of the recomputed values, out of the words of the case: "± 1e-12" or "rel 1e-12"."""
    words = expectation["tolerance"]
    number = r"(\d[\d.e+-]*\d)"
    relative = re.search("recomputed: .*?" + number + " in double", words) or re.search("recomputed relative " + number, words)
    if relative:
        return "rel " + relative[1]
    at = re.search(rf"t={expectation.get('time')}: {number}", words)
    recomputed = re.search(number + " against recomputed", words) or re.search("(?:values_recomputed for|recomputed absolute) " + number, words)
    absolute = re.search("absolute " + number, words)
    if at or recomputed or absolute:
        return "± " + (at or recomputed or absolute)[1]
    return "rel " + re.search("relative " + number, words)[1]


def digits(value):
    """20 digits of a decimal, none that says nothing."""
    text = f"{value:.20g}"
    return "0" if value == 0 or abs(value) < D("1e-15") else case_math.number(text.rstrip("0") if "." in text and "e" not in text.lower() else text)


def quoted(text):
    return '"' + text.replace('"', "'") + '"'


class Model:
    def __init__(self, case):
        self.case, self.statement, self.id = case, case["statement"], case["id"]
        self.dimensionless = self.id not in KINDS
        self.lines, self.passes, self.waits = [], [], []
        self.end = D(0)
        self.definitions = dict(self.statement.get("definitions", []))

    # -------------------------------------------------------------------------------------------------- statement

    def add(self, line=""):
        self.lines.append(line)

    def write(self, suffix="", start=None):
        self.add(f"# Generated from tests/problems/cases/{self.id}.json by scripts/convert_cases.py: do not edit.")
        self.add(f"system {self.id}{suffix} {quoted(self.case['title'])}")
        self.add(f"source {quoted(self.case['source']['where'])}")
        if self.dimensionless:
            self.add("dimensionless")
        self.add()
        self.parameters()
        self.coordinates()
        self.formulas()
        self.constraints()
        if start or "initial" in self.statement:
            self.add()
            self.start(start)
        self.run_line = len(self.lines)

    def parameters(self):
        for name, entry in self.statement["parameters"].items():
            value, unit = entry["value"], "" if self.dimensionless or entry["unit"] == "1" else " " + entry["unit"]
            tree = parse(value)
            constant = tree[0] == "num" or tree[0] == "neg" and tree[1][0] == "num"
            self.add(f"{'param' if constant else 'let'} {greek(name)} = {show(tree)}{unit}")

    def coordinates(self):
        kinds = KINDS.get(self.id, {})
        groups = []
        for name in self.statement["coordinates"]:
            kind = kinds.get(name, "number")
            if groups and groups[-1][1] == kind:
                groups[-1][0].append(greek(name))
            else:
                groups.append(([greek(name)], kind))
        self.add("coord " + ", ".join(f"{', '.join(g)} : {kind}" for g, kind in groups))

    def formulas(self):
        statement = self.statement
        unsaid = UNSAID.get(self.id, {})
        for name, text in statement.get("definitions", []):
            self.formula(f"let {greek(name)} = ", unsaid.get(text, text))
        declared = set(statement["parameters"]) | set(statement["coordinates"]) | set(self.definitions)
        for letter, word, key in (("T", "kinetic", "T"), ("V", "potential", "V"), ("L", "lagrangian", "lagrangian"),
                                  ("D", "dissipation", "rayleigh")):
            if statement.get(key, "0") != "0":
                self.formula(f"{word if letter in declared else letter} = ", statement[key])
        for name, text in statement.get("generalized_forces", {}).items():
            self.formula(f"force {greek(name)} = ", text)

    def constraints(self):
        """Named c1, c2, … in the order of the multipliers of the cases."""
        equations = self.statement.get("constraints", {})
        rows = [(kind, text) for kind in ("holonomic", "nonholonomic") for text in equations.get(kind, [])]
        for k, (_, text) in enumerate(rows):
            self.add(show_long(parse(text), "constraint ") + f" = 0 name c{k + 1}")
        holonomic = sum(kind == "holonomic" for kind, _ in rows)
        self.claims = [f"expect freedoms = {len(self.statement['coordinates']) - holonomic}"] if rows else []
        self.claims += [f"expect constraint c{k + 1} is {kind}" for k, (kind, _) in enumerate(rows)]

    def formula(self, head, text):
        self.add(head + text if "[" in text else show_long(parse(text), head))

    # ------------------------------------------------------------------------------------------------------- start

    def start(self, analytic):
        if analytic:
            values = self.constants(analytic)
            initial = {name: (digits(case_math.evaluate(parse(text), {**values, "t": D(0)})),
                              digits(case_math.derivative(parse(text), values, D(0))))
                       for name, text in analytic["values"].items()}
        else:
            initial = {name: (self.statement["initial"]["q"][name], self.statement["initial"]["dot"][name])
                       for name in self.statement["coordinates"]}
        parts = []
        for name, (q, rate) in initial.items():
            parts.append(f"{greek(name)} = {self.quantity(q, self.unit(name, 0))}")
            if show(parse(rate)) != "0":
                parts.append(f"{greek(name)}' = {self.quantity(rate, self.unit(name, 1))}")
        for line in wrapped("start ", parts):
            self.add(line)

    def unit(self, name, order):
        return UNITS[KINDS[self.id][name]][order] if name in KINDS.get(self.id, {}) else ""

    def quantity(self, text, unit):
        tree = parse(text)
        shown = show(tree)
        plain = tree[0] == "num" or tree[0] == "neg" and tree[1][0] == "num"
        if not unit or shown == "0" or set(case_math.names(tree)) - {"pi"}:
            return shown
        if plain:
            return f"{shown} {unit}"
        return shown if unit == "rad" else f"1 [{unit}] ({shown})"

    def constants(self, expectation):
        """Parameters and constants of a closed form, as decimals."""
        values = {}
        for name, entry in self.statement["parameters"].items():
            values[name] = case_math.evaluate(parse(entry["value"]), values)
        for name, text in expectation.get("constants", []):
            values[name] = case_math.evaluate(parse(text), values)
        return values

    # ---------------------------------------------------------------------------------------------- expectations

    def expect(self, expectation):
        handler = getattr(self, "expect_" + expectation["kind"], None)
        if expectation["kind"] == "identity" and "EllipticK" not in expectation["value"]:
            handler = None
        if expectation["kind"] in ("note", "analytic_text"):
            return
        if handler is None:
            self.waits.append((expectation["quantity"], waits_for(self.id, expectation)))
            return
        self.add(f"# {expectation['quantity']}")
        handler(expectation)
        self.passes.append(expectation["quantity"] if expectation["kind"] != "state_at_time"
                           else f"state at t = {case_math.number(expectation['time'])}")

    def expect_equations_explicit(self, expectation):
        for name, text in expectation["values"].items():
            self.formula(f"expect equation {show(parse(name))} = ", text)

    def expect_equations_residual(self, expectation):
        for text in expectation["values"]:
            self.add(show_long(parse(text), "expect equation ", 104) + " = 0")

    def expect_conserved(self, expectation):
        for name, text in expectation["values"].items():
            self.add(show_long(parse(text), "expect conserved ") + f"   # {name}")
        for name, value in expectation.get("initial_values", {}).items():
            number = digits(case_math.evaluate(parse(value), {}))
            self.add(f"expect {show(parse(expectation['values'][name]))} at 0 = {number} ± 1e-15")

    def expect_not_conserved(self, expectation):
        for text in expectation["values"].values():
            self.add(f"expect {show(parse(text))} not conserved")

    def expect_state_at_time(self, expectation):
        values = expectation.get("values_recomputed") or expectation["values"]
        if set(values) == {"all"}:
            values = {f"dot({name})": values["all"] for name in self.statement["coordinates"]}
        allowed = tolerance(expectation)
        for name, value in values.items():
            self.value(parse(name), expectation["time"], D(value), allowed)

    def expect_accelerations_at_time(self, expectation):
        for name, value in expectation["values_recomputed"].items():
            self.value(("dot", 2, ("name", name)), expectation.get("time", "0"), D(value), tolerance(expectation))

    expect_accelerations_at_state = expect_accelerations_at_time

    def expect_multipliers_at_time(self, expectation):
        """Our sign is that of the cases: the force is + Σ λ ∇g."""
        sign = -1 if "- G^T lambda" in expectation["convention"] else 1
        for name, value in (expectation.get("values_recomputed") or expectation["values"]).items():
            self.value(parse(name), expectation["time"], sign * D(value), tolerance(expectation))

    def expect_identity(self, expectation):
        """Of numbers: checked here and now."""
        modulus, factor = re.search(r"EllipticK\((.*?)\)", expectation["value"])[1], expectation["value"].split("*")[0]
        right = D(factor) * ellipk(case_math.evaluate(parse(modulus), {})) ** 2
        if abs(right - D(self.statement["parameters"]["g"]["value"])) > D("1e-38"):
            raise SystemExit(f"{self.id}: {expectation['quantity']} does not hold")

    def expect_analytic(self, expectation):
        values = self.constants(expectation)
        allowed = "± " + re.match(r"\S+", expectation["tolerance"])[0]
        for time in expectation["times"]:
            if D(time) == 0:
                continue
            for name, text in expectation["values"].items():
                value = case_math.evaluate(parse(text), {**values, "t": D(time)})
                self.value(parse(name), time, value, allowed)

    def value(self, subject, time, value, allowed):
        order, inner = (subject[1], subject[2]) if subject[0] == "dot" else (0, subject)
        shown, unit = show(subject), self.unit(inner[1], order)
        if inner[1].startswith("lambda"):
            unit = MULTIPLIER_UNIT.get(self.id, "")
        elif shown == "E" and shown not in self.definitions:
            shown, unit = "T + V", "" if self.dimensionless else "J"
        self.end = max(self.end, D(time))
        second = "" if self.dimensionless else " s"
        self.add(f"expect {shown} at {case_math.number(time)}{second} = {digits(value)}{' ' + unit if unit else ''} {allowed}")

    def text(self):
        if self.end:
            run = f"run {digits(self.end)}{'' if self.dimensionless else ' s'}"
            self.lines.insert(self.run_line, run)
            self.run_line += 1
        self.lines[self.run_line:self.run_line] = [""] + self.claims
        return "\n".join(self.lines) + "\n"


def waits_for(case_id, expectation):
    kind = expectation["kind"]
    if kind in ("scalar", "scalars", "expression", "identity") and case_id in SCALARS:
        return SCALARS[case_id]
    return WAITS[kind]


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
    return any(abs(at_start(text) - known["q " + name]) > D("1e-12") or abs(slope(text) - known["dot " + name]) > D("1e-12")
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


WITH = {"integral": with_integral, "initial_check": with_initial_check}


def convert(case):
    """({file name: text}, passing expectations, [(expectation, capability)]) of a case."""
    others = [e for e in case["expected"] if is_other_motion(case, e)]
    main, more = Model(case), {}
    main.write()
    for expectation in case["expected"]:
        if expectation in others or (case["id"] in MORE and expectation["kind"] in ("scalar", "scalars", "expression")):
            continue
        if expectation["kind"] in WITH:
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
    lines = ["# Reference cases", "",
             f"{len(rows)} problems from the literature and from the published tests of other systems; the statements and values "
             "are in `tests/problems/cases/`. "
             f"{full} pass whole, {part} in part, {len(rows) - full - part} wait for a capability. A case that passes is a model in "
             "`tests/problems/`, run by `maup test`; both the models and this page are generated by `scripts/convert_cases.py`.", "",
             "| case | model | passes | waits for |", "|---|---|---|---|"]
    for case, models, passes, waits in rows:
        names_of = ", ".join(f"[{m[:-4]}](../tests/problems/{m})" for m in models) or "–"
        wait = "; ".join(f"{capability}" if what == "all" else f"{capability}: {what}" for what, capability in waits) or "–"
        done = "; ".join(passes) or "–"
        lines.append(f"| {case['title'].replace('|', '∣')} | {names_of} | {done.replace('|', '∣')} | {wait.replace('|', '∣')} |")
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
