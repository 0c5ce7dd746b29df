"""The tools that are no client libraries. Each is shown to notice a broken gateway, too."""

import json
import os
import re
import subprocess
import tempfile
import threading
import xml.etree.ElementTree

import windows
from gateway import ROOT, running
from rows import broken

LIMIT_S = 300
SERVICE = "axisgate.v1.DeviceService/"
FRONTS, GRPCS = "/axisgate.v1.DeviceService/ListDevices", "/axisgate.v1.AccessService/GetCaller"
LEAST_REACHED = 1000  # calls that were counted
# Cases of h2spec that do not pass, and what permits it. A case is a section and the beginning of its title.
CLOSED = ("RFC 9113, 5.1, closed: an endpoint MAY treat receipt of any other type of frame on a closed stream as a "
          "connection error")
ANSWERED = "the call was answered before the frame came, so its stream is closed; " + CLOSED
TRAILERS_ONLY = "the gRPC protocol over HTTP/2: an error, as that of an empty request, is an answer of trailers only"
PERMITTED = {
    ("generic/2", "Sends a WINDOW_UPDATE frame on half-closed"): TRAILERS_ONLY,
    ("generic/2", "Sends a PRIORITY frame on half-closed"): TRAILERS_ONLY,
    ("http2/5.1", "half closed (remote): Sends a DATA frame"): ANSWERED,
    ("http2/5.1", "half closed (remote): Sends a HEADERS frame"): ANSWERED,
    ("http2/5.1", "closed: Sends a DATA frame after sending RST_STREAM"): CLOSED,
    ("http2/5.1", "closed: Sends a HEADERS frame after sending RST_STREAM"): CLOSED,
    ("http2/5.1", "closed: Sends a DATA frame"): CLOSED,
    ("http2/5.1", "closed: Sends a HEADERS frame"): CLOSED,
    ("http2/5.1.1", "Sends stream identifier that is numerically smaller"):
        "RFC 9113, 5.1.1: all idle streams with a lower-valued stream identifier immediately transition to closed; then "
        + CLOSED,
    ("http2/5.1.2", "Sends HEADERS frames that causes"):
        "RFC 9113, 5.1.2: streams that are open or half-closed count; each call was answered before the next came",
    ("http2/5.3.1", "Sends PRIORITY frame that depend on itself"):
        "RFC 9113, 5.3.2: the priority signaling of RFC 7540 is deprecated, and SETTINGS_NO_RFC7540_PRIORITIES is sent",
    ("http2/6.1", "Sends a DATA frame on the stream that is not in"): CLOSED,
    ("http2/6.9.2", "Changes SETTINGS_INITIAL_WINDOW_SIZE"): TRAILERS_ONLY,
    ("http2/6.9.2", "Sends a SETTINGS frame for window size to be negative"): TRAILERS_ONLY,
    ("http2/6.9.1", "Sends SETTINGS frame to set the initial window size to 1"): TRAILERS_ONLY,
    ("http2/6.5.3", "Sends multiple values of SETTINGS_INITIAL_WINDOW_SIZE"): TRAILERS_ONLY,
}


def run_tool(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=LIMIT_S, check=False,
                          **options)


def reached(gateway, method):
    page = gateway.daemon.metrics_page()
    return sum(int(count) for count in re.findall(rf'rpcs_total{{[^}}]*method="{method.strip("/")}"[^}}]*}} (\d+)', page))


def explained(case):
    where, title = case.get("package"), case.get("classname")
    return next((why for (place, begins), why in PERMITTED.items() if place == where and title.startswith(begins)), None)


def h2spec(folder, address, method, token, *more):
    """Passed, permitted, and the others by name."""
    host, port = address.rsplit(":", 1)
    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        run_tool(folder / "suites" / "h2spec", "-h", host, "-p", port, "--path", method, "-j", report.name, *more,
                 env=dict(os.environ, H2SPEC_TOKEN=token))
        cases = list(xml.etree.ElementTree.parse(report.name).iter("testcase"))
    bad = [case for case in cases if any(case.find(end) is not None for end in ("failure", "error", "skipped"))]
    unexplained = [f"{case.get('package')} {case.get('classname')}" for case in bad if explained(case) is None]
    return len(cases) - len(bad), len(bad) - len(unexplained), unexplained


def check_h2spec(folder, method, *, tls=False):
    with running() as gateway:
        address, more = (gateway.tls_address(), ["--tls", "--insecure"]) if tls else (gateway.address, [])
        passed, permitted, others = h2spec(folder, address, method, gateway.new_token(), *more)
        calls = reached(gateway, method)
    if others or calls < LEAST_REACHED:
        raise AssertionError(f"{len(others)} unexplained: {others}; {calls} calls reached {method}")
    return f"{passed} passed, {permitted} permitted, {calls} calls of {method}"


