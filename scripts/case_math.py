"""The math strings of the reference cases: read, print in the model language, evaluate in 44-digit decimals."""
import re

import precise
from precise import D

GREEK = dict(alpha="α", beta="β", gamma="γ", delta="δ", epsilon="ε", zeta="ζ", eta="η", theta="θ", iota="ι", kappa="κ",
             nu="ν", mu="μ", xi="ξ", rho="ρ", sigma="σ", tau="τ", phi="φ", chi="χ", psi="ψ", omega="ω")
CIRCULAR = {"sin", "cos", "tan", "sinh", "cosh", "tanh"}
FUNCTIONS = CIRCULAR | {"asin", "acos", "atan", "sqrt", "exp", "log", "dot", "ddot"}
TOKEN = re.compile(r"\s*(?:(\d*\.?\d+(?:[eE][+-]?\d+)?\.?|\d+\.)|([A-Za-z_]\w*)|(\S))")

# A tree is ("num", text), ("name", text), ("call", function, tree), ("dot", order, tree), ("neg", tree) or
# (operator, tree, tree) with operator one of + - * / ^.


def parse(text):
    tokens = [m.groups() for m in TOKEN.finditer(text) if m.group().strip()]
    position = 0

    def peek():
        return tokens[position][2] if position < len(tokens) else None

    def take():
        nonlocal position
        position += 1
        return tokens[position - 1]

    def expect(sign):
        if take()[2] != sign:
            raise ValueError(f"{sign} expected in {text}")

    def binary(signs, operand):
        tree = operand()
        while peek() and peek() in signs:
            tree = (take()[2], tree, operand())
        return tree

    def total():
        return binary("+-", term)

    def term():
        if peek() == "-":
            take()
            return ("neg", product())
        return product()

    def product():
        return binary("*/", factor)

    def factor():
        if peek() == "-":
            take()
            return ("neg", factor())
        if peek() == "+":
            take()
            return factor()
        base = atom()
        if peek() == "^":
            take()
            return ("^", base, factor())
        return base

    def atom():
        number, word, sign = take()
        if number:
            return ("num", number)
        if sign == "(":
            tree = total()
            expect(")")
            return tree
        if peek() == "(" and word in FUNCTIONS:
            take()
            argument = total()
            expect(")")
            if word in ("dot", "ddot"):
                order = len(word) - 2
                return ("dot", order + argument[1], argument[2]) if argument[0] == "dot" else ("dot", order, argument)
            return ("call", word, argument)
        return ("name", word)

    tree = total()
    if position != len(tokens):
        raise ValueError(f"cannot read the end of {text}")
    return tree


def evaluate(tree, values):
    kind = tree[0]
    if kind == "num":
        return D(tree[1])
    if kind == "name":
        return precise.PI if tree[1] == "pi" else values[tree[1]]
    if kind == "call":
        return getattr(precise, tree[1])(evaluate(tree[2], values))
    if kind == "neg":
        return -evaluate(tree[1], values)
    if kind == "dot":
        raise ValueError("a derivative has no value here")
    a, b = evaluate(tree[1], values), evaluate(tree[2], values)
    return {"+": lambda: a + b, "-": lambda: a - b, "*": lambda: a * b, "/": lambda: a / b, "^": lambda: a ** b}[kind]()


def names(tree):
    """Every name of a tree, as often as it stands there."""
    return [tree[1]] if tree[0] == "name" else [n for part in tree[1:] if isinstance(part, tuple) for n in names(part)]


def derivative(tree, values, t):
    """Of a closed form of t, by a central difference: 44 digits leave 20 after it."""
    h = D("1e-11")
    low, high = (evaluate(tree, {**values, "t": t + s * h}) for s in (-1, 1))
    return (high - low) / (2 * h)


# ------------------------------------------------------------------------------------------------------------ printing


def greek(name):
    """theta → θ, q1 → q1, omega2 → ω2: whole Greek names only; p_theta → p_θ. lambda3 is the multiplier of the third
    constraint."""
    if name.startswith("lambda"):
        return f"multiplier(c{name[6:]})"
    if name.startswith("p_"):
        return "p_" + greek(name[2:])
    stem = re.fullmatch(r"([A-Za-z]+?)(\d*)", name)
    return GREEK[stem[1]] + stem[2] if stem and stem[1] in GREEK else name


