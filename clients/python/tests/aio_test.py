"""The asyncio form, with the real daemon."""

import asyncio
import contextlib
import signal
import subprocess
import sys
import unittest
from unittest import mock

from axisgate import (LeaseHeld, LeaseLost, OutcomeUnknown, OutsideTravel, Refused, Stopped, StoppedBy, Unavailable, mm,
                      s, um)
from axisgate.aio import Stage
from daemon import DaemonTest, Relay, wait_until


class AioTest(DaemonTest):
    """A test whose coroutine `check` functions run in a loop of their own, which no task of the package survives."""

    def run_with_stage(self, check, target=None):
        async def run():
            before = asyncio.all_tasks()
            async with Stage(target or self.daemon.socket) as stage:
                await asyncio.wait_for(check(stage), 60)
            await self.until_no_task_is_left(before)
        asyncio.run(run())

    async def until_no_task_is_left(self, before):
        """The tasks of gRPC end some steps of the loop after their calls."""
        left = set()
        for _ in range(200):
            left = {task for task in asyncio.all_tasks() - before if not task.done()}
            if not left:
                return
            await asyncio.sleep(0.05)  # between two looks; the loop decides
        self.fail(f"left after close(): {left}")

    async def another(self):
        with mock.patch("axisgate._target.SESSION", "another-program"):
            return await Stage(self.daemon.address()).connect()


class Moves(AioTest):
    def test_moves(self):
        async def check(stage):
            self.assertEqual(str(await stage["x"].move_to(1.5 * mm)), "x 1.5 mm")
            self.assertEqual(str(await stage.move_by(x=-0.5 * mm, y=100 * um)), "x 1 mm, y 0.1 mm")
            self.assertEqual((await stage["x"].position).pulses, await stage["x"].pulses)
            self.assertEqual(await stage["x"].limits, (mm("-15"), mm("15")))
            self.assertEqual([axis.name for axis in stage.axes], ["x", "y", "3"])
            self.assertEqual((await stage.whoami())[1], "admin")
            self.assertEqual(len(await stage.motions()), 2)
            with self.assertRaises(OutsideTravel):
                await stage.check(x=20 * mm)
        self.run_with_stage(check)

    def test_homes_only_if_needed(self):
        async def check(stage):
            self.assertEqual(str(await stage["x"].home()), "x 0 mm")
            self.assertEqual((await stage.home("x", if_needed=True)).positions, {})
        self.run_with_stage(check)

    def test_starts_homing(self):
        async def check(stage):
            self.assertEqual(str(await (await stage.start_home("x")).wait()), "x 0 mm")
        self.run_with_stage(check)

    def test_axes_are_unknown_after_a_restart(self):
        async def check(stage):
            self.daemon.restart_without_controller()
            for unknown in (stage.home("x", if_needed=True), stage.home(if_needed=True), stage["x"].position):
                with self.assertRaises(Unavailable) as caught:
                    await unknown
                self.assertEqual(caught.exception.reason, "LINK_DOWN")
        self.run_with_stage(check)

    def test_path_and_scan(self):
        async def check(stage):
            points = ((0.1 * i * mm, 0.05 * i * mm) for i in range(1, 11))
            path = await stage.path(points, "xy", speed=0.5 * mm / s)
            self.assertEqual(str(await path.wait()), "x 1 mm, y 0.5 mm")
            self.assertTrue(await path.done)
            scan = await stage.scan("x", 0 * mm, 1 * mm, every=100 * um, speed=0.2 * mm / s)
            fractions = [progress.fraction async for progress in scan.progress()]
            self.assertGreater(len(fractions), 1)
            result = (await scan.result).scan
            self.assertEqual((result.expected_in_range, result.observed), (11, result.expected))
            seen = [str(result) async for result in stage.visit([(0.1 * mm, 0 * mm), (0.2 * mm, 0.1 * mm)], "xy")]
            self.assertEqual(seen, ["x 0.1 mm, y 0 mm", "x 0.2 mm, y 0.1 mm"])
            with self.assertRaises(ValueError):
                await stage.visit([(1 * mm, 1 * mm, 1 * mm)], "xy").__anext__()
        self.run_with_stage(check)

    def test_stops(self):
        async def check(stage):
            motion = await stage.start(x=14 * mm)
            with self.assertRaises(TimeoutError):
                await motion.wait(0.2)
            self.assertFalse((await stage.stop()).stays_open)
            with self.assertRaises(Stopped):
                await motion.wait()
            other = await self.another()
            motion = await stage.start(x=14 * mm)
            await other.stop("x")
            await other.close()
            with self.assertRaises(StoppedBy):
                await stage["x"].move_to(0 * mm)
            self.assertEqual(await stage.rearm(), (1,))
            await stage.emergency_stop()
            with self.assertRaises(Refused):
                await stage["x"].move_to(0 * mm)
            await stage.clear_errors()
        self.run_with_stage(check)

    def test_failed_block_cancels(self):
        async def check(stage):
            motion = await stage.start(x=14 * mm)
            with self.assertRaises(ZeroDivisionError):
                async with motion:
                    raise ZeroDivisionError
            with self.assertRaises(Stopped):
                await motion.wait()
        self.run_with_stage(check)


