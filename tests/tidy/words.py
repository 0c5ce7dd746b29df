"""No retired word of GLOSSARY.md where people read: in pages, and in the messages, names and comments of C++.

Of tests, only the comments are judged. In a comment, text in backquotes or double quotes is data and is not judged.
"""

import pathlib
import re

import cpp

GLOSSARY = "GLOSSARY.md"
PAGES = (".md", ".proto", ".toml")
JUDGED_CODE = ("device/", "server/", "clients/")
JUDGED_COMMENTS = (*JUDGED_CODE, "tests/")

# What is retired, and what to say instead. A blank stands for blanks, line ends, `_` and `-`. The first that fits counts.
# Words with other, ordinary meanings are left to people: way, reading, behind, good, away, pay, narrower, stands, pace.
RETIRED = (
    (r"left[-_]?overs?|left overs?", "stale setpoint"),
    (r"tells another", "the value has changed"),
    (r"is told|hears", "receives"),
    (r"told|tells", "reported, reports"),
    (r"finds? (?:its|their|the) origins?", "homes"),
    (r"sets out", "starts"),
    (r"(?:stands?|stood|standing) still|at rest", "stationary"),
    (r"(?:comes?|came|coming) to rest", "stops, becomes stationary"),
    (r"seen to stand", "confirmed stationary"),
    (r"sets? going", "started"),
    (r"stirred", "saw motion"),
    (r"borne out", "confirmed"),
    (r"stands is not known", "position unknown"),
    (r"is has not been read yet", "resolution unknown"),
    (r"is another way", "the resolution has changed"),
    (r"stands where nobody knows", "means unknown"),
    (r"play of (?:the|its) screws?", "backlash"),
    (r"last way", "the approach"),
    (r"reckon(?:s|ed|ing)?", "computed"),
    (r"held against", "checked against"),
    (r"pays? speeds?", "restore"),
    (r"ow(?:e|es|ed|ing)", "pending restore; of an answer: outstanding"),
    (r"keeps? an eye", "watches"),
    (r"news", "change, event"),
    (r"(?:give|gives|gave|given|giving) up", "disconnect, abandon"),
    (r"excursions?", "visit to a non-host mode"),
    (r"runaways?", "orphaned jog"),
    (r"strange (?:motions?|lines?|units?)", "foreign motion, unexpected line, another controller"),
    (r"moves all the same", "moving despite NG"),
    (r"axis numbers? came", "a completion was received"),
    (r"errands?", "blocking task"),
    (r"deeds?", "operation"),
    (r"entrances?", "endpoint"),
    (r"feeding", "refill feasibility"),
    (r"forecasts?", "transaction prediction"),
    (r"may_use", "authorize"),
    (r"jog_?keeping", "JogContext"),
    (r"hear_echo", "on_last_command"),
    (r"still_the_same", "confirm_no_restart"),
    (r"in sight", "connected without interruption"),
    (r"nobody known|nameless", "anonymous"),
    (r"whoever|he|his|him", "the caller, they, their"),
    (r"anew", "again"),
    (r"mend(?:s|ed|ing)?|puts? right", "fix, correct"),
    (r"goes on", "continues"),
    (r"(?:is|are) on the wire", "is in flight"),
    (r"swallow(?:s|ed|ing)?", "discarded"),
    (r"asked for", "requested"),
    (r"bites?", "detects"),
    (r"home_first", "require_homing"),
)
_SAY = tuple(say for _, say in RETIRED)
_ANY = re.compile(
    "(?<![a-z])(?:" + "|".join(f"({words.replace(' ', '[ _-]+')})" for words, _ in RETIRED) + ")(?![a-z])",
    re.IGNORECASE,
)


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def _prose(file):
    """A page in which what is no prose is blank: fences, indented code blocks and names in backquotes."""
    lines, fence, code = [], None, True
    for line in file.lines:
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and (fence is None or line.strip() == fence):
            fence = None if fence else mark[1]
            line = ""
        elif fence:
            line = ""
        elif re.match(r" {4,}\S", line) and code:
            line = ""
        else:
            code = not line.strip()
        lines.append(line)
    return re.sub(r"`[^`]*`", lambda match: _blank(match.group()), "\n".join(lines))


def _code(source):
    """The code of a C++ file, with its literals, without comments and the paths of includes."""
    code = cpp.without_includes(cpp.without_comments(source))
    return re.sub(r'"\s*\n\s*"', lambda match: match.group().replace('"', " "), code)  # one text in several literals


def _comments(source):
    """The comments of a C++ file without what they quote. Code between two of them is NULs: no words across it."""
    code = cpp.without_comments(source)
    text = "".join(was if was != left or was.isspace() else "\0" for was, left in zip(source, code))
    text = re.sub(r"[/*]", " ", text)
    # A quotation may continue on the next line, but not in another comment.
    return re.sub(r"([`\"])(?:(?!\1)[^\0\n]|\n(?![ \t]*\n))*\1", lambda match: _blank(match.group()), text)


def _texts(file):
    """What is judged of a file, in pieces that have each line at its place; nothing of most files."""
    suffix = pathlib.PurePosixPath(file.path).suffix
    if file.generated or file.path == GLOSSARY:
        return
    if suffix == ".md":
        yield _prose(file)
    elif suffix in PAGES:
        yield re.sub(r"(?m)^[ \t]*(?://|#)", " ", file.content)
    elif file.language == "C++":
        if file.path.startswith(JUDGED_CODE):
            yield _code(file.content)
        if file.path.startswith(JUDGED_COMMENTS):
            yield _comments(file.content)


def found(file):
    """(line, what is said, what to say instead) of each retired word."""
    for text in _texts(file):
        # A line end is a blank, so that words on two lines are found; places stay.
        for match in _ANY.finditer(re.sub(r"\s", " ", text)):
            yield text.count("\n", 0, match.start()) + 1, " ".join(match.group().split()), _SAY[match.lastindex - 1]


def check(file, _files):
    for line, word, say in found(file):
        yield file.finding(line, "retired-word", f'"{word}" is retired', f'say "{say}" (GLOSSARY.md)')
