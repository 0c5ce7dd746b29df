"""The daemon with a simulated stage and mill, at an address that outlives a restart."""

import contextlib
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))

from programs import BIN, LIMIT_S, ROOT, Daemon  # noqa: E402

CONFIG = """
listen = "ADDRESS"
metrics = "127.0.0.1:0"
socket = "{socket}"

[network]
listen = "127.0.0.1:0"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"

[access]
local = "admin"

[[device]]
name = "stage"
connection = "simulated"

[[device]]
name = "mill"
kind = "rml1"
profile = "PROFILE"
connection = "simulated"
tools = ["T1"]
"""


def free_address(host):
    """A daemon that is started again must find its port free: clients know no other."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family) as probe:
        probe.bind((host, 0))
        port = probe.getsockname()[1]
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


class Gateway:
    """`end` ends it, and removes its folder."""

    def __init__(self, host="127.0.0.1"):
        self._folder = tempfile.TemporaryDirectory(prefix="axisgate-interop-")
        self.address = free_address(host)
        subprocess.run([BIN / "axisgate-certificates", self._folder.name, "lab", "gateway"], check=True, timeout=LIMIT_S)
        profile = ROOT / "deploy" / "mills" / "mdx-20.toml"
        self._config = CONFIG.replace("ADDRESS", self.address).replace("PROFILE", str(profile)).replace("FOLDER", self._folder.name)
        self.daemon = Daemon(self._folder.name, self._config)

    def tls_address(self):
        return re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]

    def new_token(self):
        return self.daemon.run("token", "create", "suite").stdout.strip()

    def restart(self):
        self.daemon.stop()
        self.daemon = Daemon(self._folder.name, self._config)

    def titles(self):
        """Those of the jobs that the mill's queue has."""
        shown = self.daemon.run("--json", "--device", "mill", "mill", "queue").stdout
        return [job.get("title", "") for job in json.loads(shown).get("jobs", [])]

    def end(self):
        self.daemon.stop()
        self._folder.cleanup()


@contextlib.contextmanager
def running(host="127.0.0.1"):
    gateway = Gateway(host)
    try:
        yield gateway
    finally:
        gateway.end()
