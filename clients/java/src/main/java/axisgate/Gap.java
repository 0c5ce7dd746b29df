package axisgate;

/**
 * A Gap means that events were missed, because they are no longer kept.
 *
 * @param resumeRevision revision of the event with which the series continues
 */
public record Gap(long resumeRevision) implements EventOrGap {}
