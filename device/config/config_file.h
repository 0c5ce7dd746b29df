// A file of the configuration as text.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace axisgate {

// What is wrong is for a person, and follows on the file's name: "cannot be opened: No such file or directory".
tl::expected<std::string, std::string> read_config_file(const std::string& path);

}  // namespace axisgate
