#!/usr/bin/env python3
"""What deploy/ gives to Docker Compose, Prometheus and Grafana fits together; none of the three is started here."""

import pathlib
import re
import subprocess
import unittest

import yaml

import dashboard
from programs import LIMIT_S, ROOT

DEPLOY = ROOT / "deploy"


def load(path):
    return yaml.safe_load((DEPLOY / path).read_text(encoding="utf-8"))


class Compose(unittest.TestCase):
    def setUp(self):
        self.services = load("compose.yaml")["services"]

    def mounts(self, service):
        """Where a file or folder of deploy/ appears: {path inside: path here}."""
        pairs = [volume.split(":")[:2] for volume in self.services[service]["volumes"]]
        return {inside: DEPLOY / source for source, inside in pairs if source.startswith("./")}

    def test_images_are_built_here_or_pinned(self):
        self.assertTrue((DEPLOY / self.services["axisgate"]["build"]["context"] / "Dockerfile").is_file())
        for name in ("prometheus", "grafana"):
            self.assertRegex(self.services[name]["image"], r":v?\d+\.\d+\.\d+$")

    def test_what_is_mounted_exists(self):
        for name in ("prometheus", "grafana"):
            for source in self.mounts(name).values():
                self.assertTrue(source.exists(), source)

    def test_all_share_the_network_in_which_the_daemon_listens_on_loopback(self):
        for service in self.services.values():
            self.assertEqual(service["network_mode"], "host")
        self.assertEqual(self.services["grafana"]["environment"]["GF_SERVER_HTTP_ADDR"], "127.0.0.1")
        self.assertIn(f"--web.listen-address={self.prometheus_address()}", self.services["prometheus"]["command"])

    def prometheus_address(self):
        source = load("grafana/provisioning/datasources/prometheus.yaml")["datasources"][0]
        return re.fullmatch(r"http://(127\.0\.0\.1:\d+)", source["url"])[1]

    def test_prometheus_reads_its_file_and_scrapes_the_daemon(self):
        path = next(word.split("=")[1] for word in self.services["prometheus"]["command"] if "config.file" in word)
        config = self.mounts("prometheus")[path]
        check = subprocess.run(["promtool", "check", "config", config], capture_output=True, text=True,
                               timeout=LIMIT_S, check=False)
        self.assertEqual(check.returncode, 0, check.stderr)
        for rules in load("prometheus/prometheus.yml")["rule_files"]:
            self.assertIn(str(pathlib.PurePath(path).parent / rules), self.mounts("prometheus"))
        example = (DEPLOY / "axisgate.toml").read_text(encoding="utf-8")
        metrics = re.search(r'(?m)^metrics = "(.+?)"', example)[1]
        scrape = load("prometheus/prometheus.yml")["scrape_configs"][0]
        self.assertEqual(scrape["static_configs"][0]["targets"], [metrics])

    def test_grafana_knows_how_often_prometheus_scrapes(self):
        source = load("grafana/provisioning/datasources/prometheus.yaml")["datasources"][0]
        interval = load("prometheus/prometheus.yml")["global"]["scrape_interval"]
        self.assertEqual(source["jsonData"]["timeInterval"], interval)

    def test_grafana_finds_the_dashboard(self):
        mounts = self.mounts("grafana")
        self.assertEqual(mounts["/etc/grafana/provisioning"], DEPLOY / "./grafana/provisioning")
        folder = load("grafana/provisioning/dashboards/axisgate.yaml")["providers"][0]["options"]["path"]
        self.assertEqual(mounts[folder].resolve(), dashboard.FOLDER)
        home = self.services["grafana"]["environment"]["GF_DASHBOARDS_DEFAULT_HOME_DASHBOARD_PATH"]
        self.assertEqual(home, f"{folder}/{dashboard.HOME}")
        self.assertIn(dashboard.HOME, dashboard.load())

    def test_the_daemons_socket_belongs_to_the_images_user(self):
        user = re.search(r"useradd .*--uid (\d+)", (ROOT / "Dockerfile").read_text(encoding="utf-8"))[1]
        self.assertEqual(self.services["axisgate"]["tmpfs"], [f"/run/axisgate:uid={user},gid={user},mode=0755"])


class Dashboards(unittest.TestCase):
    def test_boards_have_names_of_their_own(self):
        boards = dashboard.load().values()
        for key in ("uid", "title"):
            self.assertEqual(len({board[key] for board in boards}), len(boards))

    def test_panels_have_numbers_of_their_own_and_places_of_their_own(self):
        for name, board in dashboard.load().items():
            with self.subTest(name):
                self.check_panels(board["panels"])

    def check_panels(self, panels):
        numbers = [panel["id"] for panel in panels]
        self.assertEqual(len(numbers), len(set(numbers)))
        taken = {}
        for panel in panels:
            place = panel["gridPos"]
            self.assertLessEqual(place["x"] + place["w"], 24, panel["title"])
            for cell in ((x, y) for x in range(place["x"], place["x"] + place["w"])
                         for y in range(place["y"], place["y"] + place["h"])):
                self.assertNotIn(cell, taken, f"{panel['title']} over {taken.get(cell)}")
                taken[cell] = panel["title"]


if __name__ == "__main__":
    unittest.main(verbosity=2)
