// Whole programs.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { test } from "node:test";
import { promisify } from "node:util";

import { Daemon } from "./daemon.js";

const PROGRAM = `
import { mm, Stage, um } from "axisgate";
const stage = await Stage.connect({ target: process.argv[1] });
const lease = await stage.lease(["x"], { ttlMs: 60000 });
const events = await stage.events();
const states = stage.watch();
const motion = await stage.start({ x: mm("14") });
await Promise.all([events.next(), states.next()]);
motion.wait().catch(() => undefined);
await stage.jog({ z: um("200").perSecond }).catch(() => undefined);
console.log(String(lease.axes));
stage.close();
`;

const run = promisify(execFile);

test("a program ends by itself after close()", async (t) => {
  const daemon = await Daemon.of(t);
  const words = ["--input-type=module", "--eval", PROGRAM, daemon.socket];
  const { stdout, stderr } = await run(process.execPath, words, { timeout: 5000 });
  assert.deepEqual([stdout, stderr], ["1\n", ""]);
});
