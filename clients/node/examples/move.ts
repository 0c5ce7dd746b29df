// Moves an axis and waits for the outcome. Ctrl-C cancels the move.
import { mm, Refused, Stage } from "axisgate";

const interrupted = new AbortController();
process.once("SIGINT", () => {
  interrupted.abort();
});

await using stage = await Stage.connect();
try {
  const result = await stage.axis("x").moveTo(mm("1.5"), { speed: mm(2).perSecond, signal: interrupted.signal });
  console.log(result, `after ${String(result.durationMs)} ms`);
} catch (error) {
  if (error instanceof Refused) console.error(`nothing moved: ${error.toString()}`);
  else if (interrupted.signal.aborted) console.error("the move was cancelled");
  else throw error;
  process.exitCode = 1;
}
