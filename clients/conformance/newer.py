"""A daemon of later than this version, as far as a client can tell: it refuses every move with a reason that no package
knows yet."""

import concurrent.futures
import os
import subprocess
import sys
import tempfile

import grpc

from world import LIMIT_S, ROOT

REASON = 999
FAILED_PRECONDITION = 9
STATUS = """
syntax = "proto3";
package newer;
import "google/protobuf/any.proto";
message Status { int32 code = 1; string message = 2; repeated google.protobuf.Any details = 3; }
"""


class NewerDaemon(grpc.GenericRpcHandler):
    def __enter__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="axisgate-newer-")
        _generate(self._folder.name)
        sys.path.insert(0, self._folder.name)
        self._server = grpc.server(concurrent.futures.ThreadPoolExecutor(8), [self])
        self._socket = os.path.join(self._folder.name, "newer.sock")
        self._server.add_insecure_port(f"unix:{self._socket}")
        self._server.start()
        return self

    def way_in(self):
        return {"target": f"unix:{self._socket}"}

    def service(self, details):
        if details.method.endswith("/ListDevices"):
            return grpc.unary_unary_rpc_method_handler(lambda _, context: _devices())
        return grpc.unary_unary_rpc_method_handler(_refuse)

    def __exit__(self, *_):
        self._server.stop(None)
        sys.path.remove(self._folder.name)
        self._folder.cleanup()


def _generate(folder):
    """Makes the messages of the API, and one with the fields of google.rpc.Status."""
    with open(os.path.join(folder, "newer_status.proto"), "w", encoding="utf-8") as file:
        file.write(STATUS)
    files = [str(path) for path in sorted((ROOT / "proto" / "axisgate" / "v1").glob("*.proto"))]
    subprocess.run(["protoc", f"--proto_path={ROOT / 'proto'}", f"--proto_path={folder}", f"--python_out={folder}",
                    *files, "newer_status.proto"], check=True, timeout=LIMIT_S)


def _devices():
    from axisgate.v1 import common_pb2, device_pb2

    stage = device_pb2.Device(name="devices/stage", kind="stage", link=device_pb2.LINK_STATE_UP,
                               capabilities=[device_pb2.CAPABILITY_MOVE])
    stage.axes.add(number=1, name="x", unit=common_pb2.UNIT_MILLIMETERS, controllable=True)
    return device_pb2.ListDevicesResponse(devices=[stage], requests_kept=True, request_memory="1-1").SerializeToString()


def _refuse(_, context):
    from axisgate.v1 import common_pb2
    from newer_status_pb2 import Status

    problem = common_pb2.Problem(message="the moon is full", hint="wait for another night")
    problem.reason = REASON
    status = Status(code=FAILED_PRECONDITION, message=problem.message)
    status.details.add().Pack(problem)
    context.set_trailing_metadata((("grpc-status-details-bin", status.SerializeToString()),))
    context.abort(grpc.StatusCode.FAILED_PRECONDITION, problem.message)
