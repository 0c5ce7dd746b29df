package axisgate;

/**
 * A Caller is this program, as the daemon identifies it.
 *
 * @param name name of the caller, such as "unix anna"
 * @param role "observer", "operator" or "admin"
 */
public record Caller(String name, String role) {}
