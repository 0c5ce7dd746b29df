#include "clients/axisctl/arguments/option_bytes.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "device/core/escape.h"
#include "device/core/utf8.h"

namespace axisgate::axisctl {
namespace {

// Reports whether the argument is used on this machine only, so that it may have any bytes: the name of a file, or a
// word of a command that axisctl starts.
bool stays_here(const CLI::App& verb, const CLI::Option& option) {
  const std::string name = option.get_name(), type = option.get_type_name();
  if (verb.get_name() == "run" && name == "COMMAND") return true;  // the command of `lease run`
  return name == "FILE" || type == "FILE" || type == "PROFILE";
}

}  // namespace

std::optional<Failure> not_utf8(const CLI::App& app) {
  for (const CLI::Option* const option : app.get_options()) {
    if (stays_here(app, *option)) continue;
    const auto other = std::ranges::find_if_not(option->results(), is_utf8);
    if (other == option->results().end()) continue;
    return usage(option->get_name() + " is not UTF-8: " + escaped(*other),
                 "type it in a terminal that is set to UTF-8");
  }
  for (const CLI::App* const chosen : app.get_subcommands()) {
    if (const auto other = not_utf8(*chosen)) return other;
  }
  return std::nullopt;
}

}  // namespace axisgate::axisctl
