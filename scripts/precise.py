"""Elementary and elliptic functions and an integrator in 40-digit decimals, from the standard library alone.

The reference values of models/ and tests/problems/ come from here (closed forms and an extrapolation integrator), so
that they share no line with the program that they test.
"""
from decimal import Decimal as D, getcontext

getcontext().prec = 44


def d(x):
    """An exact decimal: strings keep all their digits."""
    return x if isinstance(x, D) else D(str(x))


def _atan_series(x):
    term, total, n = x, x, 1
    while abs(term) > D(10) ** -(getcontext().prec + 2):
        term *= -x * x
        n += 2
        total += term / n
    return total


def atan(x):
    x = d(x)
    halvings = 0
    while abs(x) > D("0.05"):  # atan x = 2 atan(x / (1 + √(1 + x²)))
        x = x / (1 + (1 + x * x).sqrt())
        halvings += 1
    return _atan_series(x) * 2 ** halvings


PI = 16 * _atan_series(D(1) / 5) - 4 * _atan_series(D(1) / 239)  # Machin


_SINE = [D(1)]  # coefficients of sin x / x in −x²
for _n in range(3, 23, 2):
    _SINE.append(_SINE[-1] / ((_n - 1) * _n))


def sin(x):
    x = d(x) % (2 * PI) / 243  # sin 3x = 3 sin x − 4 sin³ x, five times
    square, total = -x * x, D(0)
    for coefficient in reversed(_SINE):
        total = total * square + coefficient
    total *= x
    for _ in range(5):
        total = (3 - 4 * total * total) * total
    return total


def cos(x):
    return sin(d(x) + PI / 2)


def tan(x):
    return sin(x) / cos(x)


def sqrt(x):
    return d(x).sqrt()


def exp(x):
    return d(x).exp()


def log(x):
    return d(x).ln()


def atan2(y, x):
    y, x = d(y), d(x)
    if x > 0:
        return atan(y / x)
    if x < 0:
        return atan(y / x) + (PI if y >= 0 else -PI)
    return PI / 2 if y > 0 else -PI / 2 if y < 0 else D(0)


def asin(x):
    return atan2(x, (1 - d(x) ** 2).sqrt())


def acos(x):
    return atan2((1 - d(x) ** 2).sqrt(), x)


def sinh(x):
    return (exp(x) - exp(-d(x))) / 2


def cosh(x):
    return (exp(x) + exp(-d(x))) / 2


def tanh(x):
    return sinh(x) / cosh(x)


def ellipk(m):
    """Complete elliptic integral K(m), m = k², by the arithmetic-geometric mean."""
    a, b = D(1), (1 - d(m)).sqrt()
    while abs(a - b) > D(10) ** -(getcontext().prec - 4):
        a, b = (a + b) / 2, (a * b).sqrt()
    return PI / (a + b)


def jacobi(u, m):
    """sn, cn, dn of (u | m) by the descending Landen transformation (Abramowitz and Stegun 16.4)."""
    m = d(m)
    a, b, c = [D(1)], (1 - m).sqrt(), [m.sqrt()]
    while abs(c[-1]) > D(10) ** -(getcontext().prec - 4):
        a_n, c_n = (a[-1] + b) / 2, (a[-1] - b) / 2
        b = (a[-1] * b).sqrt()
        a.append(a_n)
        c.append(c_n)
    phi = 2 ** (len(a) - 1) * a[-1] * d(u)
    for n in range(len(a) - 1, 0, -1):
        phi = (phi + asin(c[n] / a[n] * sin(phi))) / 2
    sn = sin(phi)
    return sn, cos(phi), (1 - m * sn * sn).sqrt()


def solve(matrix, right):
    """Gaussian elimination with pivoting."""
    n = len(right)
    rows = [list(matrix[i]) + [right[i]] for i in range(n)]
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[p] = rows[p], rows[k]
        for i in range(k + 1, n):
            f = rows[i][k] / rows[k][k]
            rows[i] = [x - f * y for x, y in zip(rows[i], rows[k])]
    x = [D(0)] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n))) / rows[k][k]
    return x


def _gragg(f, t, y, h, n):
    """n modified midpoint steps over [t, t + h] with Gragg's smoothing: the error is a series in (h/n)²."""
    s = h / n
    previous, current = y, [a + s * b for a, b in zip(y, f(t, y))]
    for i in range(1, n):
        slope = f(t + i * s, current)
        previous, current = current, [a + 2 * s * b for a, b in zip(previous, slope)]
    slope = f(t + h, current)
    return [(a + b + s * c) / 2 for a, b, c in zip(current, previous, slope)]


def _extrapolated_step(f, t, y, h, rows):
    table, best, error = [], None, None
    for i in range(rows):
        row = [_gragg(f, t, y, h, 2 * (i + 1))]
        for j in range(1, i + 1):
            ratio = (D(i + 1) / D(i + 1 - j)) ** 2 - 1
            row.append([a + (a - b) / ratio for a, b in zip(row[j - 1], table[-1][j - 1])])
        if i == rows - 1:
            error = max(abs(a - b) for a, b in zip(row[-1], row[-2]))
        table.append(row)
    return table[-1][-1], error


def integrate(f, y, times, tolerance=D("1e-19"), start=D(0), rows=11):
    """The states of y' = f(t, y) at `times` (ascending), by extrapolation of the midpoint rule (Gragg, Bulirsch,
    Stoer)."""
    t, y, h, results = d(start), [d(a) for a in y], D("0.05"), []
    for target in map(d, times):
        while t < target:
            step = min(h, target - t)
            new, error = _extrapolated_step(f, t, y, step, rows)
            scale = float(error / tolerance) if error else 1e-30
            if scale <= 1:
                t, y = (target, new) if step == target - t else (t + step, new)
            if scale > 1 or step == h:
                h = step * d(round(min(4.0, max(0.2, 0.9 * scale ** (-1.0 / (2 * rows - 1)))), 6))
        results.append(list(y))
    return results


def motion(acceleration, q, v, times, **options):
    """Positions and velocities [(q, v)] at `times` of q'' = acceleration(t, q, v)."""
    n = len(q)
    states = integrate(lambda t, y: y[n:] + acceleration(t, y[:n], y[n:]), list(q) + list(v), times, **options)
    return [(y[:n], y[n:]) for y in states]
