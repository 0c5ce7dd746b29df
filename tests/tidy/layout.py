"""C++ looks as .clang-format says."""

import re
import shutil
import subprocess

from tree import CannotLook, Finding

FORMATTER = "clang-format-14"


def check(root, files):
    sources = [file.path for file in files if file.path.endswith((".h", ".cc")) and not file.generated]
    if not sources:
        return []
    if not shutil.which(FORMATTER):
        raise CannotLook(f"{FORMATTER} is not installed (Debian package {FORMATTER})")
    if not (root / ".clang-format").is_file():
        return [Finding(".clang-format", 1, "clang-format", "the file is missing", "restore it")]
    command = [FORMATTER, "--dry-run", "-Werror", "--style=file", *sources]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    findings = {}
    for path, line in re.findall(r"^(.+?):(\d+):\d+: error: ", run.stderr, flags=re.MULTILINE):
        findings.setdefault(path, Finding(path, int(line), "clang-format", "differs from .clang-format",
                                          f"run {FORMATTER} -i {path}"))
    if run.returncode != 0 and not findings:
        raise CannotLook(f"{FORMATTER} failed: {run.stderr.strip()}")
    return list(findings.values())
