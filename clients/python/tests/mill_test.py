"""Jobs of a simulated mill, with the real daemon."""

import unittest

from axisgate import Mill, Refused, Stage, mm
from axisgate.v1 import mill_pb2
from daemon import DaemonTest, Relay, wait_until

MILL = """
[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
tools = ["T1", "T2"]
[[device.origin]]
name = "vice"
x = 400
y = 400
"""
TRACES = b"PA;PA;VS4;!VZ4;!PZ-4,80;!MC1;PU80,80;PD80,80,120,80,120,120,80,120,80,80;PU;!MC0;\n"
OUTLINE = b"PA;PA;VS4;!VZ4;!PZ-23,80;!MC1;PU40,40;PD40,40,160,40;PU;!MC0;\n"


class Jobs(DaemonTest):
    more = MILL

    def setUp(self):
        super().setUp()
        self.mill = Mill(self.daemon.socket)
        self.addCleanup(self.mill.close)
        wait_until(lambda: self.mill.read().line_open, "the line of the mill")

    def state(self, job):
        found = [one.state for one in self.mill.jobs() if one.name == job.name]
        return mill_pb2.JobState.Name(found[0])[len("JOB_STATE_"):] if found else ""

    def run_part(self, job, state):
        self.mill.start(self.mill.confirm(next(one for one in self.mill.jobs() if one.name == job.name)))
        wait_until(lambda: self.state(job) == state, f"the state {state}")

    def test_finds_devices_by_what_they_can_do(self):
        self.assertEqual((self.mill.name, Mill.find(self.daemon.socket)), ("mill", ["mill"]))
        self.assertEqual(Stage.find(self.daemon.socket), ["stage"])

    def test_job_in_two_parts(self):
        job = self.mill.send(TRACES, OUTLINE, title="board", tools=("T1", "T2"), origin="vice",
                             accepted_warnings=("drags-tool",), stock=(50 * mm, 50 * mm, 2 * mm))
        self.assertEqual([(part.tool, part.bytes) for part in job.parts], [("T1", len(TRACES)), ("T2", len(OUTLINE))])
        self.run_part(job, "TOOL_CHANGE")
        self.run_part(job, "FED")
        self.mill.report_done(job)
        self.assertEqual(self.mill.jobs(), [])

    def test_faulty_job(self):
        with self.assertRaises(Refused) as caught:
            self.mill.send(b"G1 X10\n", title="a", tools=("T1",))
        self.assertEqual(caught.exception.reason, "INVALID_REQUEST")
        self.assertRaises(ValueError, self.mill.send, TRACES, title="a", tools=("T1", "T2"))

    def test_cancel_and_abort(self):
        job = self.mill.send(TRACES, title="a", tools=("T1",), origin="vice", accepted_warnings=("drags-tool",))
        self.mill.cancel(job)
        self.assertEqual(self.state(job), "")
        self.mill.abort()

    def test_lost_answer_queues_once(self):
        relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(relay.end)
        with Mill(relay.socket) as mill:
            relay.cut_answers(stream=3, times=2)
            mill.send(TRACES, title="a", tools=("T1",), origin="vice", accepted_warnings=("drags-tool",))
        self.assertEqual((relay.cuts, len(self.mill.jobs())), (2, 1))

    def test_by_hand(self):
        self.assertGreater(self.mill.step(x=1 * mm, z=-0.5 * mm), 0)
        states = self.mill.watch()
        self.assertTrue(next(states).line_open)
        states.close()


if __name__ == "__main__":
    unittest.main()
