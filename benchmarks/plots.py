#!/usr/bin/env python3
"""plots.py MEASURED FOLDER: step_cost.svg, forward_dynamics.svg and work_precision.svg from what
scripts/bench has measured."""
import json, math, sys
from pathlib import Path

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 420, 72, 150, 20, 56
COLORS = ["#1f4e79", "#b0413e", "#3a7d44", "#7a5195"]
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Axis:
    """A logarithmic axis between two pixels."""

    def __init__(self, values, begin, end, ticks=None):
        low, high = math.log10(min(values)), math.log10(max(values))
        margin = 0.05 * (high - low)
        self.low, self.high, self.begin, self.end = low - margin, high + margin, begin, end
        decades = range(math.ceil(self.low), math.floor(self.high) + 1)
        step = max(1, math.ceil(len(decades) / 7))
        self.ticks = ticks or [(10.0 ** k, "10" + str(k).translate(SUPERSCRIPT)) for k in decades if k % step == 0]

    def at(self, value):
        return self.begin + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.begin)


def text(x, y, content, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{content}</text>'


def frame(x, y, x_label, y_label):
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    parts = [f'<path d="M{LEFT} {TOP}V{bottom}H{right}" fill="none" stroke="#333"/>']
    for value, label in x.ticks:
        parts.append(f'<path d="M{x.at(value):.1f} {bottom}v5" stroke="#333"/>'
                     f'<path d="M{x.at(value):.1f} {bottom}V{TOP}" stroke="#e6e6e6"/>')
        parts.append(text(x.at(value), bottom + 19, label, 'text-anchor="middle"'))
    for value, label in y.ticks:
        parts.append(f'<path d="M{LEFT} {y.at(value):.1f}h-5" stroke="#333"/>'
                     f'<path d="M{LEFT} {y.at(value):.1f}H{right}" stroke="#e6e6e6"/>')
        parts.append(text(LEFT - 9, y.at(value) + 4, label, 'text-anchor="end"'))
    parts.append(text((LEFT + right) / 2, HEIGHT - 14, x_label, 'text-anchor="middle"'))
    middle = (TOP + bottom) / 2
    parts.append(text(18, middle, y_label, f'text-anchor="middle" transform="rotate(-90 18 {middle})"'))
    return parts


def spread(places, distance=16):
    """Label heights in ascending order, pushed apart so that none covers another."""
    order = sorted(range(len(places)), key=lambda i: places[i])
    result = list(places)
    for before, after in zip(order, order[1:]):
        result[after] = max(result[after], result[before] + distance)
    return result


def crosses(curve, left, right, top, bottom):
    """Whether a polyline passes through a box."""
    for (a, b), (c, d) in zip(curve, curve[1:]):
        if any(left <= a + s * (c - a) <= right and top <= b + s * (d - b) <= bottom
               for s in (i / 20 for i in range(21))):
            return True
    return False


def label_of_early_end(curves, place, label):
    """Above the end, else below it to the right, where no curve passes: x, y, anchor."""
    wide, (a, b) = 7.2 * len(label), place
    covered = any(crosses(curve, a + 8 - wide, a + 8, b - 26, b - 10) for curve in curves)
    return (a + 10, b + 14, "start") if covered else (a + 8, b - 12, "end")


def draw(path, series, x_label, y_label, x_ticks=None):
    """series: [(label, [(x, y)])]; each is labelled beside the frame at the height of its last point, at the end itself
    where the curve ends early."""
    series = [(label, sorted(points)) for label, points in series if points]
    if not series:
        return
    x = Axis([p[0] for _, points in series for p in points], LEFT, WIDTH - RIGHT, x_ticks)
    y = Axis([p[1] for _, points in series for p in points], HEIGHT - BOTTOM, TOP)
    parts = frame(x, y, x_label, y_label)
    ends_early = [x.at(points[-1][0]) < WIDTH - RIGHT - 40 for _, points in series]
    beside = iter(spread([y.at(points[-1][1]) + 4 for (_, points), early in zip(series, ends_early) if not early]))
    curves = [[(x.at(a), y.at(b)) for a, b in points] for _, points in series]
    for (label, _), places, color, early in zip(series, curves, COLORS, ends_early):
        parts.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in places)}" fill="none" '
                     f'stroke="{color}" stroke-width="1.6"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{color}"/>' for a, b in places]
        if early:
            a, b, anchor = label_of_early_end(curves, places[-1], label)
            parts.append(text(a, b, label, f'fill="{color}" text-anchor="{anchor}"'))
        else:
            parts.append(text(WIDTH - RIGHT + 4, next(beside), label, f'fill="{color}"'))
    body = "\n".join(parts)
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" '
                    f'viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
                    f'font-family="Latin Modern Roman, STIX Two Text, Georgia, serif" font-size="14" fill="#222">\n'
                    f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n{body}\n</svg>\n')


def steps(data, backend, compiled):
    points = []
    for name, row in data["stepping"].items():
        wanted = name.startswith(f"steps/{backend}/") and name.endswith("/order:0") and "step" in row
        if wanted and (row["label"] == "compiled") == compiled:
            points.append((int(name.split("links:")[1].split("/")[0]), 1e6 * row["step"]))
    return points


def forward(data, who):
    return [(int(name.split("/")[1]), 1e-3 * row["cpu_time"]) for name, row in data["forward_dynamics"].items()
            if name.startswith(who + "/") and "cpu_time" in row]


def accuracy(data, who):
    return [(row["energy_error"], 1e6 * row["second_of_motion"]) for name, row in data["peers"].items()
            if name.startswith(f"motion/{who}/") and "energy_error" in row]


def main():
    data, folder = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    sizes = [(n, str(n)) for n in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)]
    draw(folder / "step_cost.svg",
         [("interpreter", steps(data, "interpreter", False)), ("compiled", steps(data, "compiled", True))],
         "links n of the chain", "time of a Taylor step of order 20 / µs", sizes)
    draw(folder / "forward_dynamics.svg",
         [("Maupertuis, compiled", forward(data, "compiled_chain")), ("interpreted", forward(data, "chain")),
          ("MuJoCo, mj_forward", forward(data, "mujoco"))],
         "links n of the chain", "time of a call / µs", sizes)
    draw(folder / "work_precision.svg",
         [("Maupertuis", accuracy(data, "maupertuis")), ("odeint, Fehlberg 7(8)", accuracy(data, "odeint_fehlberg78")),
          ("odeint, Bulirsch–Stoer", accuracy(data, "odeint_bulirsch_stoer")),
          ("CVODE, Adams", accuracy(data, "cvode_adams"))],
         "largest relative error of the energy in 100 s", "processor time of a second of motion / µs")


main()
