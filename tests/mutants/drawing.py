"""The sources that are mutated, and which of their mutations are drawn."""

import io
import itertools
import random
import subprocess
import tarfile

import sites

FOLDERS = ("device/core", "device/use", "device/jobs", "device/shot", "device/shrc203", "device/rml1", "server/access")
# The simulator is no product, and the switch of the guards is there for tests.
_LEFT_OUT = ("device/shrc203/simulator/", "device/core/guard.h", "device/jobs/guard.h")


class CannotRun(Exception):
    """Nothing could be drawn or tried; says why."""


def git(folder, *arguments):
    """What git prints. The owner of a mounted checkout may be somebody else."""
    command = ["git", "-c", "safe.directory=*", "-C", str(folder), *arguments]
    try:
        return subprocess.run(command, capture_output=True, check=True).stdout
    except FileNotFoundError as error:
        raise CannotRun("git is not installed") from error
    except subprocess.CalledProcessError as error:
        raise CannotRun(error.stderr.decode(errors="replace").strip()) from error


def is_mutated(path):
    return path.endswith((".h", ".cc")) and path.startswith(tuple(f"{folder}/" for folder in FOLDERS)) \
        and not path.startswith(_LEFT_OUT)


def head(root):
    return git(root, "rev-parse", "HEAD").decode().strip()


def sources_at(root, commit):
    """The content of every source that is mutated, by path."""
    archive = tarfile.open(fileobj=io.BytesIO(git(root, "archive", "--format=tar", commit, "--", *FOLDERS)))
    return {
        member.name: archive.extractfile(member).read().decode()
        for member in sorted(archive.getmembers(), key=lambda member: member.name)
        if member.isfile() and is_mutated(member.name)
    }


def _taken(generator, choices, weights):
    """One of the choices, each as probable as its weight; the same for a seed with every Python."""
    ends = list(itertools.accumulate(weights))
    drawn = generator.random() * ends[-1]
    return next(choice for choice, end in zip(choices, ends) if drawn < end)


def drawn(sources, seed):
    """All mutations one after the other: a file by its lines of code, then a kind, then one of that kind in it."""
    generator = random.Random(seed)
    left = {}
    for path, source in sources.items():
        kinds = {}
        for mutation in sites.mutations(path, source):
            kinds.setdefault(mutation.kind, []).append(mutation)
        if kinds:
            left[path] = kinds
    lines = {path: sites.lines_of_code(sources[path]) for path in left}
    while left:
        path = _taken(generator, list(left), [lines[path] for path in left])
        kinds = left[path]
        kind = _taken(generator, sorted(kinds), [1] * len(kinds))
        yield kinds[kind].pop(int(generator.random() * len(kinds[kind])))
        if not kinds[kind]:
            del kinds[kind]
        if not kinds:
            del left[path]


def of_kind(sources, kind):
    """All mutations of that kind."""
    found = [mutation for path, source in sources.items() for mutation in sites.mutations(path, source)
             if mutation.kind == kind]
    if not found:
        raise CannotRun(f"{kind}: no mutation is of that kind")
    return found


def named(sources, wanted):
    """The mutation with that id."""
    path = wanted.split(":", 1)[0]
    if path not in sources:
        raise CannotRun(f"{path} is not among the sources that are mutated")
    for mutation in sites.mutations(path, sources[path]):
        if mutation.id == wanted:
            return mutation
    raise CannotRun(f"{wanted}: no such mutation; the source may have changed")
