"""Message classes of the API, read from its .proto files when this module is imported."""

import pathlib
import subprocess
import tempfile

from google.protobuf import descriptor_pb2, message_factory

HERE = pathlib.Path(__file__).resolve().parent
PROTO = HERE.parents[1] / "proto"
LIMIT_S = 30


def _files():
    """Returns the descriptors of all files, each after the files that it imports."""
    sources = [str(path) for path in sorted((PROTO / "axisgate" / "v1").glob("*.proto"))]
    with tempfile.NamedTemporaryFile(prefix="axisgate-conform-") as file:
        subprocess.run(["protoc", f"--proto_path={PROTO}", f"--proto_path={HERE}", "--include_imports",
                        f"--descriptor_set_out={file.name}", *sources, "status.proto"], check=True, timeout=LIMIT_S)
        return descriptor_pb2.FileDescriptorSet.FromString(file.read()).file


_FILES = _files()
_CLASSES = message_factory.GetMessages(_FILES)
METHODS = {
    f"/{file.package}.{service.name}/{method.name}": (_CLASSES[method.input_type[1:]], _CLASSES[method.output_type[1:]])
    for file in _FILES for service in file.service for method in service.method
}
"""Classes of the request and of the answer by the path of the method."""
Problem = _CLASSES["axisgate.v1.Problem"]
Status = _CLASSES["conformance.Status"]


def path_of(method):
    """Returns "/axisgate.v1.StageService/Move" for "StageService/Move"."""
    return f"/axisgate.v1.{method}"
