"""Where C++ code can be changed a little, and into what."""

import bisect
import dataclasses
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tidy"))

import cpp  # noqa: E402
import spans  # noqa: E402

_COMPARISON = re.compile(r"(?<=\s)(<=|>=|==|!=|<|>)(?=\s)")
_COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
_LOGIC = re.compile(r"(?<=\s)(&&|\|\|)(?=\s)")
_ARITHMETIC = re.compile(r"(?<=\s)([+-]=?)(?=\s)")
_CALCULATED = {"+": "-", "-": "+", "+=": "-=", "-=": "+="}
_NUMBER = re.compile(r"(?<![\w.'])(0[xX][0-9a-fA-F']+|[0-9][0-9']*)([uUlLzZ]*)(?![\w.'])")
_PURE_VIRTUAL = re.compile(r"\)\s*(?:(?:const|noexcept|override|final)\s*)*=\s*\Z")
_CONDITION = re.compile(r"\b(if|while)\s*\(")
_ASSIGNED = re.compile(r"(?<![=!<>+*/|&-])=(?!=)")
_RETURN = re.compile(r"\s*\{?\s*(?:co_)?return\b")
_JOINED = re.compile(r"\s(?:&&|\|\||\?)\s")
_COMPARED_ONCE = re.compile(r"\s(?:[<>]=?|[!=]=)\s")
_NOT = re.compile(r"(?<![!\w])!(?=[\w(*:])")
_RETURNED = re.compile(r"\b(?:co_)?return\s+(true|false)\s*;")
_TRANSITIONS = re.compile(r"\bto_array<Transition<[^;]*?\(")
_TRANSITION = re.compile(r"\{[\w:]+, [\w:]+, [\w:]+\},")
_LOGGED = re.compile(r"^\s*(?:spdlog::|(?:\w+(?:\.|->))*(?:log|logger)_?(?:\.|->|\()).*$", re.MULTILINE)
_NO_PRODUCT_CODE = re.compile(r"\b(?:static_assert|guarded)\s*\(")


@dataclasses.dataclass(frozen=True)
class Mutation:
    path: str
    line: int
    column: int
    kind: str
    text: str  # the whole line of the source, without blanks around it
    start: int
    end: int
    before: str
    after: str

    @property
    def id(self):
        return f"{self.path}:{self.line}:{self.column}:{self.kind}"

    @property
    def description(self):
        return f"`{_on_one_line(self.before)}` -> `{_on_one_line(self.after)}` in `{self.text}`"

    def applied(self, source):
        return source[: self.start] + self.after + source[self.end :]


@dataclasses.dataclass(frozen=True)
class _Edit:
    kind: str
    at: int  # what the mutation is named by
    start: int
    end: int
    after: str


def _on_one_line(text):
    return re.sub(r"\s*\n\s*", " ", text)


def _blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def mutable(source):
    """The source with all that is not to be mutated as blanks, every byte at its place."""
    code = _LOGGED.sub(_blank, cpp.without_directives(cpp.blanked(source)))
    for match in reversed(list(_NO_PRODUCT_CODE.finditer(code))):
        end = spans.closing(code, match.end() - 1)
        code = code[: match.end()] + re.sub(r"[^\n]", " ", code[match.end() : end]) + code[end:]
    return code


def _swapped(kind, pattern, others):
    def find(code, _source):
        for match in pattern.finditer(code):
            yield _Edit(kind, match.start(), match.start(), match.end(), others[match.group()])

    return find


def _arithmetic(code, source):
    for edit in _swapped("arithmetic", _ARITHMETIC, _CALCULATED)(code, source):
        # Texts that are joined cannot be subtracted.
        if '"' not in (code[: edit.start].rstrip()[-1:], code[edit.end :].lstrip()[:1]):
            yield edit


def _logic(code, source):
    """&& and || swapped; operands that hold the same operator get parentheses, and keep their meaning."""
    for match in _LOGIC.finditer(code):
        operator = match.group()
        after = "||" if operator == "&&" else "&&"
        start, end = match.span()
        left, left_same = spans.left_operand(code, start, operator)
        right, right_same = spans.right_operand(code, end, operator)
        if left_same:
            left_end = left + len(code[left:start].rstrip())
            after = f"({source[left:left_end]}){source[left_end:start]}{after}"
            start = left
        if right_same:
            right_start = right - len(code[end:right].lstrip())
            after = f"{after}{source[end:right_start]}({source[right_start:right]})"
            end = right
        yield _Edit("logic", match.start(), start, end, after)


