"""Models of the robots of the reference cases: what an import of URDF files will write, checked by inverse dynamics."""
import re
import xml.etree.ElementTree as xml

from case_math import D, number
from precise import PI


def numbers(element, attribute, default):
    return (element.get(attribute) if element is not None and element.get(attribute) else default).split()


def vector(words):
    return "(" + ", ".join(re.sub(r"^(-?)0*(\d)", r"\1\2", ("-" if w.startswith("-") else "") + number(w.lstrip("-+")))
                           for w in words) + ")"


def angles(words):
    """Roll, pitch, yaw; a double that is a quarter or an eighth of a turn is written as what it means."""
    names = {-2: "-pi/2", -1: "-pi/4", 1: "pi/4", 2: "pi/2", 4: "pi", -4: "-pi"}
    turns = [next((names[k] for k in names if abs(D(w) - k * PI / 4) < D("1e-9")), None) for w in words]
    return "(" + ", ".join(turn or vector([w])[1:-1] for turn, w in zip(turns, words)) + ")"


def is_zero(words):
    return all(D(w) == 0 for w in words)


def short(name):
    return re.sub(r"\W", "_", name)


class Robot:
    """The frames and bodies of a tree of links, in the order of the joints."""

    def __init__(self, path, joint_names):
        root = xml.parse(path).getroot()
        self.links = {link.get("name"): link for link in root.findall("link")}
        self.joints = root.findall("joint")
        self.coordinate = {name: f"q{i + 1}" for i, name in enumerate(joint_names)}
        self.kinds, self.lines = {}, []
        children = {joint.find("child").get("link") for joint in self.joints}
        parents = [joint.find("parent").get("link") for joint in self.joints]
        for base in dict.fromkeys(name for name in parents if name not in children):
            self.descend(base, None)

    def descend(self, link, frame):
        """`frame`: that of the link, or None for the ground, whose inertia moves nothing."""
        if frame:
            self.body(link, frame)
        for joint in self.joints:
            if joint.find("parent").get("link") == link:
                self.descend(joint.find("child").get("link"), self.joint(joint, frame))

    def joint(self, joint, parent):
        name, origin = short(joint.get("name")), joint.find("origin")
        at, rpy = numbers(origin, "xyz", "0 0 0"), numbers(origin, "rpy", "0 0 0")
        axis = vector(numbers(joint.find("axis"), "xyz", "1 0 0"))
        q = self.coordinate.get(joint.get("name"))
        inside = f" in {parent}" if parent else ""
        if q and not is_zero(rpy) or not q or joint.get("type") == "prismatic":
            seat = f"{name}_seat" if q else name
            turned = "" if is_zero(rpy) else f" rotation rpy {angles(rpy)}"
            if q is None and is_zero(rpy) and is_zero(at):
                return parent
            self.lines.append(f"frame {seat} at {vector(at)}{turned}{inside}")
            at, inside = "0 0 0".split(), f" in {seat}"
        if q is None:
            return name
        if joint.get("type") == "prismatic":
            self.kinds[q] = "length"
            self.lines.append(f"frame {name} at {q} {axis}{inside}")
        else:
            self.kinds[q] = "angle"
            self.lines.append(f"frame {name} at {vector(at)} rotation axis {axis} angle {q}{inside}")
        return name

    def body(self, link, frame):
        inertial = self.links[link].find("inertial")
        if inertial is None:
            return
        at, rpy = numbers(inertial.find("origin"), "xyz", "0 0 0"), numbers(inertial.find("origin"), "rpy", "0 0 0")
        inertia = inertial.find("inertia")
        entries = [inertia.get(k, "0") for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
        turned = "" if is_zero(rpy) else f" rotation rpy {angles(rpy)}"
        mass = vector([inertial.find("mass").get("value")])[1:-1]
        if mass == "0" and is_zero(entries):
            return
        inertia = f"inertia full{vector(entries)}"
        self.lines.append(f"body {short(link)} mass {mass} {inertia} at {vector(at)}{turned} in {frame}")


def wrapped(head, items, width=110):
    lines = [head + items[0]]
    for item in items[1:]:
        if len(lines[-1]) + len(item) > width:
            lines[-1] += ","
            lines.append("    " + item)
        else:
            lines[-1] += ", " + item
    return lines


def urdf_model(case, folder):
    """Two models: the stated torques at the stated state, and at rest M q̈ + g; both must give the stated
    accelerations."""
    statement = case["statement"]
    robot = Robot(folder / "urdf" / statement["data_file"].split("/")[-1], statement["coordinates"])
    state = next(e for e in case["expected"] if e["kind"] == "state")
    named = {e["quantity"].split()[0]: e["values"] for e in case["expected"] if e["kind"] in ("matrix", "vector")}
    q, qd, qdd = state["q"], state["qd"], state["qdd"]
    at_rest = [sum((D(m) * D(a) for m, a in zip(row, qdd)), D(g))
               for row, g in zip(named["joint-space"], named["gravity"])]
    return {f"{case['id']}.lag": model(case, robot, "", q, qd, named["inverse"], qdd),
            f"{case['id']}_at_rest.lag": model(case, robot, "_at_rest", q, ["0"] * len(q), at_rest, qdd)}


def model(case, robot, suffix, q, qd, torques, qdd):
    coordinates = list(robot.kinds)
    lines = [f"# Generated from tests/problems/cases/{case['id']}.json by scripts/convert_cases.py: do not edit.",
             f"system {case['id']}{suffix} \"{case['title']}\"", f"source \"{case['source']['where']}\"",
             "dimensionless                          # SI throughout, as the robot's file", ""]
    lines += [f"# {name} = {joint}" for name, joint in zip(coordinates, case["statement"]["coordinates"])]
    groups = [(kind, [n for n in coordinates if robot.kinds[n] == kind])
              for kind in dict.fromkeys(robot.kinds.values())]
    lines += ["coord " + ", ".join(f"{', '.join(members)} : {kind}" for kind, members in groups)] + robot.lines
    lines += ["gravity " + vector(case["statement"]["gravity"])]
    lines += [f"force {name} = {vector([str(torque)[:24]])[1:-1]}" for name, torque in zip(coordinates, torques)]
    starts = [f"{name} = {vector([a])[1:-1]}" for name, a in zip(coordinates, q)]
    starts += [f"{name}' = {vector([a])[1:-1]}" for name, a in zip(coordinates, qd) if D(a) != 0]
    lines += wrapped("start ", starts) + ["run 0.01", ""]
    lines += [f"expect {name}'' at 0 = {vector([a])[1:-1]} ± 1e-10" for name, a in zip(coordinates, qdd)]
    return "\n".join(lines) + "\n"
