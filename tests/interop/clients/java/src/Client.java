import io.grpc.*;
import java.util.concurrent.TimeUnit;
import java.util.concurrent.atomic.AtomicLong;
import java.util.logging.Level;
import java.util.logging.Logger;

/** The program: client ROW TARGET. It runs one row of ../../../README.md, and counts the calls. */
final class Client implements ClientInterceptor {
  /** Shortest interval between PINGs that grpc-java permits. It raises a shorter one to this. */
  static final int KEEPALIVE_SECONDS = 10;

  private static final Logger LOG = Logger.getLogger("");
  private final AtomicLong calls = new AtomicLong();
  private final String row;

  private Client(String row) {
    this.row = row;
  }

  @Override
  public <Q, A> ClientCall<Q, A> interceptCall(MethodDescriptor<Q, A> method, CallOptions options, Channel next) {
    calls.incrementAndGet();
    if (options.getDeadline() == null) {
      options = options.withDeadlineAfter(30, TimeUnit.SECONDS);
    }
    return next.newCall(method, row.equals("gzip") ? options.withCompression("gzip") : options);
  }

  private boolean run(String target) {
    var builder = Grpc.newChannelBuilder(target, InsecureChannelCredentials.create()).intercept(this);
    if (row.equals("keepalive")) {
      builder.keepAliveTime(KEEPALIVE_SECONDS, TimeUnit.SECONDS).keepAliveWithoutCalls(true);
    }
    ManagedChannel channel = builder.build();
    try {
      new Rows(channel).run(row);
      return true;
    } catch (Exception e) {
      System.err.println(row + ": " + Failure.line(e));
      return false;
    } finally {
      channel.shutdownNow();
      System.out.println("calls " + calls);
    }
  }

  public static void main(String[] arguments) {
    if (arguments.length == 1 && arguments[0].equals("--version")) {
      System.out.println("grpc-java " + Channel.class.getPackage().getImplementationVersion());
      return;
    }
    if (arguments.length != 2) {
      System.err.println("usage: client ROW TARGET");
      System.exit(2);
    }
    LOG.setLevel(Level.OFF); // Standard error is for the line about the row.
    System.exit(new Client(arguments[0]).run(arguments[1]) ? 0 : 1);
  }
}
