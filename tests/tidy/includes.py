"""Which file may include what, and where the outside world may be touched."""

import posixpath
import re

_INCLUDE = re.compile(r"^\s*#\s*include\s*([<\"])([^>\"]+)[>\"]")
_CLOCK = re.compile(
    r"\b\w*[cC]lock\s*::\s*now\b|\bclock_gettime\s*\(|\bgettimeofday\s*\("
    r"|\btime\s*\(\s*(?:nullptr|NULL|0)\s*\)"
)
# A constant duration, which in the server has one place.
_LIMIT = re.compile(r"\bconstexpr\s+(?:auto|Duration|std::chrono::\w+)\s+k\w+\s*[=({]\s*std::chrono::")
_LIMITS = "server/limits.h"
_CLOCK_FOLDERS = ("device/link/", "server/", "clients/", "tests/bench/", "tests/clock/")
_ASIO_FOLDERS = ("device/link/", "server/", "clients/")
_DAEMON = "server/axisgated.cc"  # its main(): joins the doors to the gateway
_SIMULATOR = "device/shrc203/simulator/"
_MILL_SIMULATOR = "device/rml1/simulator/"
# Of the gateway's side the simulated mill knows the figures of machines alone.
_MILL_DATA = ("device/rml1/machine/profile.h", "device/rml1/machine/profile_files.h",
              "device/rml1/machine/known_machine.h", "device/rml1/language/dialect.h")
_GATEWAY_PARSERS = ("device/shrc203/command/command_table.h", "device/shot/command/model.h", "device/shot/command/command.h")
# Lowest first. Folders on one floor are siblings and may not include each other. A floor below a floor is a room within
# a folder; the files directly in a folder lie on the floor given for it.
FLOORS = {
    "device/core": (0,), "device/config": (0,), "device/use": (1, 0), "device/stage": (1, 1), "device/jobs": (1, 1),
    "device/shot": (1, 2), "device/*": (1, 3), "device": (1, 4),
    "server/access": (2, 0), "server/events": (2, 0), "server/config": (2, 1), "server/journal": (2, 1), "server/connections": (2, 2),
    "server/spool": (2, 2),
    "server/metrics": (2, 3), "server/recording": (2, 4), "server/devices": (2, 5), "server/*": (2, 6),
    "server": (3,), "server/api": (4,), "server/proto": (5,), "server/rpc": (6, 0), "server/doors": (6, 1), "clients": (7,), "tests": (8,),
}
# The rooms of a controller, and of its family: the README of each folder says what they are for.
ROOMS = {
    "device/shot/": {"command": 1, "line": 2},
    "device/shrc203/": {"command": 1, "recording": 3, "planning": 3, "state": 4, "session": 5, "motion": 6, "transaction": 7},
}
_FACE = ("controller.h", "controller.cc", "kind.h", "kind.cc")
# Join controller and simulator for those who choose a kind by its name.
_KIND = "device/shrc203/kind.cc"
_MILL_KIND = ("device/rml1/kind.cc", "device/rml1/model.cc")
# What still points upward, by file: a list that only shrinks.
_EXCEPTIONS = {("server/config/network.cc", "server/connections/certificates.h")}
# Plain files of server/ that every room of it may include: explanations for people, the log, and all time limits.
_FOR_ALL_OF_SERVER = ("device/core/explain.h", "server/log.h", "server/limits.h")


def room_of(path):
    """The floor and the room in which a project file lies, or nothing for what is not of the project."""
    top, *rest = path.split("/")
    if top in ("clients", "tests"):
        return FLOORS[top], top
    if top not in ("device", "server"):
        return None
    room = f"{top}/{rest[0]}" if len(rest) > 1 else top
    return FLOORS.get(room, FLOORS[f"{top}/*"]), room


def controller_room_of(path):
    """The floor and the room within a folder with rooms, or nothing for what lies elsewhere and for the simulator."""
    controller = next((folder for folder in ROOMS if path.startswith(folder)), None)
    if not controller or path.startswith(_SIMULATOR):
        return None
    *folders, name = path[len(controller):].split("/")
    if not folders:
        return (8, controller) if name in _FACE else (0, controller + "types")
    return ROOMS[controller].get(folders[0], 9), controller + folders[0]


def may_include(source, target):
    if (source, target) in _EXCEPTIONS or target in _FOR_ALL_OF_SERVER and source.startswith("server/"):
        return True
    here, there = controller_room_of(source), controller_room_of(target)
    if here and there and source.split("/")[1] == target.split("/")[1]:
        return here == there or there[0] < here[0]
    here, there = room_of(source), room_of(target)
    if not here or not there or here == there or there[0] < here[0]:
        return True
    if source.startswith((_SIMULATOR + "program/", _MILL_SIMULATOR + "program/")) and there[1] == "device/link":
        return True
    return source == _DAEMON and there[1] == "server/doors"


def includes_of(file):
    """(line number, whether in quotes, what) of each include that is no comment."""
    for number, (line, code) in enumerate(zip(file.lines, file.code), start=1):
        match = _INCLUDE.match(line)
        if match and code.lstrip().startswith("#"):
            yield number, match[1] == '"', match[2]


