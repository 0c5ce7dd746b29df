// Leases, jogs, events, paths and other calls, with the real daemon.
import assert from "node:assert/strict";
import { test, type TestContext } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import {
  Event,
  type Events,
  LeaseHeld,
  LeaseLost,
  mm,
  NotAllowed,
  OutsideTravel,
  Refused,
  type Stage,
  Stopped,
  um,
} from "axisgate";

import { Daemon, until } from "./daemon.js";

/** Connects two programs. */
async function two(t: TestContext): Promise<[Stage, Stage, Daemon]> {
  const daemon = await Daemon.of(t);
  return [await daemon.connect(t), await daemon.connectAsOther(t), daemon];
}

const reason = (wanted: string) => (error: unknown) => error instanceof Refused && error.reason === wanted;

test("calls inside a lease carry it", async (t) => {
  const [stage, other] = await two(t);
  {
    await using lease = await stage.lease(["x"], { purpose: "a test" });
    assert.deepEqual(lease.axes, [1]);
    await stage.moveTo({ x: mm("0.1") });
    await other.moveTo({ y: mm("0.1") });
    await assert.rejects(other.moveTo({ x: mm("0") }), (error) => {
      return error instanceof LeaseHeld && error.message.includes("a test");
    });
  }
  await other.moveTo({ x: mm("0") });
});

test("a lease is kept alive", async (t) => {
  const [stage] = await two(t);
  await using lease = await stage.lease(["x"], { ttlMs: 1000 });
  await sleep(3000);
  await stage.moveTo({ x: mm("0.1") });
  assert.equal(lease.lost, false);
});

test("a lost lease says so", async (t) => {
  const [stage, , daemon] = await two(t);
  await using lease = await stage.lease(["x"], { ttlMs: 1000 });
  await daemon.kill();
  await daemon.start();
  await until(() => lease.lost, "the loss");
  assert.ok(lease.lostSignal.reason instanceof LeaseLost);
  await assert.rejects(stage.moveTo({ x: mm("1") }), LeaseLost);
  await lease.release();
  await stage.moveTo({ x: mm("1") });
});

test("a lease is handed over", async (t) => {
  const [stage, other] = await two(t);
  const lease = await stage.lease(["x"]);
  const waiting = other.lease(["x"], { waitMs: 20_000 });
  const { name } = await other.whoami();
  await until(
    () =>
      lease.handOver(name).then(
        () => true,
        () => false,
      ),
    "a caller who waits",
  );
  await using held = await waiting;
  assert.deepEqual(held.axes, [1]);
  await assert.rejects(stage.moveTo({ x: mm("0") }), LeaseHeld);
});

test("a program inside `axisctl lease run` uses its lease", async (t) => {
  const [stage, , daemon] = await two(t);
  await using lease = await stage.lease(["x"]);
  process.env["AXISGATE_LEASE"] = Buffer.from(lease.token).toString("hex");
  t.after(() => delete process.env["AXISGATE_LEASE"]);
  await (await daemon.connect(t)).moveTo({ x: mm("0.1") });
});

test("a jog ends with its block", async (t) => {
  const [stage] = await two(t);
  const jog = await stage.jog({ x: um("-200").perSecond });
  await sleep(1000);
  const result = await jog.end();
  assert.ok(Number(result.positions.get("x")?.value) < 0);
  assert.equal(jog.motion.state, "SUCCEEDED");
});

test("a stop by another caller ends a jog", async (t) => {
  const [stage, other] = await two(t);
  const jog = await stage.jog({ x: um("200").perSecond });
  await other.stop();
  await assert.rejects(jog.end(), Stopped);
});

test("an aborted jog stops", async (t) => {
  const [stage] = await two(t);
  const controller = new AbortController();
  const jog = await stage.jog({ x: um("200").perSecond }, { signal: controller.signal });
  controller.abort();
  await assert.rejects(jog.motion.wait(), Stopped);
});

test("a jog is refused", async (t) => {
  const [stage] = await two(t);
  await assert.rejects(stage.jog({ x: mm("1000").perSecond }), reason("OUT_OF_RANGE"));
});

test("a path of a generator", async (t) => {
  const [stage] = await two(t);
  async function* points() {
    for (let at = 1; at <= 10; at++) {
      await sleep(1);
      yield [mm(0.1 * at), mm(0.05 * at)];
    }
  }
  const motion = await stage.path(points(), ["x", "y"], { speed: mm("0.5").perSecond });
  assert.equal(String(await motion.wait()), "x 1 mm, y 0.5 mm");
});

test("a path whose points cannot be computed moves nothing", async (t) => {
  const [stage] = await two(t);
  function* points() {
    yield [mm("0.1"), mm("0.1")];
    throw new SyntaxError("no point");
  }
  await assert.rejects(stage.path(points(), ["x", "y"]), SyntaxError);
  assert.deepEqual(await stage.motions(), []);
});

test("a refused path names its segment", async (t) => {
  const [stage] = await two(t);
  const points = [
    [mm("1"), mm("1")],
    [mm("20"), mm("1")],
  ];
  await assert.rejects(stage.path(points, ["x", "y"], { speed: mm("0.5").perSecond }), (error) => {
    return error instanceof OutsideTravel && error.message.includes("segment 2");
  });
});

