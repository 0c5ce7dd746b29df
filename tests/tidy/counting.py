"""How tangled the code is, in figures: each function here takes the files of a tree and answers with Figures."""

import collections
import dataclasses
import functools
import posixpath
import re

import cpp

# What a motion's record has been called; what is written down about a motion is looked for from there.
MOTION_RECORDS = ("LiveMotion", "MotionRecord")

_TYPE_HEAD = re.compile(
    r"\b(?:class|struct|union)\s+(?:\[\[[^\]]*\]\]\s*)?(?P<name>[A-Za-z_]\w*(?:::\w+)*)\s*(?:<[^;{}()]*>\s*)?"
    r"(?:final\s*)?(?::(?!:)(?P<bases>[^;{}]*))?\{"
)
_ENUM = re.compile(r"\benum\b(?:\s+(?:class|struct))?\s+(?P<name>\w+)[^;{}()]*\{(?P<values>[^{}]*)\}")
_ALIAS = re.compile(r"\busing\s+(\w+)\s*=\s*([^;]+);")
_LABEL = re.compile(r"\b(?:public|protected|private)\s*:(?!:)")
_NO_MEMBER = re.compile(r"(?:using|friend|typedef|static_assert)\b")
_FORWARD = re.compile(r"(?:enum\s+)?(?:class|struct|union|enum)\s+[\w:]+\s*(?::[\w:\s]+)?")
_DECORATION = re.compile(r"\[\[.*?\]\]|\b(?:alignas|decltype)\s*\([^()]*\)", re.DOTALL)
_FUNCTION_POINTER = re.compile(r"\(\s*\*\s*(\w+)\s*\)\s*\([^()]*\)")
_HOLDERS = ("optional", "vector", "deque", "list", "array", "set", "map", "pair", "variant", "shared_ptr", "unique_ptr",
            "atomic")
_FLAGS = ("bool", "optional<TimePoint>", "optional<Problem>")

_SIMULATOR = "device/shrc203/simulator/"
_COMMAND_ROOM = re.compile(r"device/(?:shrc203|shot)/(?:command/|(?:rows\w*|command_table\w*|codec)\.(?:h|cc)$)")
_COMMAND_NAME = re.compile(r"(?:[?!*]?[A-Z]{1,5}:|\?:[A-Z]|!:|\*IDN\?)\S*")
_TAKES_COMMAND_NAME = re.compile(r"\bmodel\(\)\.(?:make|row)\s*\(\s*$")
_LINK_WRITE = re.compile(
    r"\b(?:state_|state)\s*(?:\.|->)\s*link\s*=(?!=)|\b(?:state_|link_)\s*=(?!=)[^;]*\bLinkState\b"
)
_EMPTY_ROW = re.compile(r"\{\},\s*\{\},\s*\{\}\s*\}")
_DURATION = re.compile(r"\bconstexpr\s+Duration\s+(\w+\s*[={][^;]*);")


@dataclasses.dataclass(frozen=True)
class Figure:
    name: str
    value: int | None  # nothing where what it measures was not found
    detail: str

    def __str__(self):
        return f"{self.name}: {'not found' if self.value is None else self.value} ({self.detail})"


@dataclasses.dataclass(frozen=True)
class Member:
    name: str
    type: str  # as it is written


@dataclasses.dataclass(frozen=True)
class Class:
    name: str  # with the classes around it, without namespaces
    path: str
    bases: tuple
    functions: int  # declared in its body
    members: tuple  # its data, without what is static


# The declarations of a class.


def _masked(text, opening, closing):
    """`text` with blanks between its outermost pairs, every byte at its place."""
    out, depth = [], 0
    for byte in text:
        if byte == closing and depth:
            depth -= 1
        out.append(" " if depth else byte)
        if byte == opening:
            depth += 1
    return "".join(out)


