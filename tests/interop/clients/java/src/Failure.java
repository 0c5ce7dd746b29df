/** A difference between what was seen and what was expected. */
final class Failure extends RuntimeException {
  Failure(String what, Object seen, Object expected) {
    super(what + ": saw " + seen + ", expected " + expected);
  }

  /** Throws Failure unless both are equal. */
  static void expect(String what, Object seen, Object expected) {
    check(seen.equals(expected), what, seen, expected);
  }

  /** Throws Failure unless `ok`. */
  static void check(boolean ok, String what, Object seen, Object expected) {
    if (!ok) {
      throw new Failure(what, seen, expected);
    }
  }

  /** Returns one line about any exception. */
  static String line(Exception e) {
    return (e instanceof Failure ? e.getMessage() : "saw " + e + ", expected none").replaceAll("\\s+", " ");
  }
}
