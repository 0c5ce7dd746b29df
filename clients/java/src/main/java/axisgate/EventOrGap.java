package axisgate;

/** An EventOrGap is an {@link Event}, or a {@link Gap} if events were missed. */
public sealed interface EventOrGap permits Event, Gap {}