def _numbers(code, _source):
    for match in _NUMBER.finditer(code):
        digits, suffix = match.groups()
        plain = digits.replace("'", "")
        hexadecimal = plain[:2] in ("0x", "0X")
        if (plain[0] == "0" and len(plain) > 1 and not hexadecimal) or _PURE_VIRTUAL.search(
            code, max(0, match.start() - 80), match.start()
        ):
            continue
        value = int(plain, 0)
        for kind, other in (("plus-one", value + 1), ("minus-one", value - 1)):
            if other < 0:
                continue
            text = f"0x{other:0{len(plain) - 2}x}" if hexadecimal else f"{other:_}" if "'" in digits else str(other)
            yield _Edit(kind, match.start(), *match.span(), text.replace("_", "'") + suffix)


def _conditions(code):
    """Of each condition that is an expression: whether it is an if's, where it begins and ends, where its `)` is."""
    for match in _CONDITION.finditer(code):
        end = spans.closing(code, match.end() - 1)
        outer = spans.outermost(code[match.end() : end])
        start = match.end() + outer.rfind(";") + 1
        condition = code[start:end]
        if _ASSIGNED.search(outer, outer.rfind(";") + 1) or condition.strip() in ("", "true", "false"):
            continue
        start += len(condition) - len(condition.lstrip())
        yield match.group(1) == "if", start, start + len(condition.strip()), end


def _negated(code, source):
    for _, start, end, _ in _conditions(code):
        if not _negated_elsewhere(spans.outermost(code[start:end])):
            yield _Edit("negated", start, start, end, f"!({source[start:end]})")
    for match in _NOT.finditer(code):
        yield _Edit("not-dropped", match.start(), match.start(), match.end(), "")


def _negated_elsewhere(condition):
    """!a, of which the negation is a, without its `!`; and a == b and a != b, of which each is the other's."""
    if _JOINED.search(condition):
        return False
    compared = [match.group().strip() for match in _COMPARED_ONCE.finditer(condition)]
    return compared in (["=="], ["!="]) or (not compared and condition.startswith("!"))


def _guards(code, source):
    """The condition of an early return dropped: it never returns, or always."""
    for is_if, start, end, parenthesis in _conditions(code):
        if is_if and _RETURN.match(code, parenthesis + 1):
            # What the condition names stays in use, and what it does is still done.
            yield _Edit("guard-never", start, start, end, f"({source[start:end]}) && false")
            yield _Edit("guard-always", start, start, end, f"({source[start:end]}) || true")


def _returned(code, _source):
    for match in _RETURNED.finditer(code):
        yield _Edit("returned", match.start(1), *match.span(1), "false" if match.group(1) == "true" else "true")


def _transitions(code, _source):
    for table in _TRANSITIONS.finditer(code):
        for match in _TRANSITION.finditer(code, table.end(), spans.closing(code, table.end() - 1)):
            yield _Edit("transition-dropped", match.start(), *match.span(), "")


_FINDERS = (
    _swapped("comparison", _COMPARISON, _COMPARED),
    _arithmetic,
    _logic,
    _numbers,
    _negated,
    _guards,
    _returned,
    _transitions,
)


def mutations(path, source):
    """Every mutation of a source, by place and kind."""
    code = mutable(source)
    starts = [0, *(match.end() for match in re.finditer("\n", source))]
    found = []
    for edit in (edit for finder in _FINDERS for edit in finder(code, source)):
        line = bisect.bisect_right(starts, edit.at)
        begin = starts[line - 1]
        text = source[begin:].split("\n", 1)[0].strip()
        found.append(Mutation(path, line, edit.at - begin + 1, edit.kind, text, edit.start, edit.end,
                              source[edit.start : edit.end], edit.after))
    return sorted(found, key=lambda mutation: (mutation.line, mutation.column, mutation.kind))


def lines_of_code(source):
    return sum(1 for line in cpp.blanked(source).split("\n") if line.strip())
