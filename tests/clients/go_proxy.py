#!/usr/bin/python3
"""Makes a Go module proxy in a folder: the files that `go get` asks a server for.

usage: go_proxy.py MODULE_FOLDER PROXY_FOLDER VERSION
"""

import json
import pathlib
import re
import subprocess
import sys
import zipfile


def main(module_folder, proxy_folder, version):
    module = pathlib.Path(module_folder)
    name = re.search(r"(?m)^module (\S+)", (module / "go.mod").read_text())[1]
    versions = pathlib.Path(proxy_folder, name, "@v")
    versions.mkdir(parents=True)
    (versions / "list").write_text(f"{version}\n")
    (versions / f"{version}.info").write_text(json.dumps({"Version": version, "Time": "2026-01-01T00:00:00Z"}))
    (versions / f"{version}.mod").write_bytes((module / "go.mod").read_bytes())
    listed = subprocess.run(["git", "ls-files"], cwd=module, check=True, capture_output=True, text=True).stdout
    with zipfile.ZipFile(versions / f"{version}.zip", "w") as archive:
        for path in listed.splitlines():
            archive.write(module / path, f"{name}@{version}/{path}")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
