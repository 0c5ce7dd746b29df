"""The files of a source tree, and what is found in them."""

import dataclasses
import functools
import pathlib
import subprocess

import cpp

LANGUAGES = {".h": "C++", ".cc": "C++", ".cpp": "C++", ".hpp": "C++", ".py": "Python", ".sh": "shell"}
GENERATED = (".pb.h", ".pb.cc", "_pb2.py", "_pb2.pyi", "_pb2_grpc.py")


class CannotLook(Exception):
    """The tree could not be checked at all."""


@dataclasses.dataclass(frozen=True, order=True)
class Finding:
    path: str
    line: int
    rule: str
    what: str
    mend: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.rule}: {self.what}; {self.mend}"


class File:
    """One text file; `path` is relative to the root, with slashes."""

    def __init__(self, path, content):
        self.path = path
        self.content = content
        self.lines = content.split("\n")
        if self.lines[-1] == "":
            self.lines.pop()

    @property
    def language(self):
        known = LANGUAGES.get(pathlib.PurePosixPath(self.path).suffix)
        if known or not self.lines or not self.lines[0].startswith("#!"):
            return known
        if "python" in self.lines[0]:
            return "Python"
        return "shell" if self.lines[0].rstrip().endswith("sh") else None

    @property
    def generated(self):
        return self.path.endswith(GENERATED)

    @functools.cached_property
    def code(self):
        """The lines of a C++ file, comments and the contents of literals blanked."""
        return cpp.blanked(self.content).split("\n")

    def finding(self, line, rule, what, mend):
        return Finding(self.path, line, rule, what, mend)


def files_under(root):
    """The text files of the tree by path: what git tracks or would, and without git, everything."""
    if not root.is_dir():
        raise CannotLook(f"{root} is no folder")
    paths = _listed_by_git(root) if (root / ".git").exists() else _walked(root)
    files = []
    for path in sorted(paths):
        if not (root / path).is_file() or (root / path).is_symlink():
            continue
        content = (root / path).read_bytes()
        if b"\0" not in content:
            files.append(File(path, content.decode("utf-8", errors="replace")))
    if not files:
        raise CannotLook(f"{root} holds no text file")
    return files


def _listed_by_git(root):
    # The owner of a mounted checkout may be somebody else: reading its list of files is harmless.
    command = ["git", "-c", "safe.directory=*", "-C", str(root), "ls-files", "-z", "--cached", "--others"]
    try:
        listed = subprocess.run([*command, "--exclude-standard"], capture_output=True, check=True)
    except FileNotFoundError as error:
        raise CannotLook("git is not installed, and this is a git checkout") from error
    except subprocess.CalledProcessError as error:
        raise CannotLook(error.stderr.decode(errors="replace").strip()) from error
    return {path for path in listed.stdout.decode(errors="replace").split("\0") if path}


def _walked(root):
    build_trees = {cache.parent for cache in root.rglob("CMakeCache.txt")}
    return {
        path.relative_to(root).as_posix()
        for path in root.rglob("*")
        if "__pycache__" not in path.parts and build_trees.isdisjoint(path.parents)
    }
