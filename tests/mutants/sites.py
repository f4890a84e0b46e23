"""Where a C++ file can be changed in one place so that it means something else, and what each change is."""
import hashlib
import re
from dataclasses import dataclass

TOKEN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*)
      | (?P<text>R"(?P<tag>\w*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')
      | (?P<number>0[xX][0-9a-fA-F.']+(?:[pP][+-]?\d+)?\w*|(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\w*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<sign><=>|<<=|>>=|->\*?|\+\+|--|&&|\|\||[+\-*/%&|^=!<>]=|::|<<|>>|[{}()\[\];,.?:~!<>=+\-*/%&|^])""",
    re.VERBOSE | re.DOTALL | re.MULTILINE)

# A binary operator has spaces around it in this tree, a bracket of a template or a reference has not.
BINARY = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="],
    "<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"], "==": ["!="], "!=": ["=="],
    "&&": ["||"], "||": ["&&"],
}
KIND = {**dict.fromkeys(["+", "-", "*", "/", "+=", "-=", "*=", "/="], "sign"),
        **dict.fromkeys(["<", "<=", ">", ">=", "==", "!="], "relation"), "&&": "logic", "||": "logic"}
BEFORE_OPERAND = {"(", ",", "=", "?", ":", "{", "[", "<", ">", "<=", ">=", "==", "!=", "+", "-", "*", "/",
                  "&&", "||", "+=", "-=", "return"}
WORDS = {"true": "false", "false": "true", "min": "max", "max": "min"}
STATEMENT = re.compile(r"^\s*(?!return\b|break\b|continue\b|using\b|case\b|default\b|if\b|for\b|while\b|else\b|"
                       r"throw\b|delete\b|goto\b|static\b|const\b|auto\b|typename\b|friend\b)"
                       r"(?:[\w.\[\]>()-]|::|->)*[\w\])](?:\(.*\)| [+*/|&-]?= .*);\s*(?://.*)?$")
# Broken preconditions and inconsistencies inside are no behaviour; room reserved ahead is none either.
LEFT_ALONE = re.compile(r"MAUP_REQUIRE|logic_error|please report|\.reserve\(|static_assert|"
                        r"^\s*(?:template|using|namespace)\b")


@dataclass(frozen=True)
class Mutant:
    path: str        # from the root of the tree
    line: int
    start: int       # the characters that are replaced
    end: int
    before: str
    after: str
    kind: str        # sign, relation, logic, factor, bound, statement, condition, word
    name: str        # what it is, independent of line numbers: path, the line's text, the change, which of several

    def order(self, seed):
        """A place in the draw that other changes of the tree do not move."""
        return hashlib.sha256(f"{seed} {self.name}".encode()).hexdigest()

    def apply(self, text):
        return text[:self.start] + self.after + text[self.end:]


def tokens(text):
    return [(m.lastgroup if m.lastgroup != "tag" else "text", m.group(), m.start(), m.end())
            for m in TOKEN.finditer(text) if m.lastgroup != "skip"]


def mutants(path, text):
    """All mutants of a file, in its order."""
    changes = sorted({*_of_tokens(text), *_of_statements(text), *_of_conditions(text)})
    lines, out, seen = text.split("\n"), [], {}
    for start, end, after, kind in changes:
        number = text.count("\n", 0, start)
        line = lines[number]
        if LEFT_ALONE.search(line):
            continue
        before = text[start:end]
        name = f"{path}: {line.strip()}: {_shown(before)} → {_shown(after)}"
        seen[name] = seen.get(name, 0) + 1
        if seen[name] > 1:
            name += f" #{seen[name]}"
        out.append(Mutant(path, number + 1, start, end, before, after, kind, name))
    return out


def _shown(code):
    code = " ".join(code.split())
    return code if code else "nothing"


def _of_tokens(text):
    list_of = tokens(text)
    for i, (group, word, start, end) in enumerate(list_of):
        before = list_of[i - 1][1] if i else ""
        beside_text = any(list_of[j][0] == "text" for j in (i - 1, i + 1) if 0 <= j < len(list_of))
        spaced = text[start - 1:start] in (" ", "\n") and text[end:end + 1] in (" ", "\n")
        binary = word in BINARY and spaced and before != "operator"
        if group == "sign" and binary and not (beside_text and word in "+-"):
            if word in "+-*/" and (before in BEFORE_OPERAND or before in ("const", "auto")):
                continue
            for after in BINARY[word]:
                yield start, end, after, KIND[word]
        elif word == "-" and not spaced and before in BEFORE_OPERAND:
            yield start, end, "", "sign"
        elif word == "!" and group == "sign":
            yield start, end, "", "logic"
        elif group == "number":
            yield from _of_number(text, list_of, i)
        elif word in WORDS and (word in ("true", "false") or before == "::"):
            yield start, end, WORDS[word], "word"


def _of_number(text, list_of, i):
    """Factors by ten, whole numbers elsewhere by one."""
    _, word, start, end = list_of[i]
    near = {list_of[j][1] for j in (i - 1, i + 1) if 0 <= j < len(list_of)}
    if "<" in near and text[start - 1:start] == "<" or ">" in near and text[end:end + 1] == ">":
        return  # an argument of a template
    real = re.search(r"[.']|[eE][+-]?\d|[pP]", word) and not re.fullmatch(r"[\d']+|0[xX][\da-fA-F]+", word)
    if real or near & {"*", "/"}:
        if float_of(word) != 0:
            yield start, end, f"(10 * {word})", "factor"
            if real:
                yield start, end, f"({word} / 10)", "factor"
    elif re.fullmatch(r"\d+", word):
        yield start, end, str(int(word) + 1), "bound"


def float_of(word):
    word = word.replace("'", "").rstrip("fFlLuU")
    return float.fromhex(word) if word.lower().startswith("0x") else float(word)


def _of_statements(text):
    at = 0
    for line in text.split("\n"):
        if STATEMENT.match(line) and line.count("(") == line.count(")"):
            code = line.rstrip()
            yield at + len(line) - len(line.lstrip()), at + len(code), ";", "statement"
        at += len(line) + 1


def _of_conditions(text):
    for m in re.finditer(r"^[ \t}]*(?:else )?if \(", text, re.MULTILINE):
        depth, at = 1, m.end()
        while depth and at < len(text):
            depth += {"(": 1, ")": -1}.get(text[at], 0)
            at += 1
        condition = text[m.end():at - 1]
        if ";" not in condition and not re.search(r"\w \w+ = |\w[*&] \w+ = ", condition):
            yield m.end(), at - 1, "false", "condition"
