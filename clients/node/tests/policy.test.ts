// The policies of repeating and following, the mapping of errors, and targets: without a daemon.
import assert from "node:assert/strict";
import { test } from "node:test";

import { create, toBinary } from "@bufbuild/protobuf";
import { anyPack } from "@bufbuild/protobuf/wkt";
import { Metadata, type ServiceError, status } from "@grpc/grpc-js";

import { Cursor } from "#internal/cursor.js";
import { Following, LOST_LIMIT_MS } from "#internal/following.js";
import { StatusSchema } from "#internal/gen/status_pb.js";
import { withMethods } from "#internal/hints.js";
import { errorOf, Failure, failureOf } from "#internal/outcomes.js";
import { Repeat, type RepeatTerms } from "#internal/repeat.js";
import { outcomeOf } from "#internal/results.js";
import { resolve, type TargetOptions } from "#internal/target.js";
import * as axisgate from "axisgate";
import { EventSchema, MotionSchema, MotionState, type Problem, ProblemSchema, Reason } from "axisgate/v1";

const BROKEN = new Failure(status.UNAVAILABLE, "Connection dropped");
const NEVER = new Failure(status.UNAVAILABLE, "No connection established. Last error: ...");

function refusal(reason: number, code = status.FAILED_PRECONDITION, fields: Partial<Problem> = {}): Failure {
  const problem = create(ProblemSchema, { message: "a sentence." });
  return new Failure(code, "text", Object.assign(problem, { reason }, fields));
}

function repeatOf(terms: Partial<RepeatTerms> = {}): Repeat {
  return new Repeat({ until: 5000, target: "here", answerMs: 5000, acts: true, remembered: true, ...terms });
}

/** Returns the pauses until the error, on a clock that only pauses move. */
function pausesOf(repeat: Repeat, failure: Failure): [number[], axisgate.AxisgateError] {
  const pauses: number[] = [];
  for (let now = 0; ;) {
    const pause = repeat.after(failure, now);
    if (typeof pause !== "number") return [pauses, pause];
    pauses.push(pause);
    now += pause;
  }
}

test("a lost answer is asked for again until the deadline", () => {
  const [pauses, error] = pausesOf(repeatOf(), BROKEN);
  assert.deepEqual(pauses, [250, 500, 1000, 2000, 1250]);
  assert.ok(error instanceof axisgate.OutcomeUnknown);
});

test("the deadline of an attempt covers the answer", () => {
  const repeat = repeatOf({ answerMs: 3000 });
  assert.deepEqual([repeat.attemptTimeout(1000), repeat.attemptTimeout(9000)], [7000, 3000]);
});

test("a request that never had a connection is refused", () => {
  const [pauses, error] = pausesOf(repeatOf(), NEVER);
  assert.equal(pauses.length, 5);
  assert.ok(error instanceof axisgate.Unavailable);
});

test("without a connection after a lost answer the outcome is unknown", () => {
  const repeat = repeatOf({ until: 1000 });
  repeat.after(BROKEN, 0);
  assert.ok(pausesOf(repeat, NEVER)[1] instanceof axisgate.OutcomeUnknown);
});

test("a refusal is final", () => {
  assert.ok(repeatOf().after(refusal(Reason.OUTSIDE_TRAVEL), 0) instanceof axisgate.OutsideTravel);
});

test("UNAVAILABLE is repeated", () => {
  const [pauses, error] = pausesOf(repeatOf(), refusal(Reason.LINK_DOWN, status.UNAVAILABLE));
  assert.equal(pauses.length, 5);
  assert.ok(error instanceof axisgate.Unavailable);
  assert.equal(error.reason, "LINK_DOWN");
});

test("a refusal after a lost answer decides only if the daemon has compared the id", () => {
  for (const [reason, decides] of [
    [Reason.OUTSIDE_TRAVEL, true],
    [Reason.DEADLINE_PASSED, true],
    [Reason.LEASE_LOST, false],
    [Reason.UNAUTHENTICATED, false],
    [Reason.REQUEST_MEMORY_LOST, false],
  ] as const) {
    const repeat = repeatOf();
    assert.equal(repeat.after(BROKEN, 0), 250);
    const error = repeat.after(refusal(reason), 500);
    assert.equal(error instanceof axisgate.Refused, decides, Reason[reason]);
    assert.equal(error instanceof axisgate.OutcomeUnknown, !decides, Reason[reason]);
  }
});

