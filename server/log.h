// The daemon's log: lines on standard error, collected and written in portions. spdlog is included by log.cc alone:
// formatting with it takes each file that does so three seconds to compile.
#pragma once

#include <fmt/core.h>

#include <utility>

namespace axisgate::server::log {

// Configures the log. A line that warns goes out at once, others within a second. SPDLOG_LEVEL in the environment sets
// what is logged.
void start();
void flush();

enum class Level { debug, info, warn, error, critical };

// Thread safe. Formats only what the configured level lets through.
void write(Level level, fmt::string_view format, fmt::format_args arguments);

// The rest write one line each.
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
