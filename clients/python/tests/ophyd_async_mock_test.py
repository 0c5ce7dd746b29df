"""Devices of ophyd-async without a daemon. Skipped without ophyd-async."""

import asyncio
import unittest

from axisgate import Stopped
from ophyd_async_test import EngineTest, RunEngine

if RunEngine is not None:
    from bluesky import plans
    from bluesky.run_engine import call_in_bluesky_event_loop
    from ophyd_async.core import NotConnectedError, init_devices
    from axisgate.ophyd_async import StageAxis, StageConnection


@unittest.skipIf(RunEngine is None, "ophyd-async is not installed")
class WithoutDaemon(EngineTest, unittest.TestCase):
    def setUp(self):
        self.make_engine()

    def test_mock(self):
        with init_devices(mock=True):
            x = StageAxis(StageConnection("/nowhere.sock"), "x")
        self.engine(plans.scan([], x, 0, 1, 3))
        self.assertEqual(self.events("x"), [(0,), (0.5,), (1,)])
        self.documents.clear()
        self.engine(plans.rel_scan([], x, 0, 1, 2))
        self.assertEqual(self.events("x"), [(1,), (2,)])

        async def stopped(success):
            status = x.set(5)
            await asyncio.sleep(0)
            await x.stop(success=success)
            await status
        call_in_bluesky_event_loop(stopped(True))
        with self.assertRaises(Stopped):
            call_in_bluesky_event_loop(stopped(False))

    def test_no_daemon(self):
        with self.assertRaises(NotConnectedError) as caught:
            with init_devices(timeout=1):
                x = StageAxis(StageConnection("/nowhere.sock"), "x")  # noqa: F841
        self.assertIn("UNAVAILABLE", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
