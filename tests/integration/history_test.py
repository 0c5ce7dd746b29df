#!/usr/bin/env python3
"""What the daemon keeps of what happened, and finds again when it was killed or restarted."""

import contextlib
import csv
import json
import os
import re
import shlex
import sqlite3
import tempfile
import time
import unittest

from programs import LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 100
"""


class History(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-history-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.journal = os.path.join(self.folder, "state", "journal.sqlite")
        self.start()

    def start(self, extra=""):
        self.daemon = Daemon(self.folder, CONFIG + extra)
        self.addCleanup(self.daemon.stop)

    def run_well(self, *words):
        done = self.daemon.run(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def history(self, *words):
        return [json.loads(line) for line in self.run_well("--json", "history", *words).splitlines()]

    def test_the_morning_after(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("stop")
        self.daemon.kill()
        self.start()
        self.run_well("move", "1=+100pulse", "--relative")
        shown = self.run_well("history")
        self.assertRegex(shown, r"(?m)^\S+ \S+  stage  motion 1 \(move of axis 1\) SUCCEEDED; axis 1 at 100 pulses, by unix ")
        self.assertRegex(shown, r"(?m)^\S+ \S+  stage  stop of axes 1, 2, 3, by unix ")
        self.assertEqual(len(re.findall(r"the daemon started", shown)), 2, shown)
        self.assertNotIn("the daemon ended", shown, "it was killed")
        motions = {entry["motion"] for entry in self.history()} - {""}
        self.assertEqual(motions, {"devices/stage/motions/1", "devices/stage/motions/2"}, "a number is not used twice")

    def test_a_move_with_an_id_is_made_once(self):
        for _ in range(2):
            self.run_well("--request-id", "night-17", "move", "1=+100pulse", "--relative")
        self.daemon.kill()
        self.start()
        self.assertIn("done: axis 1 at", self.run_well("--request-id", "night-17", "move", "1=+100pulse", "--relative"))
        ended = [one for one in self.history() if one["kind"] == "HISTORY_KIND_MOTION_ENDED"]
        self.assertEqual(len(ended), 1)
        refused = self.daemon.run("--request-id", "night-17", "move", "1=+200pulse", "--relative")
        self.assertIn("REQUEST_ID_REUSED", refused.stderr)

    def test_a_move_whose_daemon_is_killed_and_started_again_is_reported(self):
        self.run_well("move", "1=+1pulse", "--relative")
        move = self.daemon.start("move", "1=+90000000pulse", "--relative", "--speed", "100000pulse/s")  # nine seconds
        move.until("RUNNING")
        self.daemon.kill()
        self.start()
        self.assertNotEqual(move.end(), 0)
        self.assertIn("requesting again, with the same request id", move.errors)
        self.assertIn("OUTCOME_UNKNOWN", move.errors)
        motions = {one["motion"] for one in self.history()} - {""}
        self.assertEqual(len(motions), 2, "it was not sent a second time")

    def test_a_motion_from_its_request_to_its_end(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.assertEqual([entry["kind"] for entry in self.history("--motion", "1")],
                         ["HISTORY_KIND_MOTION_REQUESTED", "HISTORY_KIND_MOTION_STARTED", "HISTORY_KIND_MOTION_ENDED"])
        shown = self.run_well("history", "--motion", "1")
        self.assertRegex(shown, r"(?m)^motion 1: SUCCEEDED \d+(\.\d)? s after its start; axis 1 at 100 pulses$")
        self.assertEqual(self.run_well("history", "--motion", "99"), "the journal has no motion 99\n")
        self.run_well("move", "1=15mm", "--speed", "10um/s", "--no-wait")
        self.assertRegex(self.run_well("history", "--motion", "2"), r"(?m)^motion 2 has no outcome: ")
        self.run_well("stop")

    def test_a_motion_with_its_lines_and_their_answers(self):
        self.run_well("move", "1=+100pulse", "--relative")
        exchanged = [line for entry in self.history("--motion", "1")
                     for line in json.loads(entry["details"]).get("lines", [])]
        self.assertEqual([line[:2] for line in exchanged], [["MP:1+P100", "OK"], ["G:1", "OK"]])
        self.assertLess(exchanged[0][2], exchanged[1][2])
        self.assertEqual(len(self.history("--text", "MP:1+P100")), 1, "each line is kept once")
        shown = self.run_well("history", "--motion", "1").splitlines()
        self.assertEqual(len(shown), 7, shown)
        self.assertRegex("\n".join(shown[2:4]), r"\A  MP:1\+P100  OK  \d+ ms\n  G:1  OK  \d+ ms\Z")
        self.assertRegex(shown[6], r"^the recording still has it, from about \d+ s on: axisctl --device stage record ")
        command = shlex.split(shown[6].partition(": ")[2])
        recording = os.path.join(self.folder, command.pop())
        self.run_well(*command[1:], recording)
        with open(recording, encoding="ascii") as file:
            self.assertIn('> "G:1\\r\\n"', file.read())
        self.daemon.stop()
        self.start()
        self.assertEqual(len(self.run_well("history", "--motion", "1").splitlines()), 6, "the recording began again")

    def test_lines_of_no_motion_are_kept_and_questions_are_not(self):
        self.run_well("exec", "?:N", "O:1")
        self.run_well("stop", "2")
        kept = [entry for entry in self.history() if entry["kind"] == "HISTORY_KIND_LINES_EXCHANGED"]
        self.assertEqual([json.loads(entry["details"])["lines"] for entry in kept], [[["L:2", "OK"]], [["O:1", "OK"]]])
        self.assertEqual(self.history("--axis", "2", "--text", "L:2"), kept[:1])
        self.assertRegex(self.run_well("history"), r"(?m)^\S+ \S+  stage  sent: L:2  OK, by unix ")
        self.assertIn(",LINES_EXCHANGED,stage,", self.run_well("history", "--csv"))

    def test_a_lease_a_latch_and_a_refusal(self):
        holder = self.daemon.start("lease", "run", "--axes", "1", "--purpose", "for Carl", "--", "sh", "-c",
                                   "echo held; exec sleep 60")
        self.addCleanup(holder.kill)
        holder.until("held")
        self.run_well("stop", "1")
        self.assertIn("LEASE_HELD", self.daemon.run("move", "1=+100pulse", "--relative").stderr)
        self.run_well("rearm")
        holder.process.terminate()
        holder.end()
        entries = [(entry["kind"].removeprefix("HISTORY_KIND_"), json.loads(entry["details"]))
                   for entry in reversed(self.history()) if "DAEMON" not in entry["kind"] and "LINK" not in entry["kind"]]
        self.assertEqual([kind for kind, _ in entries], ["LEASE_GRANTED", "LATCHED", "STOP_REQUESTED", "LINES_EXCHANGED",
                                                         "STOP_ENDED", "REQUEST_REFUSED", "REARMED", "REQUEST_ENDED", "LEASE_ENDED"],
                         "what is refused at first is not written as if it were to be done")
        details = dict(entries)
        self.assertEqual(details["LEASE_GRANTED"]["axes"], [1])
        self.assertEqual(details["LATCHED"], {"axes": [1]})
        self.assertEqual(details["LEASE_ENDED"], {"axes": [1], "lease": details["LEASE_GRANTED"]["lease"], "why": "released"})
        shown = self.run_well("history")
        self.assertNotIn("Carl", shown)
        for line in (r"lease \d+ of unix \S+ over axis 1 granted", r"unix \S+ is held back from axis 1 until they rearm",
                     r"unix \S+ rearmed axis 1", r"lease \d+ of unix \S+ over axis 1 ended: released"):
            self.assertRegex(shown, rf"(?m)^\S+ \S+  stage  {line}$")

    def test_who_is_refused_in_a_loop_does_not_fill_the_history(self):
        holder = self.daemon.start("lease", "run", "--axes", "1", "--", "sh", "-c", "echo held; exec sleep 60")
        holder.until("held")
        for _ in range(63):
            self.assertIn("LEASE_HELD", self.daemon.run("move", "1=+1pulse", "--relative").stderr)
        holder.process.terminate()  # passed on to its command
        holder.end()
        self.assertEqual(len(self.history("--text", "LEASE_HELD")), 60)
        self.daemon.stop()
        self.start()
        summed_up = json.loads(self.history("--text", "LEASE_HELD")[0]["details"])
        self.assertEqual(summed_up, {"count": 3, "reason": "LEASE_HELD", "request": "move"})
        self.assertRegex(self.run_well("history"), r"(?m)  stage  3 requests refused; the last of them refused: move, LEASE_HELD")
        self.assertRegex(self.run_well("history", "--night", "--hours", "1"), r"63 refused")

    def test_filters_and_limits(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.assertEqual(self.history("--who", "unix nobody-here"), [])
        self.assertEqual(len(self.history("--limit", "2")), 2)
        self.assertGreater(len(self.history("--hours", "1")), 3)
        everything = self.history("--limit", "5000")
        numbers = [int(entry["number"]) for entry in everything]
        self.assertEqual(numbers, list(range(len(numbers), 0, -1)))

    def test_what_details_say(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("home", "2", "3")
        self.assertEqual({entry["motion"] for entry in self.history("--axis", "3")}, {"devices/stage/motions/2"})
        self.assertEqual(self.history("--outcome", "failed"), [])
        self.assertEqual([entry["motion"] for entry in self.history("--outcome", "succeeded")],
                         ["devices/stage/motions/2", "devices/stage/motions/1"])
        self.assertEqual([entry["motion"] for entry in self.history("--text", '"kind":"home"', "--outcome", "succeeded")],
                         ["devices/stage/motions/2"])
        self.assertEqual(self.daemon.run("history", "--axis", "7").returncode, 2)
        self.assertEqual(self.daemon.run("history", "--outcome", "done").returncode, 2)

    def test_a_table_for_other_programs(self):
        self.run_well("move", "1=+100pulse", "--relative")
        rows = list(csv.DictReader(self.run_well("history", "--csv").splitlines()))
        entries = self.history()
        self.assertEqual(len(rows), len(entries))
        self.assertEqual(list(rows[0]), ["number", "time", "kind", "device", "who", "motion", "details"])
        ended, entry = rows[0], entries[0]
        self.assertEqual((ended["number"], ended["time"], ended["kind"]), (entry["number"], entry["time"], "MOTION_ENDED"))
        self.assertEqual((ended["device"], ended["motion"], ended["who"]), ("stage", "1", entry["caller"]["name"]))
        self.assertEqual(ended["details"], entry["details"], "quotation marks and commas, too")
        for words in (("--json", "history", "--csv"), ("history", "--csv", "--night"), ("history", "--night", "--axis", "1"),
                      ("history", "--motion", "1", "--limit", "1")):
            refused = self.daemon.run(*words)
            self.assertEqual(refused.returncode, 2, words)
            self.assertIn("excludes", refused.stderr)

    def test_new_entries_are_followed_over_restarts(self):
        follow = self.daemon.start("history", "--follow")
        self.addCleanup(follow.kill)
        self.assertIn("the daemon started", follow.next())
        self.run_well("move", "1=+100pulse", "--relative")
        self.assertIn("motion 1 (move of axis 1) SUCCEEDED", follow.until("motion 1 .*SUCCEEDED"))
        self.daemon.stop()
        self.start()
        self.assertIn("the daemon ended", follow.until("the daemon "))
        self.assertIn("the daemon started", follow.until("the daemon "))
        self.daemon.stop()
        for suffix in ("", "-wal", "-shm"):
            with contextlib.suppress(FileNotFoundError):
                os.remove(self.journal + suffix)
        self.start()
        follow.until("the daemon started")  # the first entry of a new journal
        self.run_well("home", "2")
        follow.until("home of axis 2.*SUCCEEDED")

    def test_what_is_followed_is_filtered(self):
        follow = self.daemon.start("--json", "history", "--follow", "--outcome", "succeeded")
        self.addCleanup(follow.kill)
        for number in (1, 2):
            self.run_well("move", "1=+100pulse", "--relative")
            self.assertEqual(json.loads(follow.next())["motion"], f"devices/stage/motions/{number}")

    def lose_the_line(self):
        self.run_well("sim", "unplug", "3600")
        self.wait_for_link("DOWN")
        self.run_well("sim", "unplug", "0")
        self.wait_for_link("UP")

    def wait_for_link(self, state):
        deadline = time.monotonic() + LIMIT_S
        while f"  {state}" not in self.run_well("devices"):
            self.assertLess(time.monotonic(), deadline, f"the link does not get {state}")
            time.sleep(0.02)  # between two looks; the deadline above decides

    def test_a_night_on_one_screen(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("move", "1=+100pulse", "--relative")
        self.run_well("home", "2")
        self.assertEqual(self.daemon.run("move", "3=1000mm").returncode, 1)
        self.run_well("stop")
        self.lose_the_line()
        self.daemon.kill()
        self.start()
        night = self.run_well("history", "--night")
        clock = r"(\d\d-\d\d )?\d\d:\d\d"
        who = r"unix \S+"
        self.assertRegex(night, r"^since \d{4}-\d\d-\d\d 18:00:00[+-]\d\d:\d\d\n")
        self.assertRegex(night, rf"(?m)^{clock}( to {clock})? {who}: 3 moves \(1 FAILED\), 1 homing$")
        self.assertRegex(night, rf"(?m)^stop of stage by {who} at {clock}$")
        self.assertRegex(night, rf"(?m)^stage: link lost at {clock} for \d+(\.\d)? s$")
        self.assertRegex(night, rf"(?m)^the daemon started at {clock}\n(.*\n)*"
                                rf"the daemon was killed; it started again at {clock}$")
        night, = (json.loads(line) for line in self.run_well("--json", "history", "--night", "--hours", "1").splitlines())
        self.assertEqual([start["after_unclean_end"] for start in night["daemon_starts"]], [False, True])
        self.assertEqual(len(night["link_losses"]), 1)

    def test_a_night_without_anything(self):
        with sqlite3.connect(self.journal) as database:
            database.execute("UPDATE entry SET time_us = time_us - 3 * 86400 * 1000000")
        database.close()
        self.assertEqual(self.run_well("history", "--night", "--hours", "1").splitlines()[1:], ["nothing happened"])

    def rows_of_motions(self, *words):
        head, *rows = self.run_well("motions", *words).splitlines()
        self.assertEqual(head.split(), ["number", "kind", "axes", "state", "who", "started", "ended"])
        return rows

    def test_the_motions_that_the_daemon_has(self):
        self.assertEqual(self.run_well("motions"), "no motions\n")
        for _ in range(21):
            self.run_well("move", "2=+1pulse", "--relative")
        self.run_well("move", "1=15mm", "--speed", "10um/s", "--no-wait")
        rows = self.rows_of_motions()
        self.assertEqual([row.split()[0] for row in rows], [str(number) for number in range(2, 23)])
        self.assertRegex(rows[0], r"^2 +move +2 +SUCCEEDED +unix \S+ +\S+ \S+ +\d{4}-\S+ \S+$")
        self.assertRegex(rows[-1], r"^22 +move +1 +RUNNING +unix \S+ +\S+ \S+ +for \d+(\.\d)? s$")
        self.assertEqual(len(self.rows_of_motions("--all")), 22)
        motions = [json.loads(line) for line in self.run_well("--json", "motions").splitlines()]
        self.assertEqual(len(motions), 21)
        self.assertEqual(motions[-1]["state"], "MOTION_STATE_RUNNING")

    def test_a_motion_is_cancelled(self):
        for name in ("1", "devices/stage/motions/2"):
            self.run_well("move", "1=15mm", "--speed", "10um/s", "--no-wait")
            self.assertRegex(self.run_well("cancel", name), r"^motion [12] \(move\) STOPPED; axis 1 at \d+(\.\d+)? um$")
        self.assertRegex(self.run_well("cancel", "2"), r"^motion 2 \(move\) had ended before: STOPPED; axis 1 at ")
        self.assertEqual(json.loads(self.run_well("--json", "cancel", "2"))["motion"]["state"], "MOTION_STATE_STOPPED")
        self.assertEqual(self.daemon.run("cancel", "99").returncode, 3)
        refused = self.daemon.run("cancel", "x")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("'x' is no motion", refused.stderr)

    def test_a_cancelled_motion_whose_end_is_not_seen(self):
        self.run_well("move", "1=15mm", "--speed", "10um/s", "--no-wait")
        self.run_well("sim", "unplug", "3600")
        cancelled = self.daemon.run("cancel", "1")
        self.assertEqual(cancelled.returncode, 1, cancelled.stdout)
        self.assertIn("UNKNOWN", cancelled.stderr)

    def test_a_changed_entry_is_found_out(self):
        self.run_well("move", "1=+100pulse", "--relative")
        head = re.search(r"(?m)^head (\S+)$", self.run_well("audit", "verify"))[1]
        self.run_well("audit", "verify", "--head", head)
        self.daemon.stop()
        with sqlite3.connect(self.journal) as database:
            database.execute("UPDATE entry SET body = '{}' WHERE number = 2")
        database.close()
        self.start()
        found = self.daemon.run("audit", "verify")
        self.assertEqual(found.returncode, 1, found.stdout)
        self.assertRegex(found.stdout, r"^entry 2: it or its place was changed")

    def test_a_damaged_index_is_found_out(self):
        self.run_well("move", "1=+100pulse", "--relative")
        self.daemon.stop()
        with sqlite3.connect(self.journal) as database:
            page, = database.execute("SELECT rootpage FROM sqlite_schema WHERE name = 'entry_by_motion'").fetchone()
        database.close()
        with open(self.journal, "r+b") as file:
            file.seek((page - 1) * 4096 + 3)
            file.write(b"\0\0")  # the number of its cells
        self.start()
        found = self.daemon.run("audit", "verify")
        self.assertEqual(found.returncode, 1, found.stdout)
        self.assertRegex(found.stdout, r"\A\d+ entries are as they were written\nthe file is damaged elsewhere, mostly in an index")
        self.assertIn("sqlite3 journal.sqlite REINDEX", found.stdout)

    def test_what_is_no_head_is_refused(self):
        for text in ("x", "a:b:c", "a:1:zz"):
            refused = self.daemon.run("audit", "verify", "--head", text)
            self.assertEqual(refused.returncode, 2, text + refused.stdout)
            self.assertIn("is no head of a journal", refused.stderr)

    def spoil_the_journal(self):
        self.daemon.stop()
        with sqlite3.connect(self.journal) as database:
            database.execute("PRAGMA user_version = 99")
        database.close()

    def test_a_journal_that_cannot_be_opened_refuses_what_moves_and_no_stop(self):
        self.spoil_the_journal()
        self.start()
        for words in (["move", "1=+100pulse", "--relative"], ["history"], ["audit", "verify"]):
            refused = self.daemon.run(*words)
            self.assertEqual(refused.returncode, 4, refused.stdout)
            self.assertRegex(refused.stderr, rf"JOURNAL_UNAVAILABLE.*{re.escape(self.journal)}: a newer version of "
                                             r"axisgated has written it .*then restart the daemon")
        self.run_well("stop")
        self.assertRegex(self.daemon.metrics_page(), r"(?m)^axisgate_journal_available 0$")
        self.assertRegex(self.daemon.log(), "could not be opened, so motions and changes are refused: .*newer version")

    def test_a_journal_that_cannot_be_opened_holds_nothing_up_where_the_configuration_says_so(self):
        self.spoil_the_journal()
        self.start(extra='[journal]\nunavailable = "act"\n')
        self.run_well("move", "1=+100pulse", "--relative")
        self.assertRegex(self.daemon.metrics_page(), r"(?m)^axisgate_journal_available 0$")


if __name__ == "__main__":
    unittest.main()
