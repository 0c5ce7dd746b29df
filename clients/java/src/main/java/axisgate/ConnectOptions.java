package axisgate;

import java.time.Duration;
import java.util.Objects;
import java.util.UUID;
import java.util.function.UnaryOperator;

/**
 * ConnectOptions name the daemon, the device and the caller. A text that is not set comes from the
 * environment.
 *
 * <pre>{@code
 * Stage.open(new ConnectOptions().target("lab").ca("lab.crt").token(secret))
 * }</pre>
 *
 * <p>Not thread safe.
 */
public final class ConnectOptions {
  /** Session of this process: the daemon treats all of its connections as one program. */
  private static final String PROCESS = UUID.randomUUID().toString();

  final UnaryOperator<String> environment;
  String session = PROCESS;
  String device = "";
  Duration timeout = Duration.ofSeconds(10);
  System.Logger logger = System.getLogger("axisgate");
  private String target;
  private String token;
  private String ca;
  private String certificate;
  private String key;

  /** Makes options that all come from the environment. */
  public ConnectOptions() {
    this(System::getenv);
  }

  ConnectOptions(UnaryOperator<String> environment) {
    this.environment = environment;
  }

  /**
   * Names the daemon. Without it: $AXISGATE_TARGET, or the local daemon.
   *
   * @param address path of a Unix socket, or HOST[:PORT]
   * @return these options
   */
  public ConnectOptions target(String address) {
    target = address;
    return this;
  }

  /**
   * Gives the caller's token. Without it: $AXISGATE_TOKEN. A token is never sent unencrypted to
   * another machine.
   *
   * @param secret the token
   * @return these options
   */
  public ConnectOptions token(String secret) {
    token = secret;
    return this;
  }

  /**
   * Names the authority that signed the daemon's certificate, and so chooses TLS. Without it:
   * $AXISGATE_CA.
   *
   * @param file file of the authority's certificate
   * @return these options
   */
  public ConnectOptions ca(String file) {
    ca = file;
    return this;
  }

  /**
   * Names the caller's own certificate and key for TLS. Without it: $AXISGATE_CERTIFICATE and
   * $AXISGATE_KEY.
   *
   * @param file file of the certificate
   * @param keyFile file of the key
   * @return these options
   */
  public ConnectOptions certificate(String file, String keyFile) {
    certificate = file;
    key = keyFile;
    return this;
  }

  /**
   * Names the device. Without it: the only one of the daemon.
   *
   * @param name name of the device
   * @return these options
   */
  public ConnectOptions device(String name) {
    device = Objects.requireNonNull(name);
    return this;
  }

  /**
   * Sets the time limit of each call. Without it: 10 s. While the limit is in its first half, a
   * request whose answer is lost is sent again; the daemon acts once.
   *
   * @param limit time limit
   * @return these options
   */
  public ConnectOptions timeout(Duration limit) {
    timeout = Objects.requireNonNull(limit);
    return this;
  }

  /**
   * Sets the logger of the calls (level DEBUG) and lost leases (level WARNING). Without it: the
   * logger "axisgate".
   *
   * @param log logger
   * @return these options
   */
  public ConnectOptions logger(System.Logger log) {
    logger = Objects.requireNonNull(log);
    return this;
  }

  String target() {
    return chosen(target, "AXISGATE_TARGET");
  }

  String token() {
    return chosen(token, "AXISGATE_TOKEN");
  }

  String ca() {
    return chosen(ca, "AXISGATE_CA");
  }

  String certificate() {
    return chosen(certificate, "AXISGATE_CERTIFICATE");
  }

  String key() {
    return chosen(key, "AXISGATE_KEY");
  }

  /**
   * Returns the token of the lease of {@code axisctl lease run} in hexadecimal digits, or an empty
   * text.
   */
  String lease() {
    return chosen(null, "AXISGATE_LEASE");
  }

  /** Returns the argument, or else the variable. Empty: neither is set. */
  String chosen(String argument, String variable) {
    String found = argument == null ? environment.apply(variable) : argument;
    return found == null ? "" : found;
  }
}
