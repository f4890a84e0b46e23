"""Forward dynamics of an open chain of revolute joints by recursive Newton-Euler, in decimals: no Lagrangian
anywhere."""
from precise import D, cos, sin, solve


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def add(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def scale(s, v):
    return [s * x for x in v]


def apply(r, v):
    return [sum(r[i][j] * v[j] for j in range(3)) for i in range(3)]


def transposed(r, v):
    return [sum(r[j][i] * v[j] for j in range(3)) for i in range(3)]


def turn(r, axis, c, s):
    """r · (rotation about `axis`, one of 2 (z) and 1 (y), by the angle of cosine c and sine s)."""
    local = [[c, -s, 0], [s, c, 0], [0, 0, 1]] if axis == 2 else [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    return [[sum(r[i][k] * local[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


class Chain:
    """Joint i turns about `axes[i]`; the next joint sits at (0, 0, lengths[i]), the mass at (0, 0, centres[i])."""

    def __init__(self, axes, lengths, centres, masses, inertias, gravity):
        self.axes, self.lengths, self.centres = axes, lengths, centres
        self.masses, self.inertias, self.gravity = masses, inertias, gravity

    def torques(self, rotations, v, a, gravity):
        n, zero = len(v), [D(0)] * 3
        w, dw, acceleration = zero, zero, [D(0), D(0), gravity]
        forces, moments, arms, centres, joints = [], [], [], [], []
        for i in range(n):
            r = rotations[i]
            axis = [r[k][self.axes[i]] for k in range(3)]
            dw = add(dw, scale(a[i], axis), scale(v[i], cross(w, axis)))
            w = add(w, scale(v[i], axis))
            up = [r[k][2] for k in range(3)]
            c, arm = scale(self.centres[i], up), scale(self.lengths[i], up)
            at_centre = add(acceleration, cross(dw, c), cross(w, cross(w, c)))
            forces.append(scale(self.masses[i], at_centre))
            local_w, local_dw, inertia = transposed(r, w), transposed(r, dw), self.inertias[i]
            momentum = [x * y for x, y in zip(inertia, local_w)]
            local = add([x * y for x, y in zip(inertia, local_dw)], cross(local_w, momentum))
            moments.append(add(apply(r, local), cross(c, forces[-1])))
            acceleration = add(acceleration, cross(dw, arm), cross(w, cross(w, arm)))
            arms.append(arm)
            joints.append(axis)
        force, moment, result = zero, zero, [D(0)] * n
        for i in reversed(range(n)):
            moment = add(moments[i], moment, cross(arms[i], force))
            force = add(forces[i], force)
            result[i] = sum(x * y for x, y in zip(joints[i], moment))
        return result

    def acceleration(self, q, v, torque):
        n = len(q)
        r, rotations = [[D(i == j) for j in range(3)] for i in range(3)], []
        for i in range(n):
            r = turn(r, self.axes[i], cos(q[i]), sin(q[i]))
            rotations.append(r)
        bias = self.torques(rotations, v, [D(0)] * n, self.gravity)
        still = [D(0)] * n
        columns = [self.torques(rotations, still, [D(i == j) for i in range(n)], D(0)) for j in range(n)]
        return solve([[columns[j][i] for j in range(n)] for i in range(n)], [t - b for t, b in zip(torque, bias)])
