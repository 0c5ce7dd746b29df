#!/usr/bin/env node
// Translates the acts of the conformance scenario into calls of this package, one JSON object on a line each way.
import { createInterface } from "node:readline";
import { setTimeout as sleep } from "node:timers/promises";

import * as axisgate from "axisgate";
import { AxisgateError, Gap, MotionFailed, OutcomeUnknown, Refused, Stage, Stopped } from "axisgate";
import { MotionState } from "axisgate/v1";

const OUTCOMES = [
  [Refused, "refused"],
  [Stopped, "stopped"],
  [MotionFailed, "failed"],
  [OutcomeUnknown, "unknown"],
];

/** What a program of a user throws while it computes a path. */
class PointError extends Error {}

/** A text is exact; a number without a unit is what a careless program passes. */
function amount(given) {
  if (!("unit" in given)) return given.number;
  return axisgate[given.unit]("text" in given ? given.text : number(given.number));
}

const number = (given) => ({ nan: NaN, inf: Infinity })[given] ?? given;
const speed = (act) => act.speed && amount(act.speed).perSecond;

function shown(result) {
  const positions = Object.fromEntries([...result.positions.values()].map((one) => [one.axis, one.value]));
  return { outcome: "done", positions };
}

/** One function for each verb of the scenario. */
class Acts {
  motions = new Map();
  leases = new Map();
  revisions = [];

  async open({ target, token, ca, certificate, key }) {
    this.stage?.close();
    this.stage = await Stage.connect({ target, token, ca, certificate, key });
    return { outcome: "done" };
  }

  async whoami() {
    return { outcome: "done", role: (await this.stage.whoami()).role };
  }

  axes() {
    return { outcome: "done", axes: this.stage.axes.map((one) => [one.name, one.number]) };
  }

  async home(act) {
    return shown(await this.stage.home(act.axes));
  }

  async move_to(act) {
    const signal = "interrupt_after" in act ? AbortSignal.timeout(1000 * act.interrupt_after) : undefined;
    try {
      return shown(await this.stage.axis(act.axis).moveTo(amount(act.amount), { speed: speed(act), signal }));
    } catch (error) {
      if (signal?.aborted && error === signal.reason) return { outcome: "interrupted" };
      throw error;
    }
  }

  async move_by(act) {
    return shown(await this.stage.axis(act.axis).moveBy(amount(act.amount)));
  }

  async start(act) {
    this.motions.set(act.motion, await this.stage.axis(act.axis).start(amount(act.amount), { speed: speed(act) }));
    return { outcome: "started" };
  }

  async wait(act) {
    return shown(await this.motions.get(act.motion).wait({ timeoutMs: act.timeout && 1000 * act.timeout }));
  }

  async cancel(act) {
    await this.motions.get(act.motion).cancel();
    return { outcome: "done" };
  }

  async stop() {
    return { outcome: "done", stays_open: (await this.stage.stop()).staysOpen };
  }

  async rearm() {
    await this.stage.rearm();
    return { outcome: "done" };
  }

  async lease(act) {
    this.leases.set(act.lease, await this.stage.lease(act.axes, { ttlMs: 1000 * act.ttl }));
    return { outcome: "done" };
  }

  async lost({ lease, within = 0 }) {
    const limit = performance.now() + 1000 * within;
    const { lostSignal } = this.leases.get(lease);
    while (!lostSignal.aborted && performance.now() < limit) await sleep(50);
    return { outcome: "done", lost: lostSignal.aborted };
  }

  async release(act) {
    await this.leases.get(act.lease)[Symbol.asyncDispose]();
    return { outcome: "done" };
  }

  async path(act) {
    const unit = axisgate[act.unit];
    function* points() {
      for (let place = 1; place <= act.count; place++) {
        if (place > (act.fails_after ?? act.count)) throw new PointError("there is no such point");
        yield act.step.map((step) => unit(BigInt(place) * BigInt(step)));
      }
    }
    return shown(await (await this.stage.path(points(), act.axes, { speed: speed(act) })).wait());
  }

  async scan(act) {
    const [from, to, every] = [act.from, act.to, act.every].map(amount);
    const motion = await this.stage.scan(act.axis, from, to, { every, speed: speed(act) });
    const { scan } = await motion.wait();
    const observed_equals_expected = scan.observed === scan.expected;
    return { outcome: "done", expected: Number(scan.expectedInRange), observed_equals_expected };
  }

  async events() {
    this.watched = await this.stage.events();
    return { outcome: "done" };
  }

  /** Reads events until so many motions have succeeded. */
  async succeeded(act) {
    let [gaps, ended] = [0, 0];
    while (ended < act.count) {
      const { value } = await this.watched.next();
      if (value instanceof Gap) {
        gaps++;
        continue;
      }
      this.revisions.push(value.revision);
      if (value.fact.case === "motion" && value.fact.value.state === MotionState.SUCCEEDED) ended++;
    }
    const ascending = this.revisions.every((one, at) => at === 0 || one > this.revisions[at - 1]);
    return { outcome: "done", ascending, gaps };
  }

  saturate(act) {
    for (let call = 0; call < act.calls; call++)
      this.motions
        .get(act.motion)
        .wait()
        .catch(() => {});
    return { outcome: "done" };
  }

  close() {
    this.stage?.close();
  }
}

function replyTo(error) {
  if (error.name === "TimeoutError") return { outcome: "timeout" };
  if (error instanceof AxisgateError) {
    const { reason, message, hint, axis } = error;
    return { outcome: OUTCOMES.find(([kind]) => error instanceof kind)[1], reason, message, hint, axis };
  }
  if (error instanceof TypeError || error instanceof RangeError || error instanceof PointError) {
    return { outcome: "local", message: error.message };
  }
  throw error;
}

const acts = new Acts();
for await (const line of createInterface({ input: process.stdin })) {
  const act = JSON.parse(line);
  const reply = await Promise.resolve(acts[act.say](act)).catch(replyTo);
  process.stdout.write(`${JSON.stringify(reply)}\n`);
}
acts.close();
