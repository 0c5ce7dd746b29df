package axisgate;

import java.util.List;
import java.util.Optional;

/**
 * An Executed has the answers of the controller to lines.
 *
 * @param answers answers, one for each line
 * @param motion motion that the lines started, which may continue. Empty: no motion
 */
public record Executed(List<String> answers, Optional<Motion> motion) {}
