package axisgate;

import axisgate.v1.Reason;
import com.google.protobuf.Descriptors.EnumDescriptor;

/** Names of enum values, axes and devices. */
final class Names {
  private Names() {}

  static String reason(int number) {
    return enumName(Reason.getDescriptor(), number, "REASON_");
  }

  /**
   * Returns the name of a value without its prefix, or the prefix with the number of an unknown
   * value: "REASON 99".
   */
  static String enumName(EnumDescriptor type, int number, String prefix) {
    var value = type.findValueByNumber(number);
    if (value == null) {
      return prefix.substring(0, prefix.length() - 1) + " " + number;
    }
    return value.getName().substring(prefix.length());
  }

  /** Returns the configured name of an axis, or its number as text. */
  static String axis(String name, int number) {
    return name.isEmpty() ? Integer.toString(number) : name;
  }

  /** Returns "devices/stage" for "stage". */
  static String resource(String device) {
    return device.startsWith("devices/") ? device : "devices/" + device;
  }

  /** Returns "stage" for "devices/stage". */
  static String device(String resource) {
    return resource.substring(resource.indexOf('/') + 1);
  }

  /** Returns the part of a resource's name after the last slash. */
  static String last(String resource) {
    return resource.substring(resource.lastIndexOf('/') + 1);
  }
}