test("a daemon without a memory is asked again only if nothing was sent", () => {
  const repeat = repeatOf({ remembered: false });
  assert.equal(repeat.after(NEVER, 0), 250);
  assert.ok(repeat.after(BROKEN, 500) instanceof axisgate.OutcomeUnknown);
});

test("a question is repeated, and its end is Unavailable", () => {
  const [pauses, error] = pausesOf(repeatOf({ acts: false, remembered: false }), BROKEN);
  assert.equal(pauses.length, 5);
  assert.ok(error instanceof axisgate.Unavailable);
});

const MOTION = create(MotionSchema, { name: "devices/stage/motions/1", requestId: "a" });

test("a motion is waited for in parts", () => {
  const following = new Following(MOTION, "here", 0);
  for (const [left, wait] of [
    [Infinity, 10],
    [3000, 3],
    [-1, 0],
  ] as const) {
    const [request, deadline] = following.question(left);
    assert.equal(request.maxWait?.seconds, BigInt(wait));
    assert.equal(deadline, 1000 * wait + 5000);
  }
});

test("a motion is followed over a broken connection for a minute", () => {
  const following = new Following(MOTION, "here", 0);
  const pauses = Array.from({ length: 7 }, () => following.after(BROKEN, 1000));
  assert.deepEqual(pauses, [250, 500, 1000, 2000, 4000, 5000, 5000]);
  assert.equal(following.take(MOTION, 50_000), undefined);
  assert.equal(following.after(NEVER, LOST_LIMIT_MS + 49_000), 250);
  assert.ok(following.after(NEVER, LOST_LIMIT_MS + 51_000) instanceof axisgate.OutcomeUnknown);
});

test("the outcome of a motion that is no longer kept is unknown", () => {
  const following = new Following(MOTION, "here", 0);
  assert.ok(following.after(refusal(Reason.NOT_FOUND, status.NOT_FOUND), 1) instanceof axisgate.OutcomeUnknown);
});

test("another motion of the same name is not taken for the motion", () => {
  const other = create(MotionSchema, { name: MOTION.name, requestId: "b" });
  assert.ok(new Following(MOTION, "here", 0).take(other, 1) instanceof axisgate.OutcomeUnknown);
});

test("every reason has its name, also one of a newer daemon", () => {
  for (const [name, number] of Object.entries(Reason)) {
    if (typeof number === "number") assert.equal(errorOf(refusal(number), "here").reason, name);
  }
  const newer = 99;
  const error = errorOf(refusal(newer), "here");
  assert.equal(error.constructor, axisgate.Refused);
  assert.equal(error.reason, "REASON 99");
});

test("an error has the fields and the text of its problem", () => {
  const fields = { axis: 2, hint: "acquire it: `AcquireLease`", sent: "G:1", wireReply: "NG" };
  const error = errorOf(refusal(Reason.LEASE_HELD, status.FAILED_PRECONDITION, fields), "here");
  assert.ok(error instanceof axisgate.LeaseHeld);
  assert.deepEqual([error.axis, error.sent, error.wireReply], [2, "G:1", "NG"]);
  assert.deepEqual([error.name, error.code, error.message], ["LeaseHeld", "FAILED_PRECONDITION", "a sentence."]);
  assert.equal(String(error), 'LEASE_HELD: a sentence. (acquire it: `stage.lease(["2"])`)');
});

test("calls that are refused before a problem can be sent have acted nowhere", () => {
  for (const [code, kind] of [
    [status.UNAUTHENTICATED, axisgate.NotAllowed],
    [status.PERMISSION_DENIED, axisgate.NotAllowed],
    [status.UNIMPLEMENTED, axisgate.Refused],
  ] as const) {
    const failure = new Failure(code, "text");
    assert.equal(failure.lost, false);
    assert.equal(errorOf(failure, "here").constructor, kind);
  }
  assert.ok(new Failure(status.RESOURCE_EXHAUSTED, "a reset stream").lost);
});