def _bare(text):
    """`text` with blanks in all its brackets."""
    for opening, closing in ("{}", "()", "[]"):
        text = _masked(text, opening, closing)
    return _masked(text, "<", ">")


def _closing(code, opening):
    """Where the brace at `opening` is closed; the end of the code where it never is."""
    depth = 0
    for match in re.compile(r"[{}]").finditer(code, opening):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.start()
    return len(code)


def _declarations(code, start, end):
    """The text of each declaration of a class body, without the bodies of its functions and nested types."""
    head_start, position, parentheses, nested = start, start, 0, ""
    while match := re.compile(r"[(){};]").search(code, position, end):
        position, byte = match.end(), match.group()
        head = code[head_start : match.start()]
        if byte in "()":
            parentheses += 1 if byte == "(" else -1
        elif parentheses or byte == "}":
            continue
        elif byte == ";":
            # After a nested type only the names of its values are left.
            yield nested + head if head.strip() else ""
            head_start, nested = position, ""
        else:
            kind = cpp.kind_of(head)
            position = _closing(code, match.start()) + 1
            if kind == "function":
                yield head
            if kind != "value":
                head_start, nested = position, "Nested " if kind == "scope" else ""


def _declared(text):
    """What a declaration is without its labels, attributes and template head."""
    text = _FUNCTION_POINTER.sub(r" \1", _DECORATION.sub(" ", _LABEL.sub(" ", text))).strip()
    while re.match(r"template\s*<", text):
        text = text[_masked(text, "<", ">").index(">") + 1 :].strip()
    return text


def _is_function(text):
    return bool(re.search(r"\boperator\b", text)) or "(" in _bare(text).split("=")[0]


def _members_of(text):
    """The data members that a declaration without parentheses declares, with the type they share."""
    if re.match(r"(?:inline\s+|constexpr\s+)*static\b", text):
        return
    shared, begin = None, 0
    for piece in _bare(text).split(","):
        names = list(re.finditer(r"[A-Za-z_]\w*", re.split(r"[={\[]|(?<!:):(?!:)", piece)[0]))
        if names and (shared is not None or len(names) > 1):
            shared = text[: names[-1].start()].strip() if shared is None else shared
            yield Member(names[-1].group(), shared)
        begin += len(piece) + 1


def _class_of(file, code, name, match):
    functions, members = 0, []
    for declaration in _declarations(code, match.end(), _closing(code, match.end() - 1)):
        text = _declared(declaration)
        if not text or _NO_MEMBER.match(text) or _FORWARD.fullmatch(text):
            continue
        if _is_function(text):
            functions += 1
        else:
            members += _members_of(text)
    bases = re.sub(r"\b(?:public|protected|private|virtual)\b", "", match["bases"] or "")
    bases = [piece.split("<")[0].strip() for piece in _bare(bases).split(",") if piece.strip()]
    return Class(name, file.path, tuple(bases), functions, tuple(members))


def _code(file):
    return cpp.without_directives("\n".join(file.code))


def _spans(code):
    """(start, end, name, head) of each class, in order."""
    around = []
    for match in _TYPE_HEAD.finditer(code):
        if re.search(r"\benum\s*$", code[: match.start()]):
            continue
        name = f"{_scope_at(around, match.start())}{match['name']}"
        around.append((match.end(), _closing(code, match.end() - 1), name, match))
    return around


def _scope_at(spans, position):
    """What stands before the name of something declared there: the classes around it."""
    names = [name for start, end, name, _ in spans if start <= position < end]
    return f"{names[-1]}::" if names else ""


@functools.cache
def classes_of(file):
    """Every class that a C++ file defines, with those within it."""
    code = _code(file)
    return tuple(_class_of(file, code, name, match) for _, _, name, match in _spans(code))


def _cpp(files, *folders):
    """The C++ files in these folders that people write, those of the simulator among them."""
    return [file for file in files
            if file.language == "C++" and not file.generated and file.path.startswith(folders)]


