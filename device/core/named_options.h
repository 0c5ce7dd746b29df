// Named options of a simulated device, one for each place that a manual leaves open. The first value is the default.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"

namespace axisgate {

struct OptionName {
  std::string_view name;
  std::span<const std::string_view> values;
};

// Not thread safe. The objects that `names` and `device` refer to must outlive this one.
class NamedOptions {
 public:
  // `device`: name of the device in messages, such as "simulated SHRC-203".
  NamedOptions(std::span<const OptionName> names, std::string_view device);

  // Sets an option. Fails with invalid_request if the name or the value is unknown; the hint lists the possible ones.
  Result<void> set(std::string_view name, std::string_view value);
  std::string_view get(std::string_view name) const;  // empty for an unknown name
  bool is(std::string_view name, std::string_view value) const { return get(name) == value; }
  std::string describe() const;  // "busy_scope=axis ..." with every option, to replay a run

 private:
  std::span<const OptionName> names_;
  std::string_view device_;
  std::vector<std::string_view> chosen_;
};

}  // namespace axisgate
