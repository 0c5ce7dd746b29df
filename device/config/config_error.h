// A mistake in a file that a person has written, with its line.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace axisgate {

struct ConfigError {
  std::string file;
  std::uint32_t line = 0;  // 0: the whole file
  std::string key;         // "device.axis.unit"; empty if the error concerns no key
  std::string message;
};
std::string to_string(const ConfigError& error);  // `lab.toml:12: device.axis.unit: ...`

template <class T>
using Configured = tl::expected<T, std::vector<ConfigError>>;

}  // namespace axisgate
