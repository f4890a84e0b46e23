#!/usr/bin/env python3
"""The reference values of the gallery, from closed forms or from equations of motion written down by hand here.

    scripts/reference_values.py            print the `expect` lines of every model
    scripts/reference_values.py --check    compare them with the `expect` lines of models/ and tests/problems/

Nothing here uses the program: the closed forms are those of the cited books, and where there is none the textbook
equations are integrated by extrapolation in 44-digit decimals (scripts/precise.py).
"""
import pathlib
import re
import sys

import reference_constraints
import reference_rolling
from newton_euler import Chain
from precise import D, PI, acos, asin, atan2, cos, ellipk, jacobi, motion, integrate, sin, solve, sqrt

ROOT = pathlib.Path(__file__).resolve().parent.parent
G = D("9.81")
DEG = PI / 180


def pendulum():
    """sin(θ/2) = k sn(K + ω0 t, k), k = sin(θ0/2): Landau and Lifshitz, Mechanics, §11."""
    k, w = sin(30 * DEG), sqrt(G)
    quarter = ellipk(k * k)
    theta = lambda t: 2 * asin(k * jacobi(quarter + w * t, k * k)[0])
    yield "θ", "10 s", theta(D(10))
    period = 4 * quarter / w
    yield "θ", f"{period:.18f} s", 60 * DEG
    yield "θ", f"{period / 2:.18f} s", -60 * DEG


def double_pendulum():
    def acceleration(_, q, v):
        c, s = cos(q[0] - q[1]), sin(q[0] - q[1])
        return solve([[2, c], [c, 1]], [-s * v[1] ** 2 - 2 * G * sin(q[0]), s * v[0] ** 2 - G * sin(q[1])])

    for t, (q, v) in zip((1, 5, 10), motion(acceleration, [120 * DEG, -10 * DEG], [D(0), D(0)], (1, 5, 10))):
        yield "θ1", f"{t} s", q[0]
        yield "θ2", f"{t} s", q[1]


def elastic_pendulum():
    def acceleration(_, q, v):
        r, theta = q
        return [r * v[1] ** 2 - 40 * (r - 1) + G * cos(theta), -(2 * v[0] * v[1] + G * sin(theta)) / r]

    (q, v), = motion(acceleration, [D("1.4"), D("0.6")], [D(0), D(0)], [10])
    yield "r", "10 s", q[0]
    yield "θ", "10 s", q[1]
    yield "r'", "10 s", v[0]
    yield "θ'", "10 s", v[1]


def spherical_pendulum():
    """cos θ = c1 − (c1 − c0) sn²(K + Ω t): Whittaker, Analytical Dynamics, §55. φ is an integral of the third kind."""
    c0, rate = D("0.5"), D(2)  # start at the turning point θ = 60°, l = 1
    momentum = (1 - c0 ** 2) * rate
    energy = momentum * rate / 2 - G * c0
    # (dc/dt)² = 2 (E + g c)(1 − c²) − Lz² = −2 g (c − c0)(c − c1)(c − c2); the other two roots by Vieta
    total, product = -energy / G - c0, (2 * energy - momentum ** 2) / (2 * G * c0)
    root = sqrt(total ** 2 - 4 * product)
    c1, c2 = (total + root) / 2, (total - root) / 2
    omega, modulus = sqrt(G * (c1 - c2) / 2), (c1 - c0) / (c1 - c2)
    theta = lambda t: acos(c1 - (c1 - c0) * jacobi(ellipk(modulus) + omega * t, modulus)[0] ** 2)

    def acceleration(_, q, v):
        return [sin(q[0]) * cos(q[0]) * v[1] ** 2 - G * sin(q[0]), -2 * v[0] * v[1] * cos(q[0]) / sin(q[0])]

    (q, v), = motion(acceleration, [60 * DEG, D(0)], [D(0), rate], [10])
    assert abs(q[0] - theta(D(10))) < D("1e-17"), (q[0], theta(D(10)))
    yield "θ", "10 s", theta(D(10))
    yield "φ", "10 s", q[1]
    period = ellipk(modulus) * 2 / omega
    yield "θ", f"{period / 2:.18f} s", acos(c1)


