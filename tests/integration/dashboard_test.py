#!/usr/bin/env python3
"""Every query of the Grafana dashboards against a real Prometheus that scrapes a real daemon at work."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

import yaml

import dashboard
from mill_jobs_test import quick_profile
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
baud = 38400

[[device]]
name = "mill"
kind = "rml1"
profile = "{{folder}}/quick.toml"
connection = "simulated"
"""

# One round of the load; each entry is a call of axisctl, which succeeds.
PATH = "1=+200um 2=0um speed=2mm/s\n1=0um 2=+200um\n1=-200um 2=-200um\n"
ROUND = (["home"], ["move", "1=+500um", "2=-200um", "--relative"], ["status"], ["path", "-", "--speed", "2mm/s"],
         ["move", "1=+5mm", "--relative", "--speed", "1mm/s", "--no-wait"], ["position"], ["--device", "stage", "stop"],
         ["exec", "?:P1"])
# A small job for the mill, which executes it within a second.
JOB = "^IN;!PZ-50,200;PU100,100;PU;H;\n"


def wait_for(what, look):
    deadline = time.monotonic() + LIMIT_S
    while not (found := look()):
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {LIMIT_S} s for {what}")
        time.sleep(0.05)  # between two looks; the deadline above decides
    return found


class Prometheus:
    """With the configuration of deploy/, on the daemon's real port and in a hurry."""

    def __init__(self, folder, metrics_address):
        config = yaml.safe_load((ROOT / "deploy/prometheus/prometheus.yml").read_text(encoding="utf-8"))
        config["global"] = {"scrape_interval": "200ms", "evaluation_interval": "200ms"}
        config["rule_files"] = [str(ROOT / "deploy/prometheus" / file) for file in config["rule_files"]]
        config["scrape_configs"][0]["static_configs"][0]["targets"] = [metrics_address]
        path = os.path.join(folder, "prometheus.yml")
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(config, file)
        self._log_path = os.path.join(folder, "prometheus.log")
        with open(self._log_path, "w", encoding="utf-8") as log:
            self._process = subprocess.Popen(
                ["prometheus", f"--config.file={path}", f"--storage.tsdb.path={folder}/data",
                 "--web.listen-address=127.0.0.1:0"], stdout=log, stderr=subprocess.STDOUT)
        self._address = ""

    def _log(self):
        with open(self._log_path, encoding="utf-8") as log:
            return log.read()

    def wait_until_ready(self):
        self._address = wait_for("Prometheus's port",
                                 lambda: re.search(r'msg="Listening on" address=(\S+)', self._log()))[1]
        wait_for("the first scrape", lambda: self.ask("query", query="up == 1")["data"]["result"])

    def ask(self, what, **parameters):
        """The API's answer; one that says what is wrong with the query is an answer, too."""
        url = f"http://{self._address}/api/v1/{what}?{urllib.parse.urlencode(parameters)}"
        try:
            with urllib.request.urlopen(url, timeout=LIMIT_S) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            if error.code == 503:  # it is still starting
                return {"status": "error", "error": "503", "data": {"result": []}}
            return json.load(error)

    def stop(self):
        self._process.terminate()
        self._process.wait(timeout=LIMIT_S)


class Load:
    """Keeps the stage moving, the mill milling, and one watcher watching, until it is stopped."""

    def __init__(self, daemon):
        self._daemon = daemon
        self._watcher = daemon.start("watch")
        self._ending = threading.Event()
        self.failures = []
        self._threads = [threading.Thread(target=run) for run in (self._move, self._mill)]
        for thread in self._threads:
            thread.start()

    def _run(self, arguments, stdin=""):
        answer = self._daemon.run(*arguments, stdin=stdin)
        if answer.returncode != 0:
            self.failures.append((arguments, answer.stderr))
        return answer.stdout

    def _move(self):
        while not self._ending.is_set():
            for arguments in ROUND:
                if self._ending.is_set():
                    return
                self._run(arguments, PATH if arguments[0] == "path" else "")

    def _mill(self):
        while not self._ending.is_set():
            sent = self._run(["mill", "send", "-"], JOB)
            self._run(["mill", "confirm", "--yes"])
            self._run(["mill", "start", "--follow"])
            self._run(["mill", "done", re.match(r"job (\d+) ", sent)[1]])

    def stop(self):
        self._ending.set()
        for thread in self._threads:
            thread.join()
        self._watcher.kill()