def check_h2load(folder, address):
    call = folder / "get-device"
    call.write_bytes(windows.message(b"\x0a\x0d" + b"devices/stage"))
    shown = run_tool("h2load", "-n", 20000, "-c", 4, "-m", 100, "-d", call, "-H", "content-type: application/grpc", "-H",
                     "te: trailers", f"http://{address}/{SERVICE}GetDevice").stdout
    if "20000 succeeded, 0 failed, 0 errored, 0 timeout" not in shown:
        raise AssertionError(re.findall(r"requests: .*", shown))
    return "20000 calls"


def check_curl(_, address):
    for words, status in ((["--request", "GET"], "405"), (["--request", "POST"], "415"),
                          (["--header", "content-type: application/grpc", "--header", "te: trailers", "--data-binary",
                            "@-"], "200")):
        shown = run_tool("curl", "--silent", "--http2-prior-knowledge", "--output", "/dev/null", "--write-out",
                         "%{http_code}", *words, f"http://{address}{GRPCS}", input="\0\0\0\0\0").stdout
        if shown != status:
            raise AssertionError(f"{words}: {shown}, not {status}")
    return "3 calls"


def check_grpcurl(folder, address):
    tool = [folder / "suites" / "grpcurl", "-plaintext"]
    services = run_tool(*tool, address, "list").stdout.split()
    if "axisgate.v1.StageService" not in services or len(services) < 10:
        raise AssertionError(f"the services are {services}")
    shown = run_tool(*tool, "-d", '{"device":"devices/stage"}', address, SERVICE + "GetDevice")
    if shown.returncode != 0 or json.loads(shown.stdout)["device"]["link"] != "LINK_STATE_UP":
        raise AssertionError(shown.stdout + shown.stderr)
    return "2 calls by reflection"


def check_ghz(folder, address):
    protocol = folder / "axisgate.protoset"  # ghz itself cannot read `optional`
    run_tool("protoc", "--proto_path", ROOT / "proto", "--include_imports", "--descriptor_set_out", protocol,
             "axisgate/v1/device.proto")
    shown = run_tool(folder / "suites" / "ghz", "--insecure", "--protoset", protocol, "--call",
                     "axisgate.v1.DeviceService.GetDevice", "-d", '{"device":"devices/stage"}', "-n", 3000, "-c", 150,
                     "--connections", 1, "--format", "json", address)
    counts = json.loads(shown.stdout)["statusCodeDistribution"]
    if counts != {"OK": 3000}:
        raise AssertionError(f"the ends are {counts}")
    return "3000 calls, 150 at once on one connection"


def check_windows(_, address):
    return f"{windows.check(address)} calls"


TOOLS = {"h2load": check_h2load, "curl": check_curl, "grpcurl": check_grpcurl, "ghz": check_ghz,
         "python h2": check_windows}
# Each tool must notice a gateway that does this. "ends": the daemon is killed while it is asked.
NOTICED = {"h2load": "ends", "curl": "loses an answer", "grpcurl": "loses an answer", "ghz": "refuses some",
           "python h2": "loses an answer"}
COMPLAINTS = (AssertionError, KeyError, ValueError, OSError, subprocess.TimeoutExpired)
SOON_S = 0.2


def attempt(what, check):
    """Whether it passed; says so."""
    try:
        seen, good = check(), True
    except COMPLAINTS as complaint:
        seen, good = str(complaint)[:300], False
    print(f"{'ok' if good else 'FAIL'}  {what}: {seen}", flush=True)
    return good


def with_daemon(check, folder, host="127.0.0.1"):
    with running(host) as gateway:
        return check(folder, gateway.address)


def noticed(check, fault):
    """A gateway that is broken on purpose must be noticed."""
    try:
        check()
    except COMPLAINTS as complaint:
        return f"noticed: {str(complaint)[:160]}"
    raise AssertionError(f"a gateway that {fault} was not noticed")


def with_broken_daemon(check, folder, fault):
    with running() as gateway:
        if fault != "ends":
            with broken(fault, gateway.address) as target:
                return check(folder, target)
        killer = threading.Timer(SOON_S, gateway.daemon.kill)
        killer.start()
        try:
            return check(folder, gateway.address)
        finally:
            killer.join()


def spec_of_another_server(folder):
    with running() as gateway, broken("loses an answer", gateway.address) as target:
        others = h2spec(folder, target, GRPCS, gateway.new_token(), "http2/8")[2]  # of all cases one may hang there
    if others:
        raise AssertionError(f"{len(others)} unexplained")


def run(folder):
    passed = [attempt(f"h2spec{' with TLS' * tls}  {method}",
                      lambda method=method, tls=tls: check_h2spec(folder, method, tls=tls))
              for method in (FRONTS, GRPCS) for tls in (False, True)]
    passed.append(attempt("h2spec, another server", lambda: noticed(lambda: spec_of_another_server(folder), "differs")))
    for name, check in TOOLS.items():
        fault = NOTICED[name]
        passed.append(attempt(f"{name}, a gateway that {fault}", lambda check=check, fault=fault: noticed(
            lambda: with_broken_daemon(check, folder, fault), fault)))
        passed.append(attempt(name, lambda check=check: with_daemon(check, folder)))
        passed.append(attempt(f"{name} over IPv6", lambda check=check: with_daemon(check, folder, "::1")))
    return passed
