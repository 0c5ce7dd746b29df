package axisgate;

import io.grpc.ChannelCredentials;
import io.grpc.InsecureChannelCredentials;
import io.grpc.TlsChannelCredentials;
import java.io.File;
import java.io.IOException;
import java.net.URI;
import java.net.URISyntaxException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.regex.Pattern;

/**
 * A Target is the daemon's address in gRPC's form, with what identifies the caller. An empty text
 * is absent.
 *
 * @param address "unix:/run/axisgate/axisgate.sock", or "lab:50203"
 */
record Target(String address, String token, String ca, String certificate, String key) {
  private static final Path SYSTEM_SOCKET = Path.of("/run/axisgate/axisgate.sock");
  private static final String PORT = "50203";
  private static final String TLS_PORT = "50204";
  private static final Pattern GRPC_NAME = Pattern.compile("(unix|dns|ipv4|ipv6):.*");
  private static final Pattern LOCAL =
      Pattern.compile("unix:.*|(ipv[46]:|dns:/*)?(localhost|127\\.[0-9.]+|\\[::1\\]|::1)(:\\d+)?");

  static Target of(ConnectOptions options) {
    String ca = options.ca();
    String certificate = options.certificate();
    String key = options.key();
    if (certificate.isEmpty() != key.isEmpty()) {
      throw new IllegalArgumentException("certificate and key must be given together");
    }
    boolean tls = !ca.isEmpty() || !certificate.isEmpty();
    String address = addressOf(options.target(), tls, options);
    Target target = new Target(address, options.token(), ca, certificate, key);
    if (!target.token.isEmpty() && !tls && !target.isLocal()) {
      throw new IllegalArgumentException(
          "the token is not sent unencrypted to " + address + ": use ca(file) or set AXISGATE_CA");
    }
    return target;
  }

  /** Reports whether the daemon runs on this machine. */
  boolean isLocal() {
    return LOCAL.matcher(address).matches();
  }

  boolean isSocket() {
    return address.startsWith("unix:");
  }

  /** Returns the address as a URI for grpc-java, which has no names for plain IP addresses. */
  String uri() {
    if (isSocket()) {
      return socketUri(address.substring("unix:".length()));
    }
    return "dns:///" + address.replaceFirst("^(dns|ipv4|ipv6):/*", "");
  }

  private static String socketUri(String path) {
    try {
      return new URI(
              "unix", null, path.startsWith("///") ? path.substring(2) : absolute(path), null)
          .toString();
    } catch (URISyntaxException e) {
      throw new IllegalArgumentException(path + " is not the path of a socket", e);
    }
  }

  private static String absolute(String path) {
    return Path.of(path).toAbsolutePath().toString();
  }

  ChannelCredentials credentials() {
    if (ca.isEmpty() && certificate.isEmpty()) {
      return InsecureChannelCredentials.create();
    }
    try {
      var tls = TlsChannelCredentials.newBuilder();
      if (!ca.isEmpty()) {
        tls.trustManager(new File(ca));
      }
      if (!certificate.isEmpty()) {
        tls.keyManager(new File(certificate), new File(key));
      }
      return tls.build();
    } catch (IOException e) {
      throw new IllegalArgumentException("cannot read a file for TLS: " + e.getMessage(), e);
    }
  }

  private static String addressOf(String name, boolean tls, ConnectOptions options) {
    if (name.isEmpty()) {
      return "unix:" + defaultSocket(options);
    }
    if (GRPC_NAME.matcher(name).matches()) {
      return name;
    }
    if (name.contains("/") || name.endsWith(".sock")) {
      return "unix:" + name;
    }
    return withPort(name, tls ? TLS_PORT : PORT);
  }

  private static String withPort(String host, String port) {
    boolean bracketed = host.startsWith("[");
    boolean hasPort = bracketed ? !host.endsWith("]") : host.matches("[^:]*:[^:]*");
    if (hasPort) {
      return host;
    }
    return (!bracketed && host.contains(":") ? "[" + host + "]" : host) + ":" + port;
  }

  private static String defaultSocket(ConnectOptions options) {
    String chosen = options.chosen(null, "AXISGATE_SOCKET");
    if (!chosen.isEmpty()) {
      return chosen;
    }
    int user = userId();
    if (Files.exists(SYSTEM_SOCKET) || user == 0) {
      return SYSTEM_SOCKET.toString();
    }
    String runtime = options.chosen(null, "XDG_RUNTIME_DIR");
    return (runtime.isEmpty() ? "/tmp/axisgate-" + user : runtime) + "/axisgate.sock";
  }

  /** Returns the number of the user on Linux. 0: unknown. */
  private static int userId() {
    try {
      return (Integer) Files.getAttribute(Path.of("/proc/self"), "unix:uid");
    } catch (IOException | UnsupportedOperationException e) {
      return 0;
    }
  }
}
