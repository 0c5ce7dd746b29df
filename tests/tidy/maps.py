"""Pages that name folders, files, floors, threads and alerts name the ones that exist, and all of them."""

import fnmatch
import pathlib
import posixpath
import re

import includes

_OVERVIEW = "docs/developing.md"
_THREADS = "server/README.md"
_ALERTS, _ALERT_RULES = "docs/container.md", "deploy/prometheus/alerts.yml"
_TOPS = ("proto/", "server/", "device/", "clients/", "deploy/", "tests/", "docs/")
# Folders whose subfolders their own README lists; those of the first three are in the overview, too.
_MAPPED = ("server", "device", "clients/axisctl", "tests")
_IN_THE_OVERVIEW = _MAPPED[:3]
# The glossary lists names that are no longer used.
_WITHOUT_PATHS = ("GLOSSARY.md",)
_CODE = re.compile(r"`([^`\s]+)`")
_FILE = re.compile(r"[a-z][\w/]*\.(?:\*|cc|h|py|proto)")
_LINK = re.compile(r"\]\(([^)#\s:]+)(?:#[^)]*)?\)")
_ALERT = re.compile(r"^\s*- alert: (\w+)$", flags=re.MULTILINE)
_ALERT_ROW = re.compile(r"^\| `(Axisgate\w+)` \|", flags=re.MULTILINE)
_THREAD = re.compile(r"\b(?:std::thread|thread_pool>) \w+(?:, \w+)*;")


def check_all(files):
    """Findings about the pages of a tree; `files` has all its files."""
    paths = {file.path for file in files}
    folders = {str(parent) for path in paths for parent in pathlib.PurePosixPath(path).parents}
    pages = {file.path: file for file in files if file.path.endswith(".md")}
    for page in pages.values():
        if page.path not in _WITHOUT_PATHS:
            yield from _check_names(page, paths, folders)
    if _OVERVIEW in pages:
        yield from _check_floors(pages[_OVERVIEW], folders)
    for parent in _MAPPED:
        for page in (pages.get(_OVERVIEW) if parent in _IN_THE_OVERVIEW else None, pages.get(f"{parent}/README.md")):
            if page:
                yield from _check_folders(page, parent, folders)
    if _THREADS in pages:
        yield from _check_threads(pages[_THREADS], files)
    rules = next((file for file in files if file.path == _ALERT_RULES), None)
    if rules and _ALERTS in pages:
        yield from _check_alerts(pages[_ALERTS], rules)


def _check_names(page, paths, folders):
    """Every link, every path that begins at the root, and every name of a source file leads to something."""
    here = posixpath.dirname(page.path)
    for number, line in enumerate(page.lines, start=1):
        targets = [posixpath.normpath(posixpath.join(here, link)) for link in _LINK.findall(line)]
        targets += [name.rstrip("/") for name in _CODE.findall(line) if name.startswith(_TOPS) and "…" not in name]
        for target in targets:
            if not _exists(target, paths, folders):
                yield page.finding(number, "map-path", f"{target} does not exist", "name the file or folder as it is")
        if line.startswith("| `") and page.path.endswith("README.md"):
            for name in filter(_FILE.fullmatch, _CODE.findall(line.split("|")[1])):
                below = (posixpath.join(here, name), posixpath.join(here, "*", name))
                if not any(fnmatch.filter(paths, pattern) for pattern in below):
                    yield page.finding(number, "map-path", f"{here}/ has no {name}", "list the files of the folder")
        for name in filter(_FILE.fullmatch, _CODE.findall(line)):
            if not name.startswith(_TOPS) and not fnmatch.filter(paths, name) and not fnmatch.filter(paths, f"*/{name}"):
                yield page.finding(number, "map-path", f"no file is called {name}", "name the file as it is")


def _exists(name, paths, folders):
    name = re.sub(r":\d.*$", "", name)
    if name in paths or name in folders:
        return True
    return any(mark in name for mark in "*{") and any(
        fnmatch.filter(paths | folders, each) for each in _alternatives(name))


def _alternatives(name):
    """The names that `a.{h,cc}` stands for."""
    match = re.search(r"\{([^}]*)\}", name)
    if not match:
        return [name]
    return [other for part in match[1].split(",")
            for other in _alternatives(name[:match.start()] + part.strip() + name[match.end():])]


def in_a_line(rooms):
    """The floors in a line, lowest first: rooms of one floor in braces. `rooms` has each room's floor."""
    by_floor = {}
    for room, floor in rooms.items():
        by_floor.setdefault(floor, []).append(room)
    return " < ".join(names[0] if len(names) == 1 else "{" + ", ".join(sorted(names)) + "}"
                      for _, names in sorted(by_floor.items()))


def _check_floors(page, folders):
    server = includes.FLOORS["server"]
    top, rooms = {}, {}
    for folder in sorted(folders):
        parent = posixpath.dirname(folder)
        if parent not in ("device", "server"):
            continue
        floor, _ = includes.room_of(f"{folder}/a.h")
        if parent == "server" and floor < server:
            rooms[posixpath.basename(folder)] = floor
        else:
            top[folder if parent == "server" else posixpath.basename(folder)] = floor
    top |= {"server": server, "clients": includes.FLOORS["clients"]}
    family, controller = ({"types": 0} | rooms for rooms in includes.ROOMS.values())
    words = " ".join(page.content.split())
    for line in map(in_a_line, (top, rooms, family, controller)):
        if line not in words:
            yield page.finding(1, "map-floors", f"the page does not say: {line}", "write the floors of includes.py")


def _check_folders(page, parent, folders):
    inside = sorted(folder for folder in folders if posixpath.dirname(folder) == parent)
    for folder in inside:
        name = posixpath.basename(folder)
        if not re.search(rf"(?<![\w-]){re.escape(name)}/", page.content):
            yield page.finding(1, "map-folders", f"the page does not name {folder}/", "say in a line what is in it")


def _check_threads(page, files):
    for file in files:
        if file.path.startswith(("server/", "device/")) and file.path.endswith(".h") and _THREAD.search(file.content):
            name = posixpath.splitext(file.path)[0].removeprefix("server/")
            if f"`{name}.*`" not in page.content:
                yield page.finding(1, "map-threads", f"the page does not name the thread of `{name}.*`",
                                   "add it to the list of threads")


def _check_alerts(page, rules):
    there, named = _ALERT.findall(rules.content), _ALERT_ROW.findall(page.content)
    if there != named:
        odd = sorted(set(there) ^ set(named)) or ["their order"]
        yield page.finding(1, "map-alerts", f"the table of alerts differs from {rules.path}: {', '.join(odd)}",
                           "list the alerts as the rules do")
