package axisgate;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.util.List;
import java.util.Map;
import org.junit.jupiter.api.Test;

class TargetTest {
  private static ConnectOptions options(Map<String, String> environment) {
    return new ConnectOptions(environment::get);
  }

  private static String address(String name) {
    return Target.of(options(Map.of()).target(name)).address();
  }

  @Test
  void addresses() {
    Map.of(
            "/run/a.sock", "unix:/run/a.sock",
            "a.sock", "unix:a.sock",
            "lab", "lab:50203",
            "lab:1", "lab:1",
            "[::1]", "[::1]:50203",
            "::1", "[::1]:50203",
            "[::1]:1", "[::1]:1",
            "unix:a", "unix:a")
        .forEach((name, wanted) -> assertEquals(wanted, address(name)));
    assertEquals("lab:50204", Target.of(options(Map.of()).target("lab").ca("file")).address());
  }

  @Test
  void addressesOfGrpcJava() {
    Map.of(
            "unix:/a b", "unix:/a%20b",
            "unix:///a", "unix:/a",
            "lab:1", "dns:///lab:1",
            "ipv4:127.0.0.1:1", "dns:///127.0.0.1:1",
            "ipv6:[::1]:1", "dns:///[::1]:1")
        .forEach(
            (name, wanted) ->
                assertEquals(wanted, Target.of(options(Map.of()).target(name)).uri()));
  }

  @Test
  void environment() {
    var lab = Map.of("AXISGATE_TARGET", "lab");
    assertEquals("lab:50203", Target.of(options(lab)).address());
    assertEquals("unix:x.sock", Target.of(options(lab).target("x.sock")).address());
    assertEquals("unix:/a", Target.of(options(Map.of("AXISGATE_SOCKET", "/a"))).address());
    assertEquals("s", Target.of(options(Map.of("AXISGATE_TOKEN", "s"))).token());
  }

  @Test
  void tokenIsNotSentInPlaintext() {
    for (String local :
        List.of("127.0.0.1", "localhost:1", "[::1]", "/a/b.sock", "ipv4:127.0.0.1:1")) {
      assertTrue(Target.of(options(Map.of()).target(local).token("secret")).isLocal(), local);
    }
    for (String other :
        List.of("lab", "127.0.0.1.example", "192.0.2.1:50203", "dns:lab", "unixbox")) {
      var options = options(Map.of()).target(other).token("secret");
      assertThrows(IllegalArgumentException.class, () -> Target.of(options), other);
    }
    assertEquals(
        "secret", Target.of(options(Map.of()).target("lab").token("secret").ca("file")).token());
    var half = options(Map.of()).target("lab").certificate("file", "");
    assertThrows(IllegalArgumentException.class, () -> Target.of(half));
  }

  @Test
  void inheritedLease() {
    assertTrue(Session.inheritedToken("").isEmpty());
    for (String wrong : List.of("zz", "00ff", "0")) {
      assertThrows(IllegalArgumentException.class, () -> Session.inheritedToken(wrong));
    }
  }
}