test("points are visited one after another", async (t) => {
  const [stage] = await two(t);
  const seen: string[] = [];
  for await (const result of stage.visit([um("10"), um("30")], ["x"])) seen.push(String(result));
  assert.deepEqual(seen, ["x 0.01 mm", "x 0.03 mm"]);
});

async function nextEnd(events: Events): Promise<Event> {
  for await (const event of { [Symbol.asyncIterator]: () => ({ next: () => events.next() }) }) {
    if (event instanceof Event && event.fact.case === "motion" && event.fact.value.endTime) return event;
  }
  assert.fail("the events ended");
}

test("events resume over a restart of the daemon", async (t) => {
  const [stage, , daemon] = await two(t);
  await using events = await stage.events();
  await stage.moveTo({ x: mm("0.1") });
  const first = await nextEnd(events);
  await daemon.kill();
  await daemon.start();
  await stage.moveTo({ x: mm("0.2") });
  const second = await nextEnd(events);
  assert.ok(second.revision > first.revision);
  const kinds: unknown[] = [];
  for await (const event of await stage.events({ since: first })) {
    assert.ok(event instanceof Event);
    kinds.push(event.fact.case);
    if (event.revision === second.revision) break;
  }
  assert.ok(kinds.includes("daemonStarted"));
});

test("events resume before the first event", async (t) => {
  const [stage, , daemon] = await two(t);
  await using events = await stage.events();
  await daemon.kill();
  const started = sleep(1500).then(() => daemon.start());
  const { value } = await events.next();
  assert.ok(value instanceof Event && value.fact.case === "daemonStarted");
  await started;
});

test("states and progress", async (t) => {
  const [stage] = await two(t);
  const states = stage.watch();
  assert.equal((await states.next()).value?.link, "UP");
  const motion = await stage.start({ x: mm("1") });
  for await (const state of states) if (state.axes.get("x")?.moving) break;
  const fractions: number[] = [];
  for await (const { fraction } of motion.progress()) fractions.push(fraction ?? NaN);
  assert.deepEqual(
    fractions,
    fractions.toSorted((a, b) => a - b),
  );
  assert.ok(fractions.length > 0);
  await motion.wait();
});

test("an aborted watch rejects", async (t) => {
  const [stage] = await two(t);
  const states = stage.watch({ signal: AbortSignal.timeout(300) });
  await assert.rejects(
    async () => {
      for await (const state of states) assert.equal(state.link, "UP");
    },
    { name: "TimeoutError" },
  );
});

test("saved positions", async (t) => {
  const [stage] = await two(t);
  await stage.moveTo({ x: mm("0.5") });
  await stage.places.save("sample");
  await stage.moveTo({ x: mm("0") });
  assert.equal((await stage.places.moveTo("sample")).positions.get("x")?.pulses, 50000n);
  assert.deepEqual([...(await stage.places.read()).keys()], ["sample"]);
  await stage.places.delete("sample");
  assert.equal((await stage.places.read()).size, 0);
});

test("lines in the controller's own language", async (t) => {
  const [stage] = await two(t);
  const { answers, motion } = await stage.execute(["M:1+P1000", "G:1"]);
  assert.deepEqual(answers, ["OK", "OK"]);
  await motion?.wait();
  assert.equal((await stage.execute(["?:N"])).motion, undefined);
  assert.equal((await stage.axis("x").position()).pulses, 1000n);
  await assert.rejects(stage.execute(["NO:1"]), reason("UNKNOWN_COMMAND"));
});

test("settings", async (t) => {
  const [stage] = await two(t);
  await stage.settings.change("x", { maximumSpeed: um("100").perSecond, motorOn: false });
  const settings = (await stage.settings.read()).axes[0];
  assert.equal(settings?.excited, false);
  assert.deepEqual(settings.speeds?.maximum?.amount, { case: "pulsesPerS", value: 10000n });
  await assert.rejects(stage.moveTo({ x: mm("1") }), (error) => {
    return error instanceof Refused && error.hint.includes("stage.settings.change");
  });
});

test("callers have names and roles", async (t) => {
  const [stage, other, daemon] = await two(t);
  assert.equal((await stage.whoami()).role, "admin");
  assert.equal((await other.whoami()).role, "operator");
  await assert.rejects(
    daemon.connect(t, { token: "axisgate.wrong.00" }).then((one) => one.status()),
    (error) => error instanceof NotAllowed && error.reason === "UNAUTHENTICATED",
  );
});

test("a closed stage ends its calls", async (t) => {
  const [stage] = await two(t);
  const motion = await stage.start({ x: mm("14") });
  const waiting = motion.wait();
  stage.close();
  stage.close();
  await assert.rejects(waiting, /closed/);
  await assert.rejects(stage.status(), /closed/);
});

test("calls are logged", async (t) => {
  const [, , daemon] = await two(t);
  const lines: string[] = [];
  const log = (text: string): void => {
    lines.push(text);
  };
  const stage = await daemon.connect(t, { logger: { debug: log, warn: log } });
  await assert.rejects(stage.moveTo({ x: mm("20") }), OutsideTravel);
  assert.ok(lines.includes("Move is sent"));
  assert.ok(lines.some((line) => line.startsWith("failed with OUT_OF_RANGE OUTSIDE_TRAVEL")));
});
