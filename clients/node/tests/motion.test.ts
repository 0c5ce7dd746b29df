// Motions, refusals, stops and lost answers, with the real daemon.
import assert from "node:assert/strict";
import { test, type TestContext } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import {
  AxisgateError,
  mm,
  type Motion,
  MotionFailed,
  OutcomeUnknown,
  OutsideTravel,
  pulses,
  Refused,
  Stage,
  Stopped,
  StoppedBy,
  um,
  Unavailable,
} from "axisgate";

import { Daemon, Relay, until } from "./daemon.js";

async function connected(t: TestContext): Promise<[Stage, Daemon]> {
  const daemon = await Daemon.of(t);
  return [await daemon.connect(t), daemon];
}

/** Starts a long motion. */
async function moving(t: TestContext): Promise<[Motion, Stage, Daemon]> {
  const [stage, daemon] = await connected(t);
  return [await stage.start({ x: mm("14") }), stage, daemon];
}

test("moves", async (t) => {
  const [stage] = await connected(t);
  const x = stage.axis("x");

  await t.test("to a position", async () => {
    const result = await x.moveTo(mm("1.5"));
    assert.equal(String(result), "x 1.5 mm");
    assert.equal(result.positions.get("x")?.pulses, 150000n);
    assert.ok(result.durationMs > 0);
  });

  await t.test("axes together by displacements", async () => {
    await stage.moveTo({ x: mm(1n), y: um("-100") });
    assert.equal(String(await stage.moveBy({ x: mm(0.1 + 0.2), y: pulses(5n) })), "x 1.3 mm, y -0.09995 mm");
  });

  await t.test("numbers are rounded, and inexact decimals refused", async () => {
    assert.equal((await x.moveTo(mm(0.123456789))).positions.get("x")?.pulses, 12346n);
    await assert.rejects(x.moveTo(mm("0.123456789")), (error) => {
      return error instanceof Refused && error.reason === "NOT_REPRESENTABLE";
    });
  });

  await t.test("a refusal names what is wrong with the target", async () => {
    const { length } = await stage.motions();
    await assert.rejects(x.moveTo(mm("20")), (error) => {
      assert.ok(error instanceof OutsideTravel);
      assert.deepEqual([error.reason, error.axis, error.code], ["OUTSIDE_TRAVEL", 1, "OUT_OF_RANGE"]);
      return error.hint !== "" && String(error).includes(error.hint);
    });
    await assert.rejects(stage.check({ x: mm("20") }), OutsideTravel);
    await stage.check({ x: mm("1") });
    assert.equal((await stage.motions()).length, length);
  });

  await t.test("axes have names and numbers", async () => {
    assert.deepEqual(
      stage.axes.map((axis) => axis.name),
      ["x", "y", "3"],
    );
    assert.equal(stage.axis(1), x);
    assert.throws(() => stage.axis("z"), RangeError);
    const { minimum, maximum } = await x.state();
    assert.deepEqual([String(minimum), String(maximum)], ["-15 mm", "15 mm"]);
    assert.equal(String(await x.position()), "x 0.12346 mm");
  });

  await t.test("homing only if needed", async () => {
    assert.equal(String(await stage.home(["x"])), "x 0 mm");
    assert.equal((await x.home({ ifNeeded: true })).positions.size, 0);
    assert.deepEqual([...(await stage.home([], { ifNeeded: true })).positions.keys()], ["y", "3"]);
  });

  await t.test("a scan counts its trigger pulses", async () => {
    const motion = await stage.scan("x", mm("0"), mm("1"), { every: um("100"), speed: mm("0.2").perSecond });
    const { scan } = await motion.wait();
    assert.equal(scan?.expectedInRange, 11n);
    assert.equal(scan.observed, scan.expected);
  });

  await t.test("the names of the stages", async () => {
    const target = { target: (await connected(t))[1].socket };
    assert.deepEqual(await Stage.find(target), ["stage"]);
    await assert.rejects(Stage.connect({ ...target, device: "other" }), RangeError);
  });
});

