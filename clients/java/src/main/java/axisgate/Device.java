package axisgate;

import axisgate.v1.AccessServiceGrpc;
import axisgate.v1.GetCallerRequest;
import axisgate.v1.Role;
import java.util.Locale;

/**
 * A Device is the connection to one device of a daemon: a {@link Stage} or a {@link Mill}. Thread
 * safe.
 */
public abstract sealed class Device implements AutoCloseable permits MovingDevice, Mill {
  final Session session;

  Device(Session session) {
    this.session = session;
  }

  /**
   * Returns the name of the device.
   *
   * @return the name
   */
  public final String name() {
    return Names.device(session.device);
  }

  /**
   * Returns the caller's name and role, as the daemon identifies this program.
   *
   * @return the caller
   */
  public final Caller whoAmI() {
    var answer =
        session.ask(AccessServiceGrpc.getGetCallerMethod(), GetCallerRequest.getDefaultInstance());
    String role = Names.enumName(Role.getDescriptor(), answer.getRoleValue(), "ROLE_");
    return new Caller(answer.getCaller().getName(), role.toLowerCase(Locale.ROOT));
  }

  /**
   * Acquires the exclusive right to some axes, or to the whole device. Calls of this object then
   * carry the lease.
   *
   * @param terms terms of the lease
   * @return the lease
   * @throws LeaseHeld if the axes are not free
   */
  public final Lease lease(LeaseTerms terms) {
    return Lease.acquire(session, terms);
  }

  /**
   * Does the same as {@link #lease(LeaseTerms)} with {@link LeaseTerms#of}.
   *
   * @param axes names or numbers of the axes. None: the whole device
   * @return the lease
   * @throws LeaseHeld if the axes are not free
   */
  public final Lease lease(String... axes) {
    return lease(LeaseTerms.of(axes));
  }

  /**
   * Closes the connection, and ends all calls and threads of this object. Motions continue. Leases
   * that were not released expire.
   */
  @Override
  public final void close() {
    session.connection().close();
  }
}
