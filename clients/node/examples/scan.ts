// Scans a line. The trigger output gives a pulse every 10 um, for a detector that counts them.
import { mm, Stage, um } from "axisgate";

await using stage = await Stage.connect();
await using lease = await stage.lease([], { purpose: "scan of sample 12", waitMs: 60_000 });
await stage.home(["x"], { ifNeeded: true });

const motion = await stage.scan("x", mm("0"), mm("2"), { every: um("10"), speed: um("200").perSecond });
for await (const progress of motion.progress({ signal: lease.lostSignal })) console.log(...progress.positions.values());

const { scan } = await motion.wait();
console.log(`${String(scan?.expectedInRange)} pulses in the range`);
if (scan?.observed !== scan?.expected) {
  console.error(`the controller gave ${String(scan?.observed)} pulses of ${String(scan?.expected)}`);
  process.exitCode = 1;
}