test("a time limit stops nothing", async (t) => {
  const [motion] = await moving(t);
  await assert.rejects(motion.wait({ timeoutMs: 200 }), { name: "TimeoutError" });
  await assert.rejects(motion.wait({ signal: AbortSignal.timeout(200) }), { name: "TimeoutError" });
  assert.equal(motion.state, "RUNNING");
  assert.equal(await motion.isDone(), false);
});

test("a stop by the same program latches nothing", async (t) => {
  const [motion, stage] = await moving(t);
  const report = await stage.axis("x").stop();
  assert.equal(report.staysOpen, false);
  assert.equal(report.axes[0]?.stationary, true);
  await assert.rejects(motion.wait(), Stopped);
  await stage.moveTo({ x: mm("0") });
});

test("a motion is cancelled", async (t) => {
  const [motion] = await moving(t);
  await motion.cancel();
  await assert.rejects(motion.wait(), Stopped);
});

test("a block cancels its motion", async (t) => {
  const [first, stage] = await moving(t);
  await first.cancel();
  await assert.rejects(first.wait(), Stopped);
  let seen: Motion;
  {
    await using motion = await stage.start({ x: mm("-14") });
    seen = motion;
  }
  await assert.rejects(seen.wait(), Stopped);
});

test("after a stop by another caller, rearm() allows motion", async (t) => {
  const [motion, stage, daemon] = await moving(t);
  const other = await daemon.connectAsOther(t);
  await other.stop(["x"]);
  await assert.rejects(motion.wait(), Stopped);
  await assert.rejects(stage.moveTo({ x: mm("0") }), (error) => {
    return error instanceof StoppedBy && error.hint.includes("stage.rearm()");
  });
  assert.deepEqual(await stage.rearm(), [1]);
  await stage.moveTo({ x: mm("0") });
});

test("an emergency stop needs clearErrors()", async (t) => {
  const [motion, stage] = await moving(t);
  await stage.emergencyStop();
  await assert.rejects(motion.wait(), AxisgateError);
  await assert.rejects(stage.moveTo({ x: mm("0") }), (error) => {
    return error instanceof Refused && error.reason === "EMERGENCY_STOPPED" && error.hint.includes("clearErrors()");
  });
  await stage.clearErrors();
});

test("an aborted move is cancelled", async (t) => {
  const [stage] = await connected(t);
  const controller = new AbortController();
  const move = stage.axis("x").moveTo(mm("14"), { signal: controller.signal });
  await until(async () => (await stage.motions()).length > 0, "a motion");
  controller.abort();
  await assert.rejects(move, { name: "AbortError" });
  const [motion] = await stage.motions();
  await assert.rejects(motion?.wait() ?? Promise.resolve(), Stopped);
});

test("a move whose signal was aborted before is not sent", async (t) => {
  const [stage] = await connected(t);
  await assert.rejects(stage.moveTo({ x: mm("1") }, { signal: AbortSignal.abort() }), { name: "AbortError" });
  assert.deepEqual(await stage.motions(), []);
});

test("the motion of a lost answer is adopted", async (t) => {
  const [direct, daemon] = await connected(t);
  const relay = await Relay.of(t, daemon);
  const stage = await daemon.connect(t, { target: relay.socket });
  relay.cutAnswers(3, 3); // stream 1 asks for the request memory
  assert.equal(String(await stage.moveBy({ x: mm("1") })), "x 1 mm");
  assert.equal(relay.cuts, 3);
  assert.equal((await direct.motions()).length, 1);
});