def cart_pendulum():
    mass, m, l, b, c, force, w = D(2), D("0.5"), D("0.6"), D("0.4"), D("0.01"), D(3), D(2)

    def acceleration(t, q, v):
        s, k = sin(q[1]), m * l * cos(q[1])
        return solve([[mass + m, k], [k, m * l * l]],
                     [force * cos(w * t) + m * l * s * v[1] ** 2 - b * v[0], -m * G * l * s - c * v[1]])

    for t, (q, v) in zip((10, 30), motion(acceleration, [D(0), 10 * DEG], [D(0), D(0)], (10, 30))):
        yield "x", f"{t} s", q[0]
        yield "θ", f"{t} s", q[1]


def bead_on_hoop():
    acceleration = lambda t, q, v: [(64 * cos(q[0]) - G / D("0.3")) * sin(q[0])]
    (q, v), = motion(acceleration, [5 * DEG], [D(0)], [10])
    yield "θ", "10 s", q[0]
    yield "θ'", "10 s", v[0]


def kepler():
    """Kepler's equation E − e sin E = n t."""
    gm, a, e = D("398600.4418"), D(26600), D("0.74")
    n = sqrt(gm / a ** 3)
    period = 2 * PI / n
    for t in (D(3600), D(86400)):
        u = mean = n * t
        for _ in range(60):
            u -= (u - e * sin(u) - mean) / (1 - e * cos(u))
        yield "x", f"{t / 3600} h", a * (cos(u) - e)
        yield "y", f"{t / 3600} h", a * sqrt(1 - e * e) * sin(u)
    yield "x", f"{period:.15f} s", a * (1 - e)


def lagrange_top():
    """The nutation in cos θ is elliptic (Goldstein §5.7); the whole motion is integrated, the two are compared."""
    a, c, mgl = D("1.4e-4"), D("6e-5"), D("0.1") * G * D("0.03")
    theta0, spin = 25 * DEG, D(200)
    p_psi = c * spin
    p_phi = p_psi * cos(theta0)

    def slope(_, y):
        theta, rate, _, _ = y
        s, k = sin(theta), cos(theta)
        precession = (p_phi - p_psi * k) / (a * s * s)
        return [rate, precession ** 2 * s * k - p_psi * precession * s / a + mgl * s / a, precession,
                p_psi / c - precession * k]

    y, = integrate(slope, [theta0, D(0), D(0), D(0)], [2])
    u0, beta = cos(theta0), 2 * mgl / a  # u̇² = (u0 − u) (β (1 − u²) − (p_ψ/A)² (u0 − u)), released at a cusp
    alpha = (p_psi / a) ** 2
    root = sqrt(alpha ** 2 + 4 * beta * (beta - alpha * u0))
    u1, u2 = (alpha - root) / (2 * beta), (alpha + root) / (2 * beta)
    sn, _, _ = jacobi(sqrt(beta * (u2 - u1)) / 2 * 2 + ellipk((u0 - u1) / (u2 - u1)), (u0 - u1) / (u2 - u1))
    assert abs(acos(u1 + (u0 - u1) * sn ** 2) - y[0]) < D("1e-17"), (acos(u1 + (u0 - u1) * sn ** 2), y[0])
    yield "θ", "2 s", y[0]
    yield "φ", "2 s", y[2]
    yield "ψ", "2 s", y[3]


def satellite():
    """Jacobi's solution, started where ω1 = 0 (Landau and Lifshitz, Mechanics, §37)."""
    i1, i2, i3, w2, w3 = D(1), D(2), D(3), D(2), D("0.02")
    energy2, momentum2 = i2 * w2 ** 2 + i3 * w3 ** 2, (i2 * w2) ** 2 + (i3 * w3) ** 2
    a1 = sqrt((energy2 * i3 - momentum2) / (i1 * (i3 - i1)))
    a2 = sqrt((energy2 * i3 - momentum2) / (i2 * (i3 - i2)))
    a3 = sqrt((momentum2 - energy2 * i1) / (i3 * (i3 - i1)))
    rate = sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3))
    m = (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1))
    quarter = ellipk(m)
    assert abs(a2 - w2) < D("1e-38")
    for t in (5, 10, 60):
        sn, cn, dn = jacobi(quarter + rate * t, m)
        yield "ω1", f"{t} s", a1 * cn
        yield "ω2", f"{t} s", a2 * sn
        yield "ω3", f"{t} s", a3 * dn
    yield "ω2", f"{2 * quarter / rate:.16f} s", -w2


