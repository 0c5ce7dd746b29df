"""Just enough C++ to tell code from comments, and one function body from another."""

import dataclasses
import re

_TOKEN = re.compile(
    r"""
    (?P<comment>//(?:\\\n|[^\n])*|/\*.*?(?:\*/|\Z))
  | (?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)")
  | (?P<separator>(?<=[0-9a-fA-F])'(?=[0-9a-fA-F]))
  | (?P<literal>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    """,
    re.VERBOSE | re.DOTALL,
)


_TYPE = re.compile(r"(?:(?:typedef|static|inline|constexpr|const|alignas\(\))\s*)*(?:class|struct|union|enum)\b")


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def blanked(source):
    """`source` with comments and the contents of literals as blanks, every byte at its place."""

    def replace(match):
        text = match.group()
        if match["comment"] or match["raw"]:
            return _blank(text)
        if match["separator"]:
            return text
        return text[0] + _blank(text[1:-1]) + text[-1]

    return _TOKEN.sub(replace, source)


def without_comments(source):
    """`source` with comments as blanks, literals as they are."""
    return _TOKEN.sub(lambda match: _blank(match.group()) if match["comment"] else match.group(), source)


def without_includes(source):
    """`source` without the paths that it includes."""
    return re.sub(r"^[ \t]*#[ \t]*include\b[^\n]*", lambda match: _blank(match.group()), source, flags=re.MULTILINE)


def without_directives(code):
    """Blanked code with its preprocessor lines, continued ones included, as blanks."""
    return re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", lambda match: _blank(match.group()), code, flags=re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Function:
    name: str
    line: int  # of its opening brace
    body_lines: int  # between the braces


class Unbalanced(Exception):
    """Braces or parentheses do not match; holds the line."""


class _Scanner:
    """Walks over code that is not in a function, and takes each function as one piece."""

    def __init__(self, code):
        self.code = code
        self.functions = []

    def line_at(self, position):
        return self.code.count("\n", 0, position) + 1

    def closing(self, opening):
        """Where the brace at `opening` is closed."""
        depth = 0
        for match in re.compile(r"[{}]").finditer(self.code, opening):
            depth += 1 if match.group() == "{" else -1
            if depth == 0:
                return match.start()
        raise Unbalanced(self.line_at(opening))

    def scan(self):
        head_start = position = depth = parentheses = 0
        while match := re.compile(r"[(){};]").search(self.code, position):
            position, byte = match.end(), match.group()
            if byte in "()":
                parentheses += 1 if byte == "(" else -1
            elif byte == "{":
                kind = "value" if parentheses else kind_of(self.code[head_start : match.start()])
                if kind == "scope":
                    depth += 1
                    head_start = position
                    continue
                end = self.closing(match.start())
                position = end + 1
                if kind == "function":
                    self.take(head_start, match.start(), end)
                    head_start = position
            elif byte == "}":
                depth -= 1
                head_start = position
                if depth < 0:
                    raise Unbalanced(self.line_at(match.start()))
            elif not parentheses:
                head_start = position
        if depth or parentheses:
            raise Unbalanced(self.line_at(len(self.code)))
        return self.functions

    def take(self, head_start, opening, end):
        head = self.code[head_start:opening]
        name = re.search(r"(operator\s*\S+?|[~\w:]+)\s*\(", _without_template(head))
        first, last = self.line_at(opening), self.line_at(end)
        self.functions.append(Function(name.group(1) if name else "a lambda", first, max(0, last - first - 1)))


def functions(code):
    """Every function of blanked code, those within classes included; a lambda belongs to the function around it."""
    return _Scanner(without_directives(code)).scan()


def _collapsed(head, opening, closing):
    """`head` with whatever stands between the outermost pairs left out."""
    out, depth = [], 0
    for byte in head:
        if byte == closing:
            depth -= 1
        if depth == 0:
            out.append(byte)
        if byte == opening:
            depth += 1
    return "".join(out)


def _without_template(head):
    """`head` without attributes, access labels and `template <...>` before a declaration."""
    head = re.sub(r"\[\[.*?\]\]|\b(?:public|protected|private)\s*:(?!:)", " ", head, flags=re.DOTALL).strip()
    while head.startswith("template"):
        depth = 0
        for match in re.finditer(r"[<>]", head):
            depth += 1 if match.group() == "<" else -1
            if depth == 0:
                head = head[match.end() :].strip()
                break
        else:
            return head
    return head


def kind_of(head):
    """What an opening brace after `head` begins, outside functions: a scope, a function or a value."""
    head = _collapsed(_collapsed(_without_template(head), "(", ")"), "{", "}")
    if re.search(r"\bnamespace\b|\bextern\s*\"\s*\"$", head):
        return "scope"
    if _TYPE.match(head) and not head.endswith(")"):
        return "scope"
    # A lambda that is the value of a variable: what follows `=` begins with its captures.
    if re.search(r"=\s*\[[^\]]*\]\s*(?:\(\))?[^={}]*$", head):
        return "function"
    if "()" not in head or ("=" in head and "operator" not in head):
        return "value"
    initializers = re.search(r"\(\)[^:]*(?<!:):(?!:)(.*)$", head, flags=re.DOTALL)
    if initializers and not initializers.group(1).rstrip().endswith((")", "}")):
        return "value"
    return "function"