test("an aborted move whose answer was lost is cancelled", async (t) => {
  const [direct, daemon] = await connected(t);
  const relay = await Relay.of(t, daemon);
  const stage = await daemon.connect(t, { target: relay.socket });
  relay.cutAnswers(3, 1);
  const controller = new AbortController();
  const move = stage.moveTo({ x: mm("14") }, { signal: controller.signal });
  await until(() => relay.cuts === 1, "a cut");
  controller.abort();
  await assert.rejects(move, { name: "AbortError" });
  const [motion] = await direct.motions();
  await assert.rejects(motion?.wait() ?? Promise.resolve(), Stopped);
});

test("without an answer the outcome is unknown", async (t) => {
  const [direct, daemon] = await connected(t);
  const relay = await Relay.of(t, daemon);
  const stage = await daemon.connect(t, { target: relay.socket, timeoutMs: 4000 });
  relay.cutAnswers(3, 1000);
  await assert.rejects(stage.moveBy({ x: mm("1") }), OutcomeUnknown);
  assert.equal((await direct.motions()).length, 1);
});

test("waiting survives broken connections", async (t) => {
  const [, daemon] = await connected(t);
  const relay = await Relay.of(t, daemon);
  const stage = await daemon.connect(t, { target: relay.socket });
  const motion = await stage.start({ x: mm("10") });
  relay.cutAnswers(5, 3);
  assert.equal(String(await motion.wait()), "x 10 mm");
  assert.equal(relay.cuts, 3);
});

test("a daemon without a journal is not asked again", async (t) => {
  const daemon = await Daemon.of(t, { journal: false });
  const relay = await Relay.of(t, daemon);
  const stage = await daemon.connect(t, { target: relay.socket });
  relay.cutAnswers(3);
  await assert.rejects(stage.moveBy({ x: mm("1") }), OutcomeUnknown);
  assert.equal((await (await daemon.connect(t)).motions()).length, 1);
});

test("the cable is unplugged", async (t) => {
  const [motion, , daemon] = await moving(t);
  await daemon.atStage("unplug 60");
  await assert.rejects(motion.wait(), OutcomeUnknown);
});

test("a limit sensor ends a motion", async (t) => {
  const [motion, , daemon] = await moving(t);
  await daemon.atStage("limit 1 cw on");
  await assert.rejects(motion.wait(), (error) => {
    return error instanceof MotionFailed && error.reason === "LIMIT_DETECTED";
  });
});

test("the daemon is killed during a motion", async (t) => {
  const [motion, stage, daemon] = await moving(t);
  await sleep(300);
  await daemon.kill();
  await daemon.start();
  await assert.rejects(motion.wait(), OutcomeUnknown);
  await until(async () => (await stage.status()).message.openStops.length === 0, "the stop after the restart");
  await stage.moveTo({ x: mm("0") });
});

test("the daemon is killed before a motion", async (t) => {
  const daemon = await Daemon.of(t);
  const stage = await daemon.connect(t, { timeoutMs: 2000 });
  await daemon.kill();
  await assert.rejects(stage.moveTo({ x: mm("1") }), Unavailable);
  await assert.rejects(stage.stop(), (error) => {
    return error instanceof OutcomeUnknown && error.message.startsWith("the stop was not delivered");
  });
  await assert.rejects(Stage.connect({ target: daemon.socket }), (error) => {
    return error instanceof Unavailable && error.hint.includes("AXISGATE_TARGET");
  });
});

test("the daemon is started again before a motion", async (t) => {
  const [stage, daemon] = await connected(t);
  await daemon.kill();
  const [result] = await Promise.all([stage.moveTo({ x: mm("1") }), sleep(1000).then(() => daemon.start())]);
  assert.equal(String(result), "x 1 mm");
});

test("axes are unknown after a restart", async (t) => {
  const daemon = await Daemon.of(t);
  const stage = await daemon.connect(t);
  await daemon.restartWithoutController();
  const isDown = (error: unknown): boolean => error instanceof Unavailable && error.reason === "LINK_DOWN";
  await assert.rejects(stage.home([], { ifNeeded: true }), isDown);
  await assert.rejects(stage.axis("x").position(), isDown);
});