def number(text):
    """0.5 for .5, and a plain decimal where the exponent is 0: 0.37e+00 → 0.37."""
    mantissa, _, exponent = text.lower().partition("e")
    mantissa = "0" + mantissa if mantissa.startswith(".") else mantissa
    mantissa = mantissa.rstrip(".") if mantissa.endswith(".") else mantissa
    return mantissa if not exponent or int(exponent) == 0 else f"{mantissa}e{int(exponent)}"


LEVEL = {"+": 1, "-": 1, "neg": 1, "*": 2, "/": 2, "^": 3}


def show(tree, level=0):
    """The tree in the model language; brackets where a context of `level` needs them."""
    text = _show(tree)
    return f"({text})" if LEVEL.get(tree[0], 4) < level else text


def _show(tree):
    kind = tree[0]
    if kind == "num":
        return number(tree[1])
    if kind == "name":
        return greek(tree[1])
    if kind == "dot":
        inner = tree[2]
        return greek(inner[1]) + "'" * tree[1] if inner[0] == "name" else _dots(tree[1], show(inner))
    if kind == "call":
        bare = tree[1] in CIRCULAR and tree[2][0] == "name"
        return f"{tree[1]} {show(tree[2])}" if bare else f"{tree[1]}({show(tree[2])})"
    if kind == "neg":
        return f"-{show(tree[1], 2)}"
    if kind == "^":
        return _power(tree)
    if kind in "*/":
        return _product(tree)
    return f"{show(tree[1], 1)} {kind} {show(tree[2], 2)}"


def _dots(order, text):
    return text if order == 0 else f"dot({_dots(order - 1, text)})"


def _power(tree):
    base, exponent = tree[1], tree[2]
    shown = show(exponent, 4)
    if _is_bare(base):
        return f"{base[1]}^{shown} {show(base[2])}" if exponent[0] == "num" else f"({show(base)})^{shown}"  # sin^2 θ
    return f"{show(base, 4)}^{shown}"


def _factors(tree):
    """(sign, factor) of a chain of products and quotients, left to right."""
    if tree[0] in "*/" and len(tree) == 3:
        return _factors(tree[1]) + [(tree[0], tree[2])]
    return [("*", tree)]


def _is_bare(tree):
    return tree[0] == "^" and _is_bare(tree[1]) or tree[0] == "call" and tree[1] in CIRCULAR and tree[2][0] == "name"


def _product(tree):
    """A space multiplies, except where it could be misread: after a quotient, after a bare sin x, before a number."""
    factors = _factors(tree)
    text = ""
    for i, (sign, factor) in enumerate(factors):
        word = show(factor, 2 if i == 0 else 3)
        if _is_bare(factor) and i + 1 < len(factors) and factors[i + 1][0] == "/":
            word = f"{factor[1]}({show(factor[2])})" if factor[0] == "call" else f"({word})"
        after = factors[i - 1] if i else None
        closed = factor[0] in ("call", "+", "-") or _is_bare(factor)
        careful = word[0].isdigit() or after and not closed and (after[0] == "/" or _is_bare(after[1]))
        text += word if i == 0 else "/" + word if sign == "/" else (" * " if careful else " ") + word
    return text


def terms(tree):
    """The signed terms of a sum, in order."""
    if tree[0] == "+":
        return terms(tree[1]) + terms(tree[2])
    if tree[0] == "-":
        return terms(tree[1]) + [(-sign, term) for sign, term in terms(tree[2])]
    if tree[0] == "neg":
        return [(-sign, term) for sign, term in terms(tree[1])]
    return [(1, tree)]


def show_long(tree, head, width=110):
    """`head` and the tree; a long sum is broken before its signs, continuation lines indented."""
    whole = head + show(tree)
    if len(whole) <= width:
        return whole
    lines, line = [], head
    for i, (sign, term) in enumerate(terms(tree)):
        word = show(term, 2)
        piece = (f"-{word}" if sign < 0 else word) if i == 0 else (f" - {word}" if sign < 0 else f" + {word}")
        if len(line) + len(piece) > width and i > 0:
            lines.append(line)
            line = "    " + piece.lstrip()
        else:
            line += piece
    return "\n".join(lines + [line])