def check(file, files):
    if file.language != "C++" or file.generated:
        return
    paths = {other.path for other in files}
    for number, in_quotes, target in includes_of(file):
        beside = posixpath.normpath(posixpath.join(posixpath.dirname(file.path), target))
        if in_quotes and target not in paths and beside in paths:
            yield file.finding(number, "rooted-include", f'"{target}" is written from its own folder',
                               f'write #include "{beside}"')
            target = beside
        yield from _check_target(file, number, posixpath.normpath(target))
        yield from _check_what_it_includes(file, number, posixpath.normpath(target), files)
    yield from _check_clock(file)
    yield from _check_limits(file)


def _reached_from(target, files):
    """The project files that an include of `target` brings along."""
    by_path = {file.path: file for file in files}
    reached, waiting = set(), [target]
    while waiting:
        path = waiting.pop()
        if path in by_path and path not in reached:
            reached.add(path)
            waiting += [posixpath.normpath(name) for _, in_quotes, name in includes_of(by_path[path]) if in_quotes]
    return reached - {target}


def _check_what_it_includes(file, number, target, files):
    if file.path.startswith(_MILL_SIMULATOR) and target in _MILL_DATA:
        for path in sorted(filter(_is_of_the_check, _reached_from(target, files))):
            yield file.finding(number, "simulator-apart", f"{target} brings {path} into the simulated mill",
                               "let it include what is no part of the check")


def _check_target(file, number, target):
    if not may_include(file.path, target):
        yield file.finding(number, "floors", f"{room_of(file.path)[1]} may not include {target}",
                           "move what both need to a lower floor, or have the caller hand it in")
    in_simulator = file.path.startswith(_SIMULATOR)
    apart = file.path.startswith("device/shrc203/") and not in_simulator and file.path != _KIND
    if apart and target.startswith(_SIMULATOR):
        yield file.finding(number, "simulator-apart", f"the gateway's side may not include {target}",
                           f"a device must not know that it may be simulated: wire it in {_KIND}")
    if in_simulator and target in _GATEWAY_PARSERS:
        yield file.finding(number, "simulator-apart", f"the simulator may not include {target}",
                           "parse with the simulator's own code, or a mistake would agree with itself")
    if file.path.startswith(_MILL_SIMULATOR) and _is_of_the_check(target):
        yield file.finding(number, "simulator-apart", f"the simulated mill may not include {target}",
                           "parse and move with the simulator's own code, or a mistake would agree with itself")
    if _is_of_the_check(file.path) and target.startswith(_MILL_SIMULATOR):
        yield file.finding(number, "simulator-apart", f"the check of jobs may not include {target}",
                           "a check must not know the simulated mill: compare them in tests/rml1")
    if _names_a_kind(file.path, target):
        yield file.finding(number, "kinds", f"{target} is of one kind of device",
                           f"use device/stage or device/jobs; only {_KINDS} names the kinds")
    if _is_grpc(target) and _must_not_know_grpc(file.path):
        yield file.finding(number, "no-grpc", f"<{target}> is gRPC",
                           "call it in server/rpc and pass a plain type")
    if _is_protobuf(target) and _must_not_know_protobuf(file.path):
        yield file.finding(number, "no-grpc", f"<{target}> is protobuf",
                           "convert in server/proto and pass a plain type")
    if re.match(r"boost/asio\b", target) and not file.path.startswith(_ASIO_FOLDERS):
        yield file.finding(number, "asio-in-link", f"<{target}> is Boost.Asio",
                           "put input and output behind device/link")


def _is_of_the_check(path):
    apart = path.startswith(_MILL_SIMULATOR) or path in _MILL_DATA or path in _MILL_KIND
    return path.startswith("device/rml1/") and not apart


# The one file that names the kinds of device.
_KINDS = "server/kinds.cc"


def _names_a_kind(path, target):
    of_a_kind = target.startswith("device/") and room_of(target)[0] == FLOORS["device/*"] and room_of(target)[1] != "device/link"
    return of_a_kind and path.startswith("server/") and path != _KINDS


def _is_grpc(target):
    return target.startswith("grpc") or target.endswith(".grpc.pb.h")


def _is_protobuf(target):
    return target.startswith("google/protobuf/") or target.endswith(".pb.h")


def _must_not_know_grpc(path):
    if path.startswith("device/"):
        return True
    return path.startswith("server/") and not path.startswith("server/rpc/")


def _must_not_know_protobuf(path):
    return _must_not_know_grpc(path) and not path.startswith("server/proto/")


def _check_clock(file):
    if file.path.startswith(_CLOCK_FOLDERS):
        return
    for number, code in enumerate(file.code, start=1):
        if match := _CLOCK.search(code):
            yield file.finding(number, "time-is-injected", f"{match.group()} reads a clock",
                               "take the time as a parameter, or where real time is meant, from device/link/clock.h")


def _check_limits(file):
    if not file.path.startswith("server/") or file.path == _LIMITS:
        return
    for number, code in enumerate(file.code, start=1):
        if match := _LIMIT.search(code):
            yield file.finding(number, "server-limit", f"{match.group()} is a duration", f"move it to {_LIMITS}")
