// Measures a raster overnight. The lease and the moves survive a broken connection; a lost lease ends the raster.
import { setTimeout as sleep } from "node:timers/promises";

import { type Distance, Stage, um } from "axisgate";

const ROWS = 26;
const COLUMNS = 26;
const STEP_UM = 20;

/** Yields the points row by row, every other row backwards. */
function* raster(): Generator<[Distance, Distance]> {
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) {
      const at = row % 2 === 0 ? column : COLUMNS - 1 - column;
      yield [um(BigInt(at * STEP_UM)), um(BigInt(row * STEP_UM))];
    }
  }
}

/** Stands for the reading of a detector. */
async function measure(): Promise<number> {
  await sleep(10);
  return Math.random();
}

await using stage = await Stage.connect();
// The lease lasts for five minutes without a connection.
await using lease = await stage.lease(["x", "y"], { ttlMs: 300_000, purpose: "overnight raster" });
await stage.home(["x", "y"], { ifNeeded: true });

for await (const result of stage.visit(raster(), ["x", "y"], { signal: lease.lostSignal })) {
  console.log([...result.positions.values()].map((at) => at.value).join(","), await measure());
}
