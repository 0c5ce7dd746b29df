"""The Grafana dashboards as their files say it, with Grafana's variables filled in."""

import json
import re

from programs import ROOT

FOLDER = ROOT / "deploy" / "grafana" / "dashboards"
HOME = "axisgate.json"
# What Grafana puts in for two chosen devices; the intervals suit a scrape every fraction of a second.
VARIABLES = {"device": "(stage|mill)", "__rate_interval": "10s", "__range": "1m"}


def load():
    """{file's name: board}"""
    return {file.name: json.loads(file.read_text(encoding="utf-8")) for file in sorted(FOLDER.glob("*.json"))}


def fill_in(expression):
    return re.sub(r"\$(\w+)", lambda variable: VARIABLES[variable[1]], expression)


def targets():
    """(panel's title, target) of every query."""
    for board in load().values():
        for panel in board["panels"]:
            for target in panel.get("targets", []):
                yield panel["title"], target


def problem(target, answer):
    """What is wrong with Prometheus's answer to a target's query, or None."""
    if answer["status"] != "success":
        return answer["error"]
    series = answer["data"]["result"]
    if not any(float(one["value"][1]) == float(one["value"][1]) for one in series):
        return "no series with a value that is a number"
    for label in re.findall(r"{{(\w+)}}", target["legendFormat"]):
        if any(label not in one["metric"] for one in series):
            return f"the legend names the label {label}, which a series lacks"
    return None
