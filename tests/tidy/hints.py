"""What the daemon's hints name: calls of the API in backquotes, each of which axisctl has a command for.

Every client shows the hints, so they do not name commands of axisctl. The texts in OWN are not sent to callers.
"""

import re

import cpp

TABLE = "clients/axisctl/hints.cc"
JUDGED = ("device/", "server/")
# Messages of the log, of the daemon's start, and of programs that read recordings.
OWN = ("device/stage/recording/recording_parse.cc", "server/access/tokens.cc", "server/devices/device_events.cc")

_LITERAL = re.compile(r'"(?:\\.|[^"\\\n])*"')
_OPTION = re.compile(r"\badd --[a-z]")
_CALL = re.compile(r"`([A-Z][A-Za-z]+)`")
_RPC = re.compile(r"^ *rpc (\w+)\(", re.MULTILINE)


def _literals(file):
    """(line, text) of each literal."""
    code = cpp.without_comments(file.content)
    for match in _LITERAL.finditer(code):
        yield code.count("\n", 0, match.start()) + 1, match.group()


def check_all(files):
    rpcs = {name for file in files if file.path.endswith(".proto") for name in _RPC.findall(file.content)}
    table = next((file.content for file in files if file.path == TABLE), "")
    with_command = set(_CALL.findall(table))
    for name in sorted(with_command - rpcs):
        yield next(file for file in files if file.path == TABLE).finding(
            1, "hint-call", f"`{name}` is no call of the API", "correct the name")
    for file in files:
        if file.language != "C++" or not file.path.startswith(JUDGED):
            continue
        for line, text in _literals(file):
            if file.path not in OWN and ("axisctl" in text or _OPTION.search(text)):
                yield file.finding(line, "hint-call", "a text for callers is about axisctl", "name the call: `Stop`")
            for name in _CALL.findall(text):
                if name not in rpcs:
                    yield file.finding(line, "hint-call", f"`{name}` is no call of the API", "correct the name")
                elif name not in with_command:
                    yield file.finding(line, "hint-call", f"axisctl has no command for `{name}`", f"add it to {TABLE}")
