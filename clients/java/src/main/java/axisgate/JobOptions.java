package axisgate;

import axisgate.v1.JobHeader;
import axisgate.v1.Stock;
import java.util.List;
import java.util.Objects;

/** JobOptions describe a job of a mill. Not thread safe. */
public final class JobOptions {
  private final JobHeader.Builder header = JobHeader.newBuilder();
  private final List<String> tools;

  /**
   * Describes a job at the origin that is set at the panel.
   *
   * @param title text of 1 to 100 bytes
   * @param tools names of the tools, one for each part
   */
  public JobOptions(String title, List<String> tools) {
    header.setTitle(title);
    this.tools = List.copyOf(tools);
  }

  /**
   * Names the origin of the job.
   *
   * @param name name of a configured origin
   * @return these options
   */
  public JobOptions origin(String name) {
    header.setOrigin(name);
    return this;
  }

  /**
   * Accepts warnings of the check.
   *
   * @param warnings names of kinds of warnings, such as "deep-pass"
   * @return these options
   */
  public JobOptions acceptedWarnings(String... warnings) {
    header.clearAcceptedWarnings().addAllAcceptedWarnings(List.of(warnings));
    return this;
  }

  /**
   * Describes the size of the workpiece.
   *
   * @param x size to the right
   * @param y size away from the operator
   * @param z height
   * @return these options
   */
  public JobOptions stock(Distance x, Distance y, Distance z) {
    Stock.Builder stock = Stock.newBuilder().setX(Distance.message(x)).setY(Distance.message(y));
    header.setStock(stock.setZ(Distance.message(z)));
    return this;
  }

  JobHeader header(String device, List<byte[]> parts) {
    Objects.requireNonNull(parts);
    if (parts.isEmpty() || parts.size() != tools.size()) {
      throw new IllegalArgumentException(
          "there are " + tools.size() + " tools for " + parts.size() + " parts of the job");
    }
    JobHeader.Builder complete = header.clone().setDevice(device);
    for (int at = 0; at < parts.size(); at++) {
      complete.addPartsBuilder().setTool(tools.get(at)).setBytes(parts.get(at).length);
    }
    return complete.build();
  }
}
