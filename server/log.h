// The daemon's log: lines on standard error, collected and written in portions. Only log.cc includes spdlog, since
// formatting with spdlog adds three seconds to the compilation of each file.
#pragma once

#include <fmt/core.h>

#include <utility>

namespace axisgate::server::log {

// Configures the log. Warnings and errors are written at once, other lines within a second. SPDLOG_LEVEL in the
// environment sets the level.
void start();
void flush();

enum class Level { debug, info, warn, error, critical };

// Thread safe. Formats only lines of the configured level or above.
void write(Level level, fmt::string_view format, fmt::format_args arguments);

// Each of the following functions writes one line.
template <class... Arguments>
void line(Level level, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write(level, format, fmt::make_format_args(arguments...));
}

template <class... Arguments>
void debug(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  line(Level::debug, format, std::forward<Arguments>(arguments)...);
}

template <class... Arguments>
void info(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  line(Level::info, format, std::forward<Arguments>(arguments)...);
}

template <class... Arguments>
void warn(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  line(Level::warn, format, std::forward<Arguments>(arguments)...);
}

template <class... Arguments>
void error(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  line(Level::error, format, std::forward<Arguments>(arguments)...);
}

template <class... Arguments>
void critical(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  line(Level::critical, format, std::forward<Arguments>(arguments)...);
}

}  // namespace axisgate::server::log
