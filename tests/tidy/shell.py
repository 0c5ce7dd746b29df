"""What holds for shell scripts."""

import re

# Programs that may end before they have read everything.
_LEAVES_EARLY = re.compile(
    r"(?<!\|)\|(?!\|)&?\s*(?:\\\n\s*)?"
    r"(head\b|read\b|grep\s+(?:-\w*[qm]|--quiet|--silent|--max-count)"
    r"|sed\b[^|\n]*?[\s';{\d/]q[\s';}]|awk\b[^|\n]*\bexit\b)"
)


def check(file, _files):
    if not re.match(r"#!.*\b(ba)?sh\b", file.content) or "pipefail" not in file.content:
        return
    for match in _LEAVES_EARLY.finditer(file.content):
        yield file.finding(file.content.count("\n", 0, match.start(1)) + 1, "early-reader",
                           f"`{match[1].split()[0]}` may leave the pipe early: pipefail then fails by SIGPIPE, silently",
                           "read to the end, or read from a variable (<<<)")