test("outcomes other than success are errors", () => {
  for (const [state, kind] of [
    [MotionState.STOPPED, axisgate.Stopped],
    [MotionState.FAILED, axisgate.MotionFailed],
    [MotionState.UNKNOWN, axisgate.OutcomeUnknown],
  ] as const) {
    const motion = create(MotionSchema, { state, problem: { reason: Reason.LIMIT_DETECTED } });
    assert.throws(
      () => outcomeOf(motion),
      (error) => error instanceof kind && error.reason === "LIMIT_DETECTED",
    );
  }
});

test("the problem is read from the trailers", () => {
  const problem = create(ProblemSchema, { reason: Reason.TOO_FAST });
  const details = toBinary(StatusSchema, create(StatusSchema, { details: [anyPack(ProblemSchema, problem)] }));
  const errorWith = (content: Uint8Array): ServiceError => {
    const metadata = new Metadata();
    metadata.set("grpc-status-details-bin", Buffer.from(content));
    return Object.assign(new Error(), { code: status.OUT_OF_RANGE, details: "text", metadata });
  };
  assert.equal(failureOf(errorWith(details)).reason, "TOO_FAST");
  assert.ok(failureOf(errorWith(Uint8Array.of(255, 255))).lost);
});

test("hints name the functions of this package", () => {
  assert.equal(withMethods("clear it: `ClearErrors`", "1"), "clear it: `stage.clearErrors()`");
  const setting = "`ChangeSettings` with `excited`";
  assert.equal(withMethods(setting, "1"), '`stage.settings.change("1", { motorOn: true })`');
  assert.equal(withMethods("`Home` it", ""), "`stage.home([axis])` it");
});

test("events resume after the last event, and after a gap", () => {
  const cursor = new Cursor("devices/stage", 5n, "a");
  assert.deepEqual([cursor.request().fromRevision, cursor.request().run], [5n, "a"]);
  cursor.take(create(EventSchema, { revision: 7n, run: "a" }));
  assert.deepEqual([cursor.request().fromRevision, cursor.request().run], [8n, "a"]);
  assert.equal(cursor.gapAfter(BROKEN), undefined);
  const metadata = { resume_revision: "40" };
  assert.equal(cursor.gapAfter(refusal(Reason.COMPACTED, status.OUT_OF_RANGE, { metadata })), 40n);
  assert.deepEqual([cursor.request().fromRevision, cursor.request().run], [40n, ""]);
});

const addressOf = (options: TargetOptions, environment = {}): string => resolve(options, environment).address;

test("targets are sockets, hosts or names of gRPC", () => {
  for (const [target, address] of [
    ["/run/a.sock", "unix:/run/a.sock"],
    ["a.sock", "unix:a.sock"],
    ["lab", "lab:50203"],
    ["lab:1", "lab:1"],
    ["[::1]", "[::1]:50203"],
    ["::1", "[::1]:50203"],
    ["[::1]:1", "[::1]:1"],
    ["unix:a", "unix:a"],
  ] as const) {
    assert.equal(addressOf({ target }), address);
  }
  assert.equal(addressOf({ target: "lab", ca: "file" }), "lab:50204");
});

test("the environment names a target", () => {
  assert.equal(addressOf({}, { AXISGATE_TARGET: "lab" }), "lab:50203");
  assert.equal(addressOf({ target: "x.sock" }, { AXISGATE_TARGET: "lab" }), "unix:x.sock");
  assert.equal(addressOf({}, { AXISGATE_SOCKET: "/a" }), "unix:/a");
});

test("a token is neither sent in plaintext to another machine nor shown", () => {
  const token = "secret";
  for (const target of ["127.0.0.1", "localhost:1", "[::1]", "/a/b.sock", "ipv4:127.0.0.1:1"]) {
    addressOf({ target, token });
  }
  for (const target of ["lab", "127.0.0.1.example", "192.0.2.1:50203", "dns:lab"]) {
    assert.throws(() => addressOf({ target, token }), TypeError);
  }
  addressOf({ target: "lab", token, ca: "file" });
  assert.throws(() => addressOf({ target: "lab", certificate: "file" }), TypeError);
  const target = resolve({ target: "a.sock", token }, {});
  assert.deepEqual(target.metadata().get("authorization"), ["Bearer secret"]);
  assert.ok(!JSON.stringify(target).includes("secret"));
});
