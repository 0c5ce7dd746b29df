package axisgate;

import java.util.logging.Logger;

/** Filter of the log of Netty, which grpc-netty-shaded contains. */
final class NettyLog {
  /** Keeps the logger with its filter, which would otherwise be collected. */
  private static final Logger BOOTSTRAP =
      Logger.getLogger("io.grpc.netty.shaded.io.netty.bootstrap.Bootstrap");

  private NettyLog() {}

  /** Omits the warning that Unix sockets have no SO_KEEPALIVE, which grpc-java always sets. */
  static void omitSocketOption() {
    BOOTSTRAP.setFilter(entry -> !entry.getMessage().contains("'SO_KEEPALIVE'"));
  }
}
