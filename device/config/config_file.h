// Reads a configuration file as text.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace axisgate {

// Returns the file's text. The error is text for a person and follows the file's name: "cannot be opened: No such file
// or directory".
tl::expected<std::string, std::string> read_config_file(const std::string& path);

}  // namespace axisgate
