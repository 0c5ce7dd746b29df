#include "device/link/simulator_program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

namespace axisgate {

int complain(std::string_view program, int exit_code, const Problem& problem) {
  const char* const end = problem.message.ends_with('.') ? "" : ".";
  fmt::print(stderr, "{}: {}{}{}{}\n", program, problem.message, end, problem.hint.empty() ? "" : " ", problem.hint);
  return exit_code;
}

int complain_of_usage(std::string_view program, std::string message) {
  return complain(program, kSimulatorUsage,
                  {.reason = Reason::invalid_request, .message = std::move(message), .hint = "See --help."});
}

void print_options(std::span<const OptionName> options) {
  fmt::print("Each option's first value is its default.\n");
  for (const OptionName& option : options) fmt::print("{}={}\n", option.name, fmt::join(option.values, "|"));
}

Result<void> set_options(const std::vector<std::string>& settings,
                         const std::function<Result<void>(std::string_view name, std::string_view value)>& set) {
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos) {
      return fail(Reason::invalid_request, fmt::format("--option {}: expected NAME=VALUE", setting),
                  "--list-options prints them.");
    }
    const auto done = set(setting.substr(0, equals), setting.substr(equals + 1));
    if (!done) return done;
  }
  return {};
}

Result<std::optional<SocketFile>> open_control(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return SocketFile::open(path);
}

}  // namespace axisgate
