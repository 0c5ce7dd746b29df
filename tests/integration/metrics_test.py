#!/usr/bin/env python3
"""The metrics page of a daemon at work: what promtool says about it, and that server/README.md lists it as it is."""

import re
import subprocess
import tempfile
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
    rows = re.findall(r"(?m)^\| `((?:axisgate|exposer)_\w+)` \| (\w+) \|(.*?)\| .+ \|$", text)
    return {name: (kind, {tuple(sorted(re.findall(r"`(\w+)`", labels)))}) for name, kind, labels in rows}


class AtWork(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-metrics-")
        cls.addClassCleanup(folder.cleanup)
        subprocess.run([BIN / "axisgate-certificates", folder.name, "lab", "gateway"], check=True, timeout=LIMIT_S)
        daemon = Daemon(folder.name, CONFIG.replace("{{folder}}", folder.name))
        cls.addClassCleanup(daemon.stop)
        for arguments in (["home"], ["move", "1=+10um", "--relative"], ["move", "1=+1m"], ["exec", "?:P1"], ["stop"]):
            daemon.run(*arguments)
        daemon.metrics_page()  # what the page says of itself begins with the second
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

    def test_families_are_read_as_they_stand_there(self):
        page = ('# TYPE a counter\na{x="1",y="a\\"} b=\\""} 1\n'
                '# TYPE b histogram\nb_bucket{x="1",le="+Inf"} 0\nb_sum{x="1"} 0\nb_count{x="1"} 0\n'
                '# TYPE c gauge\nc 1\nc{z="1"} Nan\n')
        self.assertEqual(families(page), {"a": ("counter", {("x", "y")}), "b": ("histogram", {("x",)}),
                                          "c": ("gauge", {(), ("z",)})})


if __name__ == "__main__":
    unittest.main(verbosity=2)