class AgainstPrometheus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-dashboard-")
        cls.addClassCleanup(folder.cleanup)
        subprocess.run([BIN / "axisgate-certificates", folder.name, "lab", "gateway"], check=True, timeout=LIMIT_S)
        pathlib.Path(folder.name, "quick.toml").write_text(quick_profile(), encoding="utf-8")
        daemon = Daemon(folder.name, CONFIG.replace("{{folder}}", folder.name))
        cls.addClassCleanup(daemon.stop)
        wait_for("the line to the mill", lambda: "mill  rml1  UP" in daemon.run("devices").stdout)
        cls.prometheus = Prometheus(folder.name, daemon.metrics_address())
        cls.addClassCleanup(cls.prometheus.stop)
        cls.load = Load(daemon)
        cls.addClassCleanup(cls.load.stop)
        cls.prometheus.wait_until_ready()

    def problem(self, target):
        answer = self.prometheus.ask("query", query=dashboard.fill_in(target["expr"]))
        return dashboard.problem(target, answer)

    def test_every_query_returns_a_series(self):
        pending = list(dashboard.targets())
        self.assertGreater(len(pending), 20)
        deadline = time.monotonic() + LIMIT_S
        while pending and time.monotonic() < deadline:
            pending = [(title, target) for title, target in pending if self.problem(target)]
            time.sleep(0.2)  # a scrape; the deadline above decides
        found = [f"{title} {target['refId']}: {self.problem(target)}: {target['expr']}" for title, target in pending]
        if found:
            self.fail("\n".join(["", *found]))
        self.assertEqual(self.load.failures, [])

    def test_every_family_of_the_daemon_is_shown(self):
        names = self.prometheus.ask("label/__name__/values", **{"match[]": '{job="axisgate"}'})["data"]
        families = {re.sub(r"_(bucket|sum|count)$", "", name) for name in names if name.startswith("axisgate_")}
        self.assertGreater(len(families), 30)
        shown = " ".join(target["expr"] for _, target in dashboard.targets())
        self.assertEqual([family for family in sorted(families) if not re.search(rf"\b{family}(_bucket)?\b", shown)], [])

    def test_every_alert_looks_at_something_and_none_fires(self):
        def rules():
            return self.prometheus.ask("rules")["data"]["groups"][0]["rules"]
        wait_for("the rules to be evaluated", lambda: all(rule["health"] != "unknown" for rule in rules()))
        self.assertGreater(len(rules()), 5)
        for rule in rules():
            with self.subTest(rule["name"]):
                looks_at = re.fullmatch(r"(.+) (?:==|>|<) [\d.e+]+", rule["query"])[1]
                target = {"expr": looks_at.replace("[5m]", "[10s]"), "legendFormat": ""}
                wait_for(looks_at, lambda target=target: not self.problem(target))
                self.assertEqual(rule["health"], "ok", rule.get("lastError"))
                # A job that is FED waits for its `done` a moment: what only begins to wait is inactive again soon.
                wait_for(f"{rule['name']} to be inactive",
                         lambda name=rule["name"]: {one["name"]: one["state"] for one in rules()}[name] == "inactive")

    def test_the_devices_to_choose_from(self):
        for file, devices in (("axisgate.json", ["stage"]), ("mills.json", ["mill"])):
            variables = {one["name"]: one for one in dashboard.load()[file]["templating"]["list"]}
            metric, label = re.fullmatch(r"label_values\((\w+), (\w+)\)", variables["device"]["query"]["query"]).groups()
            answer = self.prometheus.ask(f"label/{label}/values", **{"match[]": metric})
            self.assertEqual(answer["data"], devices)

    def test_what_is_wrong_is_seen(self):
        for expression, legend, expected in (
                ("axisgate_link_up{device=~\"$device\"}", "{{device}}", None),
                ("axisgate_link_down", "", "no series"),
                ("axisgate_link_up{device=\"other\"}", "", "no series"),
                ("0 * axisgate_link_up / 0", "", "no series"),
                ("sum by (lane) (axisgate_link_up)", "{{lane}}", "label lane"),
                ("rate(axisgate_link_up)", "", "parse error")):
            with self.subTest(expression):
                found = self.problem({"expr": expression, "legendFormat": legend})
                self.assertRegex(found or "", expected or r"\A\Z")


if __name__ == "__main__":
    unittest.main(verbosity=2)