def ion_in_fields():
    """Cycloid of the crossed fields (Jackson §12.3), free along B."""
    q, m, b, e = D("1.602176634e-19"), D("1.67262192369e-27"), D("1e-3"), D(10)
    w, t = q * b / m, D("200e-6")
    yield "x", "200 μs", e / (b * w) * (1 - cos(w * t))
    yield "y", "200 μs", -e / b * (t - sin(w * t) / w)
    yield "z", "200 μs", 5000 * t


def rotating_frame():
    """A straight line of the inertial frame, seen from the turntable."""
    w, t = D("0.5"), D(8)
    x, y = -2 + t, D("0.3") * t
    yield "x", "8 s", x * cos(w * t) + y * sin(w * t)
    yield "y", "8 s", -x * sin(w * t) + y * cos(w * t)


def robot_arm():
    """Absolute angles α: Σ_j c_ij (cos(α_i − α_j) α_j'' + sin(α_i − α_j) α_j'^2) + g_i cos α_i = torque on link i."""
    m, l, j = [D(4), D(3), D(1)], [D("0.5"), D("0.4"), D("0.2")], [D("0.09"), D("0.045"), D("0.004")]
    beyond = [sum(m[i + 1:], D(0)) for i in range(3)]
    lever = [m[i] * l[i] / 2 + beyond[i] * l[i] for i in range(3)]
    c = [[l[min(i, k)] * lever[max(i, k)] if i != k else j[i] + m[i] * l[i] ** 2 / 4 + beyond[i] * l[i] ** 2
          for k in range(3)] for i in range(3)]

    def acceleration(t, q, v):
        a, w = [q[0], q[0] + q[1], sum(q)], [v[0], v[0] + v[1], sum(v)]
        joint = [15 * sin(3 * t), 5 * cos(2 * t), sin(5 * t), D(0)]
        joint = [torque - D("0.5") * rate for torque, rate in zip(joint, v + [D(0)])]
        right = [joint[i] - joint[i + 1] - G * lever[i] * cos(a[i])
                 - sum(c[i][k] * sin(a[i] - a[k]) * w[k] ** 2 for k in range(3)) for i in range(3)]
        b = solve([[c[i][k] * cos(a[i] - a[k]) for k in range(3)] for i in range(3)], right)
        return [b[0], b[1] - b[0], b[2] - b[1]]

    for t, (q, v) in zip((1, 3), motion(acceleration, [-90 * DEG, 30 * DEG, 20 * DEG], [D(0)] * 3, (1, 3))):
        for i in range(3):
            yield f"θ{i + 1}", f"{t} s", q[i]


def motor_link():
    lm, rm, k, n = D("1e-3"), D(1), D("0.05"), D(50)
    inertia = D("2e-5") * n * n + D("0.8") * D("0.4") ** 2 / 3

    def acceleration(_, q, v):
        return [(12 - rm * v[0] - k * n * v[1]) / lm,
                (k * n * v[0] - D("0.8") * G * D("0.2") * sin(q[1]) - D("0.02") * v[1]) / inertia]

    (q, v), = motion(acceleration, [D(0), D(0)], [D(0), D(0)], [2], tolerance=D("1e-20"))
    yield "q", "2 s", q[0]
    yield "θ", "2 s", q[1]
    yield "q'", "2 s", v[0]


def absolute_value():
    """Parabolas of acceleration −(f/m) sign x: from x0 at rest the first quarter takes √(2 m x0/f)."""
    x0, a = D(1), D("1.5")
    quarter = sqrt(2 * x0 / a)
    for t in (D(1), D(3), D(10), D(100)):
        phase = t % (4 * quarter)
        sign = 1 if phase < quarter or phase > 3 * quarter else -1
        s = min(phase, 4 * quarter - phase) if sign > 0 else phase - 2 * quarter
        yield "x", f"{t} s", sign * (x0 - a * s * s / 2)


