#!/usr/bin/env python3
"""When each alert of deploy/prometheus/alerts.yml fires, by promtool in its own time."""

import os
import re
import subprocess
import tempfile
import unittest

import yaml

from programs import LIMIT_S, ROOT

RULES = ROOT / "deploy" / "prometheus" / "alerts.yml"

# Alert: the series that it looks at, values of it every 15 s, the last time when it is quiet, and one when it fires.
FIRING = {
    "AxisgateDown": ({"__name__": "up", "job": "axisgate"}, "1x4 0x40", "2m", "2m15s"),
    "AxisgateDeviceDown": ({"__name__": "axisgate_link_up", "device": "stage"}, "1x4 0x40", "2m", "2m15s"),
    "AxisgateLineBabbles": ({"__name__": "axisgate_line_babbles", "device": "stage"}, "0x4 1x40", "1m", "1m30s"),
    "AxisgateStopOpen": ({"__name__": "axisgate_open_stops", "device": "stage", "late": "yes"}, "0x4 1x40", "1m",
                         "1m30s"),
    "AxisgateUnderruns": ({"__name__": "axisgate_underruns_total", "device": "stage"}, "0x8 1x40", "2m", "2m15s"),
    "AxisgateLineInDoubt": ({"__name__": "axisgate_barriers_total", "device": "stage"}, "0x8 10x40", "2m", "2m15s"),
    "AxisgateLineSaturated": ({"__name__": "axisgate_line_busy_seconds_total", "device": "stage"}, "0+14.2x60", "9m",
                              "10m15s"),
    "AxisgateMillLineClosed": ({"__name__": "axisgate_mill_line_open", "device": "mill"}, "1x4 0x40", "2m", "2m15s"),
    "AxisgateMillBusy": ({"__name__": "axisgate_mill_busy", "device": "mill"}, "0x4 1x40", "2m", "2m15s"),
    "AxisgateMillJobUnknown": ({"__name__": "axisgate_mill_queued_jobs", "device": "mill", "state": "PAUSED_UNKNOWN"},
                               "0x8 1x40", "2m", "2m15s"),
    "AxisgateMillJobFed": ({"__name__": "axisgate_mill_queued_jobs", "device": "mill", "state": "FED"}, "0x4 1x80",
                           "16m", "16m15s"),
    "AxisgateCertificateExpires": ({"__name__": "axisgate_certificate_expiry_timestamp_seconds"},
                                   f"{14 * 86400 + 130}x40", "2m", "2m15s"),
    "AxisgateJournalUnavailable": ({"__name__": "axisgate_journal_available"}, "1x4 0x40", "2m", "2m15s"),
    "AxisgateRefusals": ({"__name__": "axisgate_refusals_total", "reason": "NOT_ALLOWED"}, "0x8 30x40", "2m", "2m15s"),
    "AxisgateConnectionsRefused": ({"__name__": "axisgate_connections_refused_total"}, "0x8 3x40", "2m", "2m15s"),
}
# What is everyday life, and fires nothing.
QUIET = {
    "AxisgateDown": ({"__name__": "up", "job": "another"}, "0x40"),
    "AxisgateDeviceDown": ({"__name__": "axisgate_link_up", "device": "stage"}, "1x4 0x3 1x40"),
    "AxisgateLineBabbles": ({"__name__": "axisgate_line_babbles", "device": "stage"}, "0x4 1x0 0x40"),
    "AxisgateStopOpen": ({"__name__": "axisgate_open_stops", "device": "stage", "late": "no"}, "0x4 1x40"),
    "AxisgateUnderruns": ({"__name__": "axisgate_underruns_total", "device": "stage"}, "7x40"),
    "AxisgateLineInDoubt": ({"__name__": "axisgate_barriers_total", "device": "stage"}, "0x8 1x8 2x8 3x8 4x8"),
    "AxisgateLineSaturated": ({"__name__": "axisgate_line_busy_seconds_total", "device": "stage"}, "0+12.8x40"),
    "AxisgateMillLineClosed": ({"__name__": "axisgate_mill_line_open", "device": "mill"}, "1x4 0x3 1x40"),
    "AxisgateMillBusy": ({"__name__": "axisgate_mill_busy", "device": "mill"}, "0x4 1x3 0x40"),
    "AxisgateMillJobUnknown": ({"__name__": "axisgate_mill_queued_jobs", "device": "mill", "state": "RUNNING"}, "1x40"),
    "AxisgateMillJobFed": ({"__name__": "axisgate_mill_queued_jobs", "device": "mill", "state": "FED"}, "0x4 1x30 0x9"),
    "AxisgateCertificateExpires": ({"__name__": "axisgate_certificate_expiry_timestamp_seconds"}, f"{90 * 86400}x40"),
    "AxisgateJournalUnavailable": ({"__name__": "axisgate_journal_available"}, "1x4 0x3 1x40"),
    "AxisgateRefusals": ({"__name__": "axisgate_refusals_total", "reason": "NOT_ALLOWED"}, "0x8 1x8 2x8 3x8 4x8"),
    "AxisgateConnectionsRefused": ({"__name__": "axisgate_connections_refused_total"}, "3x40"),
}
MINUTES = [f"{minute}m" for minute in range(1, 11)]


def rules():
    """{alert: rule}"""
    groups = yaml.safe_load(RULES.read_text(encoding="utf-8"))["groups"]
    return {rule["alert"]: rule for group in groups for rule in group["rules"]}


def selector(labels):
    pairs = ",".join(f'{name}="{value}"' for name, value in labels.items() if name != "__name__")
    return f"{labels['__name__']}{{{pairs}}}"


def fired(rule, labels):
    """What promtool is to see of the alert."""
    text = {name: re.sub(r"{{ \$labels\.(\w+) }}", lambda label: labels[label[1]], words)
            for name, words in rule["annotations"].items()}
    return {"exp_labels": {name: value for name, value in labels.items() if name != "__name__"},
            "exp_annotations": text}


class Alerts(unittest.TestCase):
    def promtool(self, *arguments):
        run = subprocess.run(["promtool", *arguments], capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def expect(self, labels, values, moments):
        """`moments` are promtool's: an alert, a time, and what fires then."""
        test = {"interval": "15s", "input_series": [{"series": selector(labels), "values": values}],
                "alert_rule_test": moments}
        with tempfile.TemporaryDirectory(prefix="axisgate-alerts-") as folder:
            path = os.path.join(folder, "test.yml")
            with open(path, "w", encoding="utf-8") as file:
                yaml.safe_dump({"rule_files": [str(RULES)], "evaluation_interval": "15s", "tests": [test]}, file)
            self.promtool("test", "rules", path)

    def test_promtool_finds_nothing(self):
        self.promtool("check", "rules", RULES)

    def test_each_fires_in_its_time(self):
        self.assertEqual(sorted(rules()), sorted(FIRING))
        for alert, (labels, values, quiet, fires) in FIRING.items():
            with self.subTest(alert):
                self.expect(labels, values, [
                    {"alertname": alert, "eval_time": quiet, "exp_alerts": []},
                    {"alertname": alert, "eval_time": fires, "exp_alerts": [fired(rules()[alert], labels)]}])

    def test_everyday_life_fires_nothing(self):
        self.assertEqual(sorted(rules()), sorted(QUIET))
        for alert, (labels, values) in QUIET.items():
            with self.subTest(alert):
                self.expect(labels, values, [{"alertname": alert, "eval_time": minute, "exp_alerts": []}
                                             for minute in MINUTES])


if __name__ == "__main__":
    unittest.main(verbosity=2)