def _gateway_side(files, *folders):
    return [file for file in _cpp(files, *folders) if not file.path.startswith(_SIMULATOR)]


def _classes(files):
    return [found for file in files for found in classes_of(file)]


# What a motion's record holds.


def _pieces(text):
    """The arguments of a template."""
    start = 0
    for piece in _bare(text).split(","):
        yield text[start : start + len(piece)]
        start += len(piece) + 1


def _leaves(text):
    """The names of the types whose values a value of type `text` holds."""
    text = re.sub(r"\b(?:const|mutable|volatile|typename|struct|class)\b", " ", text).strip()
    match = re.fullmatch(r"(?:::)?([\w:]+)\s*(?:<(.*)>)?", text, flags=re.DOTALL)
    if not match:
        return  # a reference or a pointer
    name = re.sub(r"^(?:[a-z]\w*::)+", "", match[1])
    if name not in _HOLDERS or not match[2]:
        yield name
        return
    for piece in _pieces(match[2]):
        for leaf in _leaves(piece):
            yield leaf
            if name == "optional":
                yield f"optional<{leaf}>"


class _Types:
    """The types of some files by name, as they are seen from within a class."""

    def __init__(self, files):
        self.named = {}  # a Class, the text that an alias stands for, or the number of an enum's values
        # Where names meet, that of a header of the controller is meant.
        for file in sorted(files, key=lambda one: (one.path.endswith(".h"), one.path.startswith("device/shrc203/"))):
            code = _code(file)
            spans = _spans(code)
            for match in _ALIAS.finditer(code):
                self.named[_scope_at(spans, match.start()) + match[1]] = match[2]
            for match in _ENUM.finditer(code):
                values = [value for value in match["values"].split(",") if value.strip()]
                self.named[_scope_at(spans, match.start()) + match["name"]] = len(values)
            self.named.update({found.name: found for found in classes_of(file)})

    def find(self, scope, name):
        while scope:
            if f"{scope}::{name}" in self.named:
                return self.named[f"{scope}::{name}"]
            scope = scope.rpartition("::")[0]
        return self.named.get(name)

    def held(self, scope, text, depth=0):
        """(name, what is known of it) of each type whose values a value of type `text` holds."""
        for leaf in _leaves(text):
            known = self.find(scope, leaf)
            yield leaf, known
            if isinstance(known, str) and depth < 8:
                yield from self.held(scope, known, depth + 1)


def motion_flags(files):
    types = _Types(_gateway_side(files, "device/"))
    left = [found for name in MOTION_RECORDS if isinstance(found := types.named.get(name), Class)]
    if not left:
        return [Figure("motion_flags", None, f"no class is called {' or '.join(MOTION_RECORDS)}")]
    flags, seen = [], set()
    while left:
        record = left.pop(0)
        if record in seen:
            continue
        seen.add(record)
        of_bases = [known for base in record.bases for _, known in types.held(record.name, base)]
        left += [known for known in of_bases if isinstance(known, Class)]
        for member in record.members:
            held = list(types.held(record.name, member.type))
            if any(name in _FLAGS or known == 2 for name, known in held):
                flags.append(f"{record.name}.{member.name}")
            left += [known for _, known in held if isinstance(known, Class)]
    return [Figure("motion_flags", len(flags), ", ".join(flags))]


# The other figures.


def largest_classes(files):
    classes = _classes(_cpp(files, "device/", "server/"))
    if not classes:
        return [Figure(name, None, "no class") for name in ("most_functions", "most_data_members")]

    def own_data(found):
        return sum(member.name.endswith("_") for member in found.members)

    most, widest = max(classes, key=lambda found: found.functions), max(classes, key=own_data)
    return [Figure("most_functions", most.functions, f"{most.name} in {most.path}, {own_data(most)} data members"),
            Figure("most_data_members", own_data(widest), f"{widest.name} in {widest.path}")]


