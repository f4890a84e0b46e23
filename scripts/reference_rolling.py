"""Reference values of the gallery's non-holonomic systems: closed forms; the rattleback by Newton and Euler."""
from precise import D, PI, asin, atan, cos, cosh, integrate, sin, sinh, solve, sqrt, tanh

G = D("9.81")
DEG = PI / 180


def rolling_disk():
    """Upright: a circle of radius R φ'/ψ'; the ground gives the centripetal force (Bloch,
    Nonholonomic Mechanics, §1.4)."""
    m, radius, spin, turn = D(1), D("0.2"), D(2), D(1)
    for t in (D(1), D(10)):
        yield "x", f"{t} s", radius * spin / turn * sin(turn * t)
        yield "y", f"{t} s", radius * spin / turn * (1 - cos(turn * t))
        yield "multiplier(along_x)", f"{t} s", -m * radius * spin * turn * sin(turn * t)
        yield "multiplier(along_y)", f"{t} s", m * radius * spin * turn * cos(turn * t)


LEAN, TURN, RADIUS = 70 * DEG, D("1.5"), D("0.3")  # of the leaning disk: θ, φ' and r


def leaning_spin():
    """Of the steady motion: 6 ω3 φ' r sin θ − φ'² r sin θ cos θ + 4 g cos θ = 0 with ω3 = ψ' + φ' cos θ
    (Neimark and Fufaev)."""
    s, c = sin(LEAN), cos(LEAN)
    return -(5 * TURN ** 2 * RADIUS * s * c + 4 * G * c) / (6 * TURN * RADIUS * s)


def leaning_disk():
    """Steady rolling (Routh; Neimark and Fufaev): θ, φ', ψ' constant, the centre
    on a circle of radius −(r/φ')(ψ' + φ' cos θ)."""
    spin = leaning_spin()
    radius = -RADIUS * (spin + TURN * cos(LEAN)) / TURN
    yield "ψ'", "0 s", spin
    for t in (D(1), D(5)):
        yield "θ", f"{t} s", LEAN
        yield "φ", f"{t} s", TURN * t
        yield "x", f"{t} s", radius * sin(TURN * t)
        yield "y", f"{t} s", radius * (1 - cos(TURN * t))


def ball_on_turntable():
    """r' = r0' turned by 2/7 Ω t (Milne, Vectorial Mechanics, 1948): a circle that the table's turning does not
    carry away."""
    w = 2 * D(5) / 7
    x0, y0, u, v = D("0.3"), D(0), D("0.1"), D("0.4")
    for t in (D(2), D(10)):
        s, c = sin(w * t), cos(w * t)
        yield "x", f"{t} s", x0 + (u * s - v * (1 - c)) / w
        yield "y", f"{t} s", y0 + (v * s + u * (1 - c)) / w
        yield "multiplier(grip_x)", f"{t} s", -D("0.2") * w * (u * s + v * c)
        yield "multiplier(grip_y)", f"{t} s", D("0.2") * w * (u * c - v * s)


def chaplygin_sleigh():
    """ω = ω0 sech(k ω0 t), v = (a ω0/k) tanh(k ω0 t), k² = m a²/(J + m a²) (Neimark and Fufaev, ch. III)."""
    m, a, inertia, w0 = D(2), D("0.3"), D("0.12"), D(3)
    k = sqrt(m * a * a / (inertia + m * a * a))
    for t in (D("0.5"), D(3)):
        tau = k * w0 * t
        w, v = w0 / cosh(tau), a * w0 / k * tanh(tau)
        theta = 2 / k * atan(tanh(tau / 2))
        w_rate = -k * w0 * w0 * sinh(tau) / cosh(tau) ** 2
        yield "θ'", f"{t} s", w
        yield "θ", f"{t} s", theta
        yield "x'", f"{t} s", v * cos(theta)
        yield "y'", f"{t} s", v * sin(theta)
        yield "multiplier(blade)", f"{t} s", -m * (v * w + a * w_rate)


def knife_edge():
    """A cycloid across the slope (Neimark and Fufaev; Bloch, §1.6); the edge carries 2 m g sin α sin ωt."""
    m, w = D("1.2"), D("1.7")
    pull = G * sin(D(25) * DEG)
    for t in (D("1.3"), D(20)):
        yield "x", f"{t} s", pull / (2 * w * w) * sin(w * t) ** 2
        yield "y", f"{t} s", pull / (2 * w * w) * (w * t - sin(2 * w * t) / 2)
        yield "multiplier(edge)", f"{t} s", -2 * m * pull * sin(w * t)


