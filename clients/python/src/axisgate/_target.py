"""The daemon's address and the caller's credentials: arguments first, then the environment, then the local daemon."""

from __future__ import annotations

import os
import re
import uuid
from dataclasses import dataclass, field
from typing import Mapping, Optional, Tuple

import grpc

_SYSTEM_SOCKET = "/run/axisgate/axisgate.sock"
_PORT = 50203
_TLS_PORT = 50204
_SCHEMES = ("unix:", "unix-abstract:", "dns:", "ipv4:", "ipv6:")
_LOOPBACK = re.compile(r"(?:ipv[46]:|dns:/*)?(?:localhost|127\.[0-9.]+|\[::1\]|::1)(?::\d+)?")

SESSION = str(uuid.uuid4())
"""Session of this process: the daemon treats all of its connections as one program."""

OPTIONS: Tuple[Tuple[str, object], ...] = (
    ("grpc.enable_retries", 0),
    ("grpc.service_config_disable_resolution", 1),
    ("grpc.use_local_subchannel_pool", 1),
    # A proxy would carry a token that is meant for this machine over the network.
    ("grpc.enable_http_proxy", 0),
    ("grpc.initial_reconnect_backoff_ms", 250),
    ("grpc.max_reconnect_backoff_ms", 1000),
    # Despite its name, this option is the time limit of one connection attempt.
    ("grpc.min_reconnect_backoff_ms", 5000),
    # The connection for stops stays open, however long it is not used.
    ("grpc.client_idle_timeout_ms", 2**31 - 1),
    ("grpc.keepalive_time_ms", 20_000),
    ("grpc.keepalive_timeout_ms", 10_000),
    ("grpc.http2.max_pings_without_data", 0),
    ("grpc.keepalive_permit_without_calls", 1),
)
"""Options of every channel. Nothing that moves is repeated by gRPC itself."""


@dataclass(frozen=True)
class Target:
    """A Target is the daemon's address in gRPC's form, with what identifies the caller."""

    address: str
    session: str
    token: str = field(default="", repr=False)
    tls: bool = False
    ca: str = ""
    certificate: str = ""
    key: str = ""

    @property
    def metadata(self) -> Tuple[Tuple[str, str], ...]:
        """Metadata of every call."""
        session = (("axisgate-session", self.session),)
        return session + ((("authorization", f"Bearer {self.token}"),) if self.token else ())

    @property
    def is_local(self) -> bool:
        """True if the daemon runs on this machine."""
        return self.address.startswith(("unix:", "unix-abstract:")) or _LOOPBACK.fullmatch(self.address) is not None

    def credentials(self) -> Optional[grpc.ChannelCredentials]:
        """Returns the TLS credentials, or None for a plaintext connection. Raises OSError if a file is unreadable."""
        if not self.tls:
            return None
        return grpc.ssl_channel_credentials(_content(self.ca), _content(self.key), _content(self.certificate))


def _content(path: str) -> Optional[bytes]:
    if not path:
        return None
    with open(path, "rb") as file:
        return file.read()


def resolve(target: Optional[str], token: Optional[str], ca: Optional[str], certificate: Optional[str],
            key: Optional[str], environment: Mapping[str, str] = os.environ) -> Target:
    """Returns the target that the arguments name. An argument that is None comes from the environment.

    Raises ValueError if certificate and key do not come together, or a token would be sent unencrypted to another
    machine.
    """
    def chosen(argument: Optional[str], variable: str) -> str:
        return environment.get(variable, "") if argument is None else argument

    ca, certificate, key = chosen(ca, "AXISGATE_CA"), chosen(certificate, "AXISGATE_CERTIFICATE"), chosen(
        key, "AXISGATE_KEY")
    if bool(certificate) != bool(key):
        raise ValueError("certificate and key must be given together")
    tls = bool(ca or certificate)
    found = Target(_address(chosen(target, "AXISGATE_TARGET"), tls, environment), SESSION,
                   chosen(token, "AXISGATE_TOKEN"), tls, ca, certificate, key)
    if found.token and not tls and not found.is_local:
        raise ValueError(f"the token is not sent unencrypted to {found.address}: give ca= or set AXISGATE_CA")
    return found


def _address(target: str, tls: bool, environment: Mapping[str, str]) -> str:
    if not target:
        return f"unix:{_default_socket(environment)}"
    if target.startswith(_SCHEMES):
        return target
    if "/" in target or target.endswith(".sock"):
        return f"unix:{target}"
    return _with_port(target, _TLS_PORT if tls else _PORT)


def _with_port(host: str, port: int) -> str:
    bracketed = host.startswith("[")
    if (not host.endswith("]")) if bracketed else host.count(":") == 1:
        return host
    return f"[{host}]:{port}" if not bracketed and ":" in host else f"{host}:{port}"


def _default_socket(environment: Mapping[str, str]) -> str:
    chosen = environment.get("AXISGATE_SOCKET", "")
    if chosen:
        return chosen
    if os.geteuid() == 0 or os.path.exists(_SYSTEM_SOCKET):
        return _SYSTEM_SOCKET
    runtime = environment.get("XDG_RUNTIME_DIR", "")
    return f"{runtime}/axisgate.sock" if runtime else f"/tmp/axisgate-{os.geteuid()}/axisgate.sock"
