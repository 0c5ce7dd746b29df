#!/usr/bin/env python3
"""The metrics page of a daemon at work: what promtool says about it, that server/README.md lists it as it is, and that
nobody can keep Prometheus from it."""

import contextlib
import http.client
import re
import socket
import subprocess
import tempfile
import threading
import time
import unittest

from programs import BIN, LIMIT_S, ROOT, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[network]
listen = "127.0.0.1:0"
certificate = "{{folder}}/gateway.crt"
key = "{{folder}}/gateway.key"

[[device]]
name = "stage"
connection = "simulated"

[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
"""


def problems(page):
    """What `promtool check metrics` finds in a page, or an empty string."""
    check = subprocess.run(["promtool", "check", "metrics"], input=page, capture_output=True, text=True,
                           timeout=LIMIT_S, check=False)
    found = check.stdout + check.stderr
    return found or ("" if check.returncode == 0 else f"exit code {check.returncode}")


def families(page):
    """{name: (type, {label names of a series in order, ...})}; `le` and `quantile` belong to the type."""
    types = dict(re.findall(r"(?m)^# TYPE (\S+) (\S+)$", page))
    found = {name: (kind, set()) for name, kind in types.items()}
    for name, labels in re.findall(r"(?m)^(\w+)(?:{(.*)})? \S+$", page):
        family = name if name in types else re.sub(r"_(bucket|sum|count)$", "", name)
        names = re.findall(r'(\w+)="(?:[^"\\]|\\.)*"', labels)
        found[family][1].add(tuple(sorted(set(names) - {"le", "quantile"})))
    return found


def documented():
    """The same from the table in server/README.md."""
    text = (ROOT / "server" / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"(?m)^\| `(axisgate_\w+)` \| (\w+) \|(.*?)\| .+ \|$", text)
    return {name: (kind, {tuple(sorted(re.findall(r"`(\w+)`", labels)))}) for name, kind, labels in rows}


def daemon_of(case):
    """One for all tests of the class."""
    folder = tempfile.TemporaryDirectory(prefix="axisgate-metrics-")
    case.addClassCleanup(folder.cleanup)
    subprocess.run([BIN / "axisgate-certificates", folder.name, "lab", "gateway"], check=True, timeout=LIMIT_S)
    daemon = Daemon(folder.name, CONFIG.replace("{{folder}}", folder.name))
    case.addClassCleanup(daemon.stop)
    return daemon


class AtWork(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        daemon = daemon_of(cls)
        for arguments in (["home"], ["move", "1=+10um", "--relative"], ["move", "1=+1m"], ["exec", "?:P1"], ["stop"]):
            daemon.run(*arguments)
        cls.page = daemon.metrics_page()

    def test_promtool_finds_nothing(self):
        self.assertEqual(problems(self.page), "")

    def test_promtool_would_find_something(self):
        self.assertIn("counter metrics should have", problems("# HELP a Bs.\n# TYPE a counter\na 1\n"))
        self.assertIn("no help text", problems("# TYPE a gauge\na 1\n"))
        self.assertNotEqual(problems("a{ 1\n"), "")

    def test_the_readme_lists_the_families_with_their_labels(self):
        self.maxDiff = None
        self.assertEqual(documented(), families(self.page))

    def test_no_device_shows_what_only_another_kind_has(self):
        for name, labels in re.findall(r"(?m)^(\w+){(.*)} \S+$", self.page):
            if 'device="mill"' in labels and name != "axisgate_recorder_dropped_total":
                self.assertRegex(name, r"\Aaxisgate_mill_")
            if 'device="stage"' in labels:
                self.assertNotRegex(name, r"\Aaxisgate_mill_")

    def test_families_are_read_as_they_stand_there(self):
        page = ('# TYPE a counter\na{x="1",y="a\\"} b=\\""} 1\n'
                '# TYPE b histogram\nb_bucket{x="1",le="+Inf"} 0\nb_sum{x="1"} 0\nb_count{x="1"} 0\n'
                '# TYPE c gauge\nc 1\nc{z="1"} Nan\n')
        self.assertEqual(families(page), {"a": ("counter", {("x", "y")}), "b": ("histogram", {("x",)}),
                                          "c": ("gauge", {(), ("z",)})})


REQUEST = b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n"
SCRAPE_LIMIT_S = 1


class UnderSiege(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        host, port = daemon_of(cls).metrics_address().rsplit(":", 1)
        cls.address = host, int(port)

    def connections(self, stack, count, sent):
        """Those that read do it slowly: little fits into their buffers."""
        made = []
        for _ in range(count):
            made.append(stack.enter_context(socket.socket()))
            made[-1].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
            made[-1].settimeout(LIMIT_S)
            made[-1].connect(self.address)
            made[-1].sendall(sent)
        return made

    def scrape_ten_times(self, connection):
        """One each 0.2 s, as Prometheus does: on one connection, which is made again when the page has closed it."""
        longest = 0
        for _ in range(10):
            begin = time.monotonic()
            self.assertIn(b"axisgate_link_up{", self.scrape(connection))
            took = time.monotonic() - begin
            longest = max(longest, took)
            time.sleep(max(0, 0.2 - took))  # the pace of the scrapes; nothing is waited for
        self.assertLess(longest, SCRAPE_LIMIT_S)

    def scrape(self, connection):
        fresh = connection.sock is None
        try:
            connection.request("GET", "/metrics")
            return connection.getresponse().read()
        except (http.client.RemoteDisconnected, ConnectionError):
            connection.close()
            if fresh:
                raise
        return self.scrape(connection)

    def prometheus(self):
        return contextlib.closing(http.client.HTTPConnection(*self.address, timeout=SCRAPE_LIMIT_S))

    def test_two_hundred_slow_readers(self):
        with contextlib.ExitStack() as stack:
            readers = self.connections(stack, 200, REQUEST)
            ended = threading.Event()

            def read_slowly():
                while not ended.is_set():
                    for reader in readers:
                        reader.recv(1)
                    ended.wait(0.01)

            thread = threading.Thread(target=read_slowly)
            thread.start()
            try:
                with self.prometheus() as connection:
                    self.scrape_ten_times(connection)
            finally:
                ended.set()
                thread.join()

    def test_requests_that_are_never_sent_whole(self):
        with contextlib.ExitStack() as stack, self.prometheus() as connection:
            self.scrape(connection)
            self.connections(stack, 300, REQUEST[:-2])
            self.scrape_ten_times(connection)

    def test_all_of_them_and_always_more(self):
        with contextlib.ExitStack() as stack, self.prometheus() as connection:
            self.connections(stack, 100, REQUEST)
            self.connections(stack, 100, REQUEST[:-2])
            ended = threading.Event()

            def come_and_stay():
                while not ended.is_set():
                    with contextlib.ExitStack() as more:
                        self.connections(more, 300, REQUEST[:-2])

            thread = threading.Thread(target=come_and_stay)
            thread.start()
            try:
                self.scrape_ten_times(connection)
            finally:
                ended.set()
                thread.join()


if __name__ == "__main__":
    unittest.main(verbosity=2)