def fullest_folder(files):
    entries = collections.defaultdict(set)
    for file in files:
        path = file.path
        while path.startswith(("device/", "server/", "clients/")):
            entries[posixpath.dirname(path)].add(path)
            path = posixpath.dirname(path)
    if not entries:
        return [Figure("fullest_folder", None, "no folder")]
    folder = max(sorted(entries), key=lambda name: len(entries[name]))
    return [Figure("fullest_folder", len(entries[folder]), f"{folder}/")]


def server_files(files):
    server = [file for file in files if file.path.startswith("server/")]
    naming = [file for file in server if "shrc203" in file.content]
    return [Figure("server_files_naming_shrc203", len(naming), f"of {len(server)} files"),
            Figure("server_files", len(server), "all text files below server/")]


def _literals(file):
    """(the blanked code before it, the text between its quotes) of each literal that is no raw one."""
    code = _code(file)
    for match in re.finditer(r'"[^"]*"', code):
        yield code[: match.start()], file.content[match.start() + 1 : match.end() - 1]


def command_literals(files):
    by_file = collections.Counter()
    for file in _gateway_side(files, "device/shrc203/", "device/shot/", "server/"):
        if _COMMAND_ROOM.match(file.path):
            continue
        for before, text in _literals(file):
            if _COMMAND_NAME.fullmatch(text) or _TAKES_COMMAND_NAME.search(before):
                by_file[file.path] += 1
    in_server = sum(number for path, number in by_file.items() if path.startswith("server/"))
    most = ", ".join(f"{path} {number}" for path, number in by_file.most_common(3))
    return [Figure("command_literals", by_file.total(), f"{in_server} of them in server/"),
            Figure("command_literal_files", len(by_file), f"most in {most}" if most else "none")]


def largest_context(files):
    side = _gateway_side(files, "device/shrc203/", "device/shot/")
    contexts = [found for found in _classes(side) if found.name.endswith(("Context", "Impl"))]
    if not contexts:
        return [Figure(name, None, "no class is called ...Context or ...Impl")
                for name in ("largest_context_members", "largest_context_files")]
    largest = max(contexts, key=lambda found: len(found.members))
    use = rf"\b{largest.name}\b"
    if largest.name.endswith("Impl"):
        use = rf"\b{largest.name}::|\bimpl_\."
    users = [file for file in side if file.path.endswith(".cc") and re.search(use, _code(file))]
    return [Figure("largest_context_members", len(largest.members), f"{largest.name} in {largest.path}"),
            Figure("largest_context_files", len(users), f"of .cc in device/shot and device/shrc203 that use {largest.name}")]


def _counted(found):
    return ", ".join(f"{path} {number}" for path, number in found.items()) or "none"


def link_state_writes(files):
    found = collections.Counter()
    for file in _gateway_side(files, "device/shrc203/", "device/shot/"):
        if number := len(_LINK_WRITE.findall(_code(file))):
            found[file.path] = number
    return [Figure("link_state_writes", found.total(), _counted(found))]


def empty_problem_rows(files):
    found = collections.Counter()
    for file in _cpp(files, "device/", "server/"):
        if number := len(_EMPTY_ROW.findall(_code(file))):
            found[file.path] = number
    return [Figure("empty_problem_rows", found.total(), _counted(found))]


def duration_constants(files):
    found = collections.Counter()
    for file in _gateway_side(files, "device/shrc203/", "device/shot/"):
        for match in _DURATION.finditer(_code(file)):
            found[file.path] += len(_bare(match[1]).split(","))
    return [Figure("duration_constants", found.total(), "constexpr Duration in device/shot and device/shrc203, one a name"),
            Figure("duration_constant_files", len(found), "files that define one")]


FIGURES = (largest_classes, fullest_folder, server_files, command_literals, motion_flags, largest_context,
           link_state_writes, empty_problem_rows, duration_constants)
