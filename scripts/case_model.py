"""A reference case as a model of the language: its statement, and a line for every expectation that has one."""
import re

import case_math
from case_math import D, greek, parse, show, show_long
from case_tables import CHARGES, KINDS, LINEARIZED, MULTIPLIER_UNIT, PATHS, SEARCHED, UNITS, UNSAID, waits_for
from convert_urdf import wrapped
from precise import ellipk


def tolerance(expectation):
    """The tolerance in doubles of the recomputed values, out of the words of the case: "± 1e-12" or "rel 1e-12"."""
    words = expectation["tolerance"]
    number = r"(\d[\d.e+-]*\d)"
    relative = (re.search("recomputed: .*?" + number + " in double", words) or
                re.search("recomputed relative " + number, words))
    if relative:
        return "rel " + relative[1]
    at = re.search(rf"t={expectation.get('time')}: {number}", words)
    recomputed = (re.search(number + " against recomputed", words) or
                  re.search("(?:values_recomputed for|recomputed absolute) " + number, words))
    absolute = re.search("absolute " + number, words)
    if at or recomputed or absolute:
        return "± " + (at or recomputed or absolute)[1]
    return "rel " + re.search("relative " + number, words)[1]


def digits(value):
    """20 digits of a decimal, none that says nothing."""
    text = f"{value:.20g}"
    if value == 0 or abs(value) < D("1e-15"):
        return "0"
    return case_math.number(text.rstrip("0") if "." in text and "e" not in text.lower() else text)


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
        if self.statement.get("independent", "t") != "t":
            self.add(f"independent {greek(self.statement['independent'])} : length")
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
        if expectation["kind"] == "identity" and "dS/dx2" in expectation["value"]:
            handler = self.expect_hamilton_jacobi
        elif expectation["kind"] == "identity" and "EllipticK" not in expectation["value"]:
            handler = None
        if expectation["kind"] == "expression" and not expectation["quantity"].startswith("Routhian"):
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
        for name, text in expectation["values"].items() if self.id in SEARCHED else ():
            if name not in CHARGES.get(self.id, ()):
                self.add(show_long(parse(text), "expect integral ") + f"   # {name}")
        for name, value in expectation.get("initial_values", {}).items():
            number = digits(case_math.evaluate(parse(value), {}))
            self.add(f"expect {show(parse(expectation['values'][name]))} at 0 = {number} ± 1e-15")

    def expect_symmetry(self, expectation):
        """By its charge: the search finds it."""
        conserved = next(e["values"] for e in self.case["expected"] if e["kind"] == "conserved")
        for name in CHARGES[self.id]:
            self.add(show_long(parse(conserved[name]), "expect integral ") + f"   # {name}")

    def expect_not_conserved(self, expectation):
        for text in expectation["values"].values():
            self.add(f"expect {show(parse(text))} not conserved")

    def expect_hamiltonian(self, expectation):
        self.add(show_long(parse(expectation["value"]), "expect hamiltonian = "))

    def expect_expression(self, expectation):
        """A Routhian; ours is L - p q', the opposite of the sign that some sources take."""
        coordinate = re.match(r"Routhian R\(.*p_(\w+)\) = p_\w+\*dot", expectation["quantity"])[1]
        self.add(show_long(("neg", parse(expectation["value"])), f"expect routhian of {greek(coordinate)} = "))

    def expect_state_at_time(self, expectation):
        values = expectation.get("values_recomputed") or expectation["values"]
        if set(values) == {"all"}:
            values = {f"dot({name})": values["all"] for name in self.statement["coordinates"]}
        allowed = tolerance(expectation)
        for name, value in values.items():
            self.value(parse(name), expectation["time"], D(value), allowed)

    def expect_normal_modes_omega_squared(self, expectation):
        at = ", ".join(f"{greek(name)} = {show(parse(text))}" for name, text in expectation["equilibrium"].items())
        squares = ", ".join(show(parse(text)) for text in expectation["values"])
        line = f"expect frequencies squared at {at} :"
        self.add(line + (" " if len(line + squares) < 110 else "\n    ") + squares + " " + tolerance(expectation))

    def expect_linearisation(self, expectation):
        for line in LINEARIZED[self.id]:
            self.add("expect " + line)

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

    # ------------------------------------------------------------------------------------------------------- action

    def path_statement(self):
        """Once, before the first expectation that needs it."""
        line = "path " + PATHS[self.id]
        if line not in self.lines:
            self.lines.insert(self.run_line, line)
            self.run_line += 1

    def ends(self):
        """The numbers of the oscillator's formula: x1, x2, T, and the parameters."""
        start = re.fullmatch(r"from (\S+) at 0 to (\S+) at (\S+)", PATHS[self.id]).group(1, 2)
        end = PATHS[self.id].split()[-1]
        return {**self.constants({}), "x1": D(start[0]), "x2": D(start[1]), "T": D(end)}

    def expect_action(self, expectation):
        self.path_statement()
        value = expectation.get("value_recomputed") or expectation.get("numeric") or expectation["value"]
        second = "" if self.dimensionless else " s"
        if "t0" in expectation:  # of a path that is given; the straight one is the stationary one
            path = ", ".join(show(parse(expectation["path"][name])) for name in self.statement["coordinates"])
            ends = f"from {expectation['t0']} to {expectation['t1']}"
            self.add(f"expect action of ({path}) {ends} = {value} rel 1e-13")
            if "value_recomputed" in expectation:  # a varied one
                return
        if "straight_line" in expectation:
            return self.expect_cycloid(expectation)
        self.add(f"expect action = {value}{second} rel 1e-12")
        self.add("expect index = 0")
        if "t0" not in expectation:
            for time in ("0.5", "1", "1.5"):
                x = case_math.evaluate(parse(expectation["path"]["x"]), {**self.ends(), "t": D(time)})
                self.add(f"expect path x at {time} = {digits(x)} ± 1e-12")

    def expect_cycloid(self, expectation):
        """The whole cycloid from rest at (0, 0), where L is infinite; its points by the angle of the wheel."""
        values = self.constants({})
        self.add(f"expect action = {expectation['numeric']} s rel 1e-12")
        self.add("expect index = 0")
        for angle in ("0.05", "1.5", "2.5"):
            at = {**values, "a": D(angle)}
            x, y = (digits(case_math.evaluate(parse(expectation["path"][name]), at)) for name in "xy")
            self.add(f"expect path y at {x} m = {y} m ± 1e-9")
        action = expectation["straight_line"]
        self.add(f"expect action of (2 x/pi) from 0 to pi R = {action} s rel 1e-12   # the straight line")

    def expect_extremal_path(self, expectation):
        self.path_statement()
        self.add(f"expect action = {expectation['action']} ± 1e-13")
        self.add("expect index = 0")
        for time in ("0.3", "0.8", "1.3"):
            x = digits(case_math.evaluate(parse(expectation['values']['x']), {'t': D(time)}))
            self.add(f"expect path x at {time} = {x} ± 1e-12")

    def expect_hamilton_jacobi(self, expectation):
        """The slopes of the formula of S by the end, against momentum and energy there."""
        formula = parse(next(e["formula"] for e in self.case["expected"] if e["kind"] == "action"))
        values, step = self.ends(), D("1e-11")

        def slope(name):
            low, high = (case_math.evaluate(formula, {**values, name: values[name] + s * step}) for s in (-1, 1))
            return (high - low) / (2 * step)

        self.add(f"expect path m x' at {values['T']} = {digits(slope('x2'))} rel 1e-12")
        self.add(f"expect path T + V at {values['T']} = {digits(-slope('T'))} rel 1e-12")

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
        size = digits(value) + (f" {unit}" if unit else "")
        self.add(f"expect {shown} at {case_math.number(time)}{second} = {size} {allowed}")

    def text(self):
        if self.end:
            run = f"run {digits(self.end)}{'' if self.dimensionless else ' s'}"
            self.lines.insert(self.run_line, run)
            self.run_line += 1
        self.lines[self.run_line:self.run_line] = [""] + self.claims
        return "\n".join(self.lines) + "\n"