class Cancelled(AioTest):
    def test_cancelled_task_cancels_its_motion(self):
        async def check(stage):
            with self.assertRaises(asyncio.TimeoutError):
                await asyncio.wait_for(stage["x"].move_to(14 * mm), 0.5)
            with self.assertRaises(Stopped):
                await (await stage.motions())[0].wait()
        self.run_with_stage(check)

    def test_cancelled_before_the_answer(self):
        relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(relay.end)

        async def check(stage):
            relay.cut_answers(stream=3, times=2)  # stream 1 asks for the request memory
            moving = asyncio.ensure_future(stage["x"].move_to(14 * mm))
            while not relay.cuts:
                await asyncio.sleep(0.01)
            moving.cancel()
            with self.assertRaises(asyncio.CancelledError):
                await moving
            with self.assertRaises(Stopped):
                await (await stage.motions())[0].wait()
        self.run_with_stage(check, relay.socket)

    def test_cancelled_wait_stops_nothing(self):
        async def check(stage):
            motion = await stage.start(x=0.5 * mm)
            waiting = asyncio.ensure_future(motion.wait())
            await asyncio.sleep(0.1)
            waiting.cancel()
            self.assertEqual(str(await motion.wait()), "x 0.5 mm")
        self.run_with_stage(check)

    def test_cancelled_iteration_continues(self):
        async def check(stage):
            async with stage.events() as events:
                with self.assertRaises(asyncio.TimeoutError):
                    await asyncio.wait_for(events.__anext__(), 0.3)
                await stage["x"].move_to(0.1 * mm)
                seen = []
                async for event in events:
                    seen.append(event.revision)
                    if event.kind == "motion" and event.fact.HasField("end_time"):
                        break
                self.assertEqual(seen, list(range(seen[0], seen[0] + len(seen))))
        self.run_with_stage(check)


    def test_ctrl_c(self):
        program = ("import asyncio, signal, sys\nfrom axisgate import mm\nfrom axisgate.aio import Stage\n"
                   "signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it\n"
                   "async def main():\n"
                   "    async with Stage(sys.argv[1]) as stage:\n"
                   "        print('moves', flush=True)\n"
                   "        await stage['x'].move_to(14 * mm)\n"
                   "asyncio.run(main())")
        process = subprocess.Popen([sys.executable, "-c", program, self.daemon.socket], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.__exit__, None, None, None)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), "moves\n")
        stage = self.open()
        wait_until(lambda: stage.motions(), "the motion")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        self.assertTrue(errors.endswith("KeyboardInterrupt\n"), errors)
        self.assertRaises(Stopped, stage.motions()[0].wait)


class LostAnswers(AioTest):
    def setUp(self):
        super().setUp()
        self.relay = Relay(self.folder, self.daemon.socket)
        self.addCleanup(self.relay.end)

    def test_the_motion_of_the_first_request_is_adopted(self):
        async def check(stage):
            self.relay.cut_answers(stream=3, times=3)
            self.assertEqual(str(await stage.move_by(x=1 * mm)), "x 1 mm")
            self.assertEqual((self.relay.cuts, len(await stage.motions())), (3, 1))
        self.run_with_stage(check, self.relay.socket)

    def test_without_an_answer_the_outcome_is_unknown(self):
        async def check(stage):
            self.relay.cut_answers(stream=3, times=1000)
            with self.assertRaises(OutcomeUnknown):
                await stage.move_by(x=1 * mm)
        self.run_with_stage(check, self.relay.socket)


