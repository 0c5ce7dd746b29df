// Jobs of a simulated mill, with the real daemon.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test, type TestContext } from "node:test";

import { Mill, mm, Refused, Stage } from "axisgate";
import { type Job, JobState } from "axisgate/v1";

import { Daemon, Relay, until } from "./daemon.js";

const PROFILE = join(import.meta.dirname, "../../../../deploy/mills/mdx-20.toml");
const MILL = `
[[device]]
name = "mill"
kind = "rml1"
profile = "${PROFILE}"
connection = "simulated"
tools = ["T1", "T2"]
[[device.origin]]
name = "vice"
x = 400
y = 400
`;
const TRACES = Buffer.from("PA;PA;VS4;!VZ4;!PZ-4,80;!MC1;PU80,80;PD80,80,120,80,120,120,80,120,80,80;PU;!MC0;\n");
const OUTLINE = Buffer.from("PA;PA;VS4;!VZ4;!PZ-23,80;!MC1;PU40,40;PD40,40,160,40;PU;!MC0;\n");
const BOARD = { title: "board", tools: ["T1"], origin: "vice", acceptedWarnings: ["drags-tool"] };

async function milling(t: TestContext): Promise<[Mill, Daemon]> {
  const daemon = await Daemon.of(t, { more: MILL });
  const mill = await Mill.connect({ target: daemon.socket });
  t.after(() => {
    mill.close();
  });
  await until(async () => (await mill.read()).lineOpen, "the line of the mill");
  return [mill, daemon];
}

async function stateOf(mill: Mill, job: Job): Promise<string | undefined> {
  const found = (await mill.jobs()).find((one) => one.name === job.name);
  return found && JobState[found.state];
}

async function runPart(mill: Mill, job: Job, state: string): Promise<void> {
  const newest = (await mill.jobs()).find((one) => one.name === job.name) ?? job;
  await mill.start(await mill.confirm(newest));
  await until(async () => (await stateOf(mill, job)) === state, `the state ${state}`);
}

test("devices are found by what they can do", async (t) => {
  const [mill, { socket: target }] = await milling(t);
  assert.equal(mill.name, "mill");
  assert.deepEqual([await Mill.find({ target }), await Stage.find({ target })], [["mill"], ["stage"]]);
});

test("a job in two parts", async (t) => {
  const [mill] = await milling(t);
  const stock = { x: mm("50"), y: mm("50"), z: mm("2") };
  const job = await mill.send([TRACES, OUTLINE], { ...BOARD, tools: ["T1", "T2"], stock });
  assert.deepEqual(
    job.parts.map((part) => [part.tool, part.bytes]),
    [
      ["T1", BigInt(TRACES.length)],
      ["T2", BigInt(OUTLINE.length)],
    ],
  );
  await runPart(mill, job, "TOOL_CHANGE");
  await runPart(mill, job, "FED");
  await mill.reportDone(job);
  assert.deepEqual(await mill.jobs(), []);
});

test("a faulty job is refused", async (t) => {
  const [mill] = await milling(t);
  const faulty = mill.send([Buffer.from("G1 X10\n")], { title: "a", tools: ["T1"] });
  await assert.rejects(faulty, (error) => error instanceof Refused && error.reason === "INVALID_REQUEST");
  await assert.rejects(mill.send([TRACES], { title: "a", tools: ["T1", "T2"] }), RangeError);
});

test("a job is cancelled, and an abort is sent", async (t) => {
  const [mill] = await milling(t);
  const job = await mill.send([TRACES], BOARD);
  await mill.cancel(job);
  assert.equal(await stateOf(mill, job), undefined);
  await mill.abort();
});

test("a job whose answer was lost is queued once", async (t) => {
  const [direct, daemon] = await milling(t);
  const relay = await Relay.of(t, daemon);
  await using mill = await Mill.connect({ target: relay.socket });
  relay.cutAnswers(3, 2);
  await mill.send([TRACES], BOARD);
  assert.deepEqual([relay.cuts, (await direct.jobs()).length], [2, 1]);
});

test("the tool is moved by hand", async (t) => {
  const [mill] = await milling(t);
  assert.ok((await mill.step({ x: mm("1"), z: mm("-0.5") })) > 0);
  for await (const state of mill.watch()) {
    assert.ok(state.lineOpen);
    break;
  }
});
