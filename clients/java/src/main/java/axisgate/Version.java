package axisgate;

import java.io.IOException;
import java.io.UncheckedIOException;
import java.nio.charset.StandardCharsets;

/** Version of this package, and its comparison with the daemon's. */
final class Version {
  static final String OWN = read();

  private Version() {}

  /**
   * Logs a warning if the daemon has another version. Fields that one of them does not know have no
   * effect.
   */
  static void compare(String daemon, System.Logger logger) {
    if (!daemon.isEmpty() && !daemon.equals(OWN)) {
      logger.log(
          System.Logger.Level.WARNING,
          "the daemon is axisgate {0}, and this package {1}",
          daemon,
          OWN);
    }
  }

  private static String read() {
    try (var file = Version.class.getResourceAsStream("version")) {
      return new String(file.readAllBytes(), StandardCharsets.US_ASCII).strip();
    } catch (IOException e) {
      throw new UncheckedIOException(e);
    }
  }
}
