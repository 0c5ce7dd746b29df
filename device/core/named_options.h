// Options of a simulated device by name: one for each place that a manual leaves open, its first value the default.
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

// Not thread safe. What `names` and `device` point to outlives this.
class NamedOptions {
 public:
  // `device` as refusals name it: "simulated SHRC-203".
  NamedOptions(std::span<const OptionName> names, std::string_view device);

  // Unknown names and values are refused, naming the possible ones.
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