def rattleback():
    """Newton-Euler in body axes: ω and the vertical n as unknowns, the floor's force eliminated by v = r × ω."""
    m, g, h = D(1), G, D("0.01")
    squares = [D("0.04"), D("0.0009"), D("0.0004")]
    inertia = [[D("2e-4"), D("-2e-5"), D(0)], [D("-2e-5"), D("16e-4"), D(0)], [D(0), D(0), D("17e-4")]]
    cross = lambda u, v: [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    dot = lambda u, v: sum(a * b for a, b in zip(u, v))

    def forces(y):
        """The rates of ω and n, the place r of contact against the centre of mass, and the floor's force."""
        w, n = y[0:3], y[3:6]
        n_rate = cross(n, w)
        p = sqrt(sum(s * a * a for s, a in zip(squares, n)))
        p_rate = sum(s * a * b for s, a, b in zip(squares, n, n_rate)) / p
        r = [-s * a / p + (h if i == 2 else 0) for i, (s, a) in enumerate(zip(squares, n))]
        r_rate = [-s * (b - a * p_rate / p) / p for s, a, b in zip(squares, n, n_rate)]
        known = [m * (a + b + g * c) for a, b, c in zip(cross(r_rate, w), cross(w, cross(r, w)), n)]
        spin = [dot(row, w) for row in inertia]
        right = [a - b for a, b in zip(cross(r, known), cross(w, spin))]
        lever = [[(dot(r, r) if i == j else 0) - r[i] * r[j] for j in range(3)] for i in range(3)]
        w_rate = solve([[inertia[i][j] + m * lever[i][j] for j in range(3)] for i in range(3)], right)
        return w_rate, n_rate, r, [a + m * b for a, b in zip(known, cross(r, w_rate))]

    def rates(_, y):
        w_rate, n_rate, _, _ = forces(y)
        return w_rate + n_rate + [(y[1] * y[4] + y[2] * y[5]) / (y[4] ** 2 + y[5] ** 2)]

    tilt = D("0.5") * DEG
    n = [-sin(tilt), cos(tilt) * sin(tilt), cos(tilt) ** 2]  # ψ' = −5 rad/s alone: ω = −5 n
    start = [-5 * a for a in n] + n + [D(0)]
    for t, y in zip((1, 3), integrate(rates, start, (1, 3), tolerance=D("1e-13"))):
        yield "ψ'", f"{t} s", rates(t, y)[6]
        yield "ψ", f"{t} s", y[6]
        yield "θ", f"{t} s", -asin(y[3])
        yield "φ", f"{t} s", asin(y[4] / sqrt(y[4] ** 2 + y[5] ** 2))
        yield "reaction(floor)", f"{t} s", dot(forces(y)[3], y[3:6])


def snakeboard():
    """The momentum equation p' = 2 J0 cos² φ φ' ψ' − tan φ φ' p and θ' by p, as published; J0 (ψ' + θ')' is the torque
    of the rotor."""
    m, r, j0, j1 = D(6), D("0.2"), D("0.016"), D("1.3e-3")
    a, b, w, k, c = D("0.7"), D("0.5"), D(2), D(40), D(2)

    def turning(p, phi, psi_rate):
        s = sin(2 * phi)
        return (p * s - j0 * s * s * psi_rate) / (4 * m * r * r * cos(phi) ** 2)

    def rotor(p, total, phi):
        """ψ' of ψ' + θ' = total."""
        by_momentum = turning(p, phi, D(0))
        return (total - by_momentum) / (1 + turning(D(0), phi, D(1)))

    def rates(t, y):
        p, psi, total, phi, phi_rate, _, _, theta = y
        psi_rate = rotor(p, total, phi)
        theta_rate = turning(p, phi, psi_rate)
        s = sin(2 * phi)
        along = (m * r * r * s * theta_rate + j0 * s * psi_rate - p) / (2 * m * r * cos(phi) ** 2)
        drive = sin(w * t)
        return [2 * j0 * cos(phi) ** 2 * phi_rate * psi_rate - sin(phi) / cos(phi) * phi_rate * p, psi_rate,
                (k * (a * drive - psi) - c * psi_rate) / j0, phi_rate,
                (k * (-b * drive - phi) - c * phi_rate) / (2 * j1), along * cos(theta), along * sin(theta), theta_rate]

    for t, y in zip((1, 3), integrate(rates, [D(0)] * 8, (1, 3), tolerance=D("1e-13"))):
        for name, value in zip(("p", "ψ", None, "φ", None, "x", "y", "θ"), y):
            if name:
                yield name, f"{t} s", value


MODELS = [rolling_disk, leaning_disk, ball_on_turntable, chaplygin_sleigh, knife_edge, rattleback, snakeboard]
