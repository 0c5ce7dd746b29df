"""Comments that begin with their subject, and lines of pages and protos that fit a screen."""

import pathlib
import re

import cpp

_LONGEST = 120
# Words that begin a comment without its subject, or with a relative clause in its place.
_NO_SUBJECT = re.compile(r"(?:What|Whatever|Who|Whoever|Whose|Where|Which|Of|Those|Such|So|Some|As|Behind|Whether|"
                         r"Nobody|Nothing)\b")
_COMMENT = re.compile(r"\s*//+\s?(.*)")
# Tests write these pages.
_WRITTEN_BY_TESTS = ("device/rml1/CLIPPING.md", "device/shrc203/COMMANDS.md", "device/shrc203/REFUSALS.md")


def check(file, _files):
    if file.generated or file.path in _WRITTEN_BY_TESTS:
        return
    suffix = pathlib.PurePosixPath(file.path).suffix
    if suffix == ".proto" or file.language == "C++":
        yield from _check_comments(file)
    if suffix in (".md", ".proto"):
        yield from _check_lengths(file)


def _check_comments(file):
    code = cpp.without_comments(file.content).split("\n")
    continues = False
    for number, (line, left) in enumerate(zip(file.lines, code), start=1):
        match = _COMMENT.match(line[len(left.rstrip()):]) if line != left else None
        if match and not continues and _NO_SUBJECT.match(match[1]):
            yield file.finding(number, "comment-subject", f'a comment begins with "{match[1].split()[0]}"',
                               "begin with what it explains, and use a verb")
        continues = bool(match) and not left.strip()


def _check_lengths(file):
    fence = False
    for number, line in enumerate(file.lines, start=1):
        if line.lstrip().startswith("```"):
            fence = not fence
        quoted = fence or line.startswith(("    ", "|")) and file.path.endswith(".md")
        if len(line) > _LONGEST and not quoted:
            yield file.finding(number, "long-line", f"{len(line)} columns", f"wrap it at {_LONGEST}")