def arm_seven_joints():
    """Recursive Newton-Euler (scripts/newton_euler.py): forces and torques link by link, no Lagrangian."""
    chain = Chain([2, 1, 2, 1, 2, 1, 2], [D(x) for x in ("0.34", "0.2", "0.2", "0.2", "0.2", "0.1", "0.1")],
                  [D(x) for x in ("0.17", "0.1", "0.1", "0.1", "0.1", "0.05", "0.05")],
                  [D(x) for x in ("4", "4", "3", "2.7", "1.7", "1.6", "0.3")],
                  [[D(x), D(x), D(z)] for x, z in (
                      ("0.05", "0.01"), ("0.04", "0.01"), ("0.03", "0.008"), ("0.03", "0.006"),
                      ("0.02", "0.005"), ("0.005", "0.004"), ("0.001", "0.001"))], G)
    q0, rate = [20, 40, -30, 60, 10, -50, 0], D("0.5")
    acceleration = lambda t, q, v: chain.acceleration(q, v, [-D("0.02") * x for x in v])
    start = acceleration(0, [x * DEG for x in q0], [rate] * 7)
    for i, value in enumerate(start):
        yield f"q{i + 1}''", "0 s", value
    (q, v), = motion(acceleration, [x * DEG for x in q0], [rate] * 7, ["0.5"], tolerance=D("1e-14"))
    for i in range(7):
        yield f"q{i + 1}", "500 ms", q[i]


def henon_heiles():
    acceleration = lambda _, q, v: [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]
    at_10, at_100 = motion(acceleration, [D(0), D("0.1")], [D("0.5"), D(0)], (10, 100))
    yield "x", "10", at_10[0][0]
    yield "y", "100", at_100[0][1]


def van_der_pol():
    acceleration = lambda _, q, v: [(1 - q[0] ** 2) * v[0] - q[0]]
    at_10, at_40 = motion(acceleration, [D(2)], [D(0)], (10, 40))
    yield "x", "10", at_10[0][0]
    yield "x'", "40", at_40[1][0]


MODELS = [pendulum, double_pendulum, elastic_pendulum, spherical_pendulum, cart_pendulum, bead_on_hoop, kepler,
          lagrange_top, satellite, ion_in_fields, rotating_frame, robot_arm, motor_link,
          absolute_value, arm_seven_joints,
          henon_heiles, van_der_pol, *reference_constraints.MODELS, *reference_rolling.MODELS]
UNITS = {"deg": DEG, "ms": D("1e-3"), "μs": D("1e-6"), "h": D(3600)}


def text_of(name):
    for folder in ("models", "tests/problems"):
        path = ROOT / folder / f"{name}.lag"
        if path.exists():
            return path.read_text(encoding="utf-8")
    raise SystemExit(f"no model {name}")


def check(model):
    """Every value stands in an `expect` line of the model, equal within the line's own tolerance."""
    lines = [line.split() for line in text_of(model.__name__).splitlines() if line.startswith("expect")]
    wrong = 0
    for subject, time, value in model():
        found = [w for w in lines if w[1:3] == [subject, "at"] and " ".join(w[3:w.index("=")]) == time]
        good = len(found) == 1 and "±" in found[0]
        if good:
            number, *unit = found[0][found[0].index("=") + 1:found[0].index("±")]
            tolerance = D(found[0][found[0].index("±") + 1])
            good = abs(D(number) * UNITS.get(" ".join(unit), 1) - value) <= tolerance / 4
        if not good:
            print(f"{model.__name__}: expect {subject} at {time} = {value:.18g}   is missing or differs: {found}")
            wrong += 1
    return wrong


def main():
    if "--check" in sys.argv:
        sys.exit(1 if sum(check(model) for model in MODELS) else 0)
    for model in MODELS:
        print(f"# {model.__name__}: {model.__doc__ or ''}".rstrip())
        for subject, time, value in model():
            print(f"expect {subject} at {time} = {value:.18g}")


if __name__ == "__main__":
    main()
