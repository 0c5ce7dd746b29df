"""What holds for every text file."""

import re

# Folders of somebody's own machine; what follows a word, as in a web address, is something else.
_MACHINE_PATH = re.compile(r"(?<![\w.-])/(?:work|root|home/\w+|Users/\w+)(?=/)")
_TRAILING = re.compile(r"\s+$")
# Jobs for machines, whose lines may end as they like.
_JOBS = "tests/fuzz/corpus/"


def check(file, _files):
    for number, line in enumerate(file.lines, start=1):
        if match := _MACHINE_PATH.search(line):
            yield file.finding(number, "machine-path", f"{match.group()}/ exists on one machine only",
                               "use a path inside the repository, or a parameter")
        if _TRAILING.search(line) and not file.path.startswith(_JOBS):
            yield file.finding(number, "trailing-whitespace", "blanks at the end of the line", "remove them")
