#!/usr/bin/env python3
"""derive_sympy.py MAUP: SymPy's LagrangesMethod beside `maup derive`, for chains of 2 and 4 pendulums.

Prints JSON. Both derivations are asserted first: SymPy's equations against the closed form at a point, maup's
by its certificate."""
import json, math, statistics, subprocess, sys, tempfile, time

import sympy
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols


def lagrangian(links):
    m, l, g = sympy.symbols("m l g")
    t = dynamicsymbols._t
    angles = dynamicsymbols(f"theta1:{links + 1}")
    x = y = sympy.Integer(0)
    energy = sympy.Integer(0)
    for angle in angles:
        x, y = x + l * sympy.sin(angle), y - l * sympy.cos(angle)
        energy += m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 - m * g * y
    return energy, angles, (m, l, g)


def derive(links):
    energy, angles, parameters = lagrangian(links)
    method = LagrangesMethod(energy, angles)
    method.form_lagranges_equations()
    return method, angles, parameters


def check(links):
    """M_ij = (n - max(i, j)) cos(θi - θj) for m = l = 1, i and j from 0."""
    method, angles, (m, l, g) = derive(links)
    values = [0.3 + 0.7 * i for i in range(links)]
    numbers = {**dict(zip(angles, values)), m: 1, l: 1, g: 9.81}
    matrix = method.mass_matrix.subs(numbers)
    for i in range(links):
        for j in range(links):
            expected = (links - max(i, j)) * math.cos(values[i] - values[j])
            assert abs(float(matrix[i, j]) - expected) < 1e-12, "SymPy's mass matrix"


def chain_text(links):
    names = [f"θ{i}" for i in range(1, links + 1)]
    points = [f"point P{i} mass m at {f'P{i - 1} + ' if i > 1 else ''}l (sin θ{i}, -cos θ{i})"
              for i in range(1, links + 1)]
    return "\n".join(["system chain", "param m = 1 kg, l = 1 m, g = 9.81 m/s^2", f"coord {', '.join(names)} : angle",
                      *points,
                      "gravity (0, -g)", "start " + ", ".join(f"{n} = 2 rad" for n in names), "run 1 s", ""])


def median_seconds(runs, work):
    seconds = []
    for _ in range(runs):
        begin = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds)


def main():
    rows = []
    for links in (2, 4):
        check(links)
        with tempfile.NamedTemporaryFile("w", suffix=".lag") as model:
            model.write(chain_text(links))
            model.flush()
            command = [sys.argv[1], "derive", model.name]
            assert "Certificate: passed" in subprocess.run(command, capture_output=True, text=True, check=True).stdout

            def clear_and_derive():
                sympy.core.cache.clear_cache()
                derive(links)

            rows.append({"links": links, "sympy_seconds": median_seconds(3, clear_and_derive),
                         "maup_seconds": median_seconds(
                             11, lambda: subprocess.run(command, capture_output=True, check=True))})
    print(json.dumps({"version": sympy.__version__, "rows": rows}))


main()