class Leases(AioTest):
    def test_calls_inside_carry_the_lease(self):
        async def check(stage):
            other = await self.another()
            async with stage.lease("x", ttl=1) as lease:
                self.assertEqual(lease.axes, (1,))
                await asyncio.sleep(2)
                await asyncio.gather(stage["x"].move_to(0.1 * mm))
                with self.assertRaises(LeaseHeld):
                    await other["x"].move_to(0 * mm)
            await other["x"].move_to(0 * mm)
            await other.close()
        self.run_with_stage(check)

    def test_lost_lease(self):
        async def check(stage):
            lost = asyncio.Event()
            async with stage.lease("x", ttl=1) as lease:
                lease.on_lost(lambda _: lost.set())
                self.daemon.kill()
                self.daemon.start()
                await asyncio.wait_for(lost.wait(), 10)
                with self.assertRaises(LeaseLost):
                    await stage["x"].move_to(1 * mm)
        self.run_with_stage(check)

    def test_hand_over(self):
        async def check(stage):
            other = await self.another()
            lease = await stage.lease("x").acquire()
            waiting = asyncio.ensure_future(other.lease("x", wait=20).acquire())
            name = (await other.whoami())[0]
            while not waiting.done():
                with contextlib.suppress(Refused):
                    await lease.hand_over(name)
                await asyncio.sleep(0.05)
            await (await waiting).release()
            await other.close()
        self.run_with_stage(check)


class Jogs(AioTest):
    def test_jog_ends_with_its_block(self):
        async def check(stage):
            async with stage.jog(x=-200 * um / s) as jog:
                await asyncio.sleep(1)
            self.assertLess(jog.result.positions["x"].value, 0)
            with self.assertRaises(Refused):
                async with stage.jog(x=1000 * mm / s):
                    self.fail("the block of a refused jog runs")
        self.run_with_stage(check)

    def test_cancelled_jog(self):
        async def check(stage):
            async def run():
                async with stage.jog(x=200 * um / s):
                    await asyncio.sleep(60)
            with self.assertRaises(asyncio.TimeoutError):
                await asyncio.wait_for(run(), 0.5)
            self.assertTrue(await (await stage.motions())[0].done)
        self.run_with_stage(check)


class Watching(AioTest):
    def test_watch(self):
        async def check(stage):
            async with stage.watch() as states:
                self.assertEqual((await states.__anext__()).link, "UP")
                motion = await stage.start(x=1 * mm)
                async for state in states:
                    if state.axes["x"].moving:
                        break
                await motion.wait()
        self.run_with_stage(check)

    def test_events_resume_over_a_restart(self):
        async def check(stage):
            async with stage.events() as events:
                await stage["x"].move_to(0.1 * mm)
                self.daemon.kill()
                self.daemon.start()
                await stage["x"].move_to(0.2 * mm)
                revisions, ends = [], 0
                while ends < 2:
                    event = await events.__anext__()
                    revisions.append(event.revision)
                    ends += event.kind == "motion" and event.fact.HasField("end_time")
                self.assertEqual(revisions, sorted(set(revisions)))
        self.run_with_stage(check)


class Loops(AioTest):
    def test_nothing_is_left_in_the_middle_of_everything(self):
        async def check(stage):
            motion = await stage.start(x=14 * mm)
            called = []
            motion.add_done_callback(called.append)
            await stage.lease("y").acquire()
            await stage.events().__aenter__()
            waiting = asyncio.ensure_future(motion.wait())
            await asyncio.sleep(0.2)
            await stage.close()
            with self.assertRaisesRegex(RuntimeError, "closed"):
                await waiting
            self.assertEqual(called, [motion])
            with self.assertRaisesRegex(RuntimeError, "closed"):
                await stage.status()
        self.run_with_stage(check)

    def test_another_loop(self):
        stages = []

        async def open_one():
            stages.append(await Stage(self.daemon.socket).connect())

        async def use():
            with self.assertRaisesRegex(RuntimeError, "another event loop"):
                await stages[0].status()
            with self.assertRaisesRegex(RuntimeError, "another event loop"):
                await stages[0].stop()
        loop = asyncio.new_event_loop()
        self.addCleanup(loop.close)
        loop.run_until_complete(open_one())
        asyncio.run(use())
        loop.run_until_complete(stages[0].close())

    def test_not_open(self):
        async def check():
            stage = Stage(self.daemon.socket)
            with self.assertRaisesRegex(RuntimeError, "not open"):
                await stage.status()
            self.assertEqual(await Stage.find(self.daemon.socket), ["stage"])
            with self.assertRaises(LookupError):
                await Stage(self.daemon.socket, device="other").connect()
            self.daemon.kill()
            with self.assertRaises(Unavailable):
                await Stage(self.daemon.socket).connect()
        asyncio.run(check())


if __name__ == "__main__":
    unittest.main()
