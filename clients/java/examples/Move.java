import static axisgate.Units.mm;

import axisgate.Interrupted;
import axisgate.MotionFailed;
import axisgate.OutcomeUnknown;
import axisgate.Refused;
import axisgate.Stage;
import axisgate.Stopped;

/** Moves the axis x of the local stage, and waits. Ctrl-C cancels the move. */
final class Move {
  private Move() {}

  public static void main(String[] arguments) {
    cancelAtExit(Thread.currentThread());
    try (var stage = Stage.open()) {
      System.out.println(stage.axis("x").moveTo(mm("1.5")));
    } catch (Refused e) {
      System.err.println("nothing moved: " + e.reason() + " " + e.hint());
    } catch (Stopped | MotionFailed e) {
      System.err.println("the move ended early: " + e.getMessage());
    } catch (OutcomeUnknown e) {
      System.err.println("look at the stage: " + e.getMessage());
    } catch (Interrupted e) {
      System.err.println(e.getMessage());
    }
  }

  /** Interrupts the thread when the program is ended, and lets the program wait for it. */
  private static void cancelAtExit(Thread moving) {
    Runtime.getRuntime()
        .addShutdownHook(
            new Thread(
                () -> {
                  moving.interrupt();
                  try {
                    moving.join();
                  } catch (InterruptedException e) {
                    Thread.currentThread().interrupt();
                  }
                }));
  }
}
