#include "tests/rml1/random_jobs.h"

#include <fmt/format.h>

#include <array>

namespace axisgate::rml1 {
namespace {

std::size_t below(std::mt19937& random, std::size_t limit) {
  return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
}

// Returns a command for a speed from 0.0 to 19.9 mm/s.
std::string speed_command(std::mt19937& random) {
  constexpr std::array kNames = {"F", "V", "VS", "!VZ"};
  const auto tenths = below(random, 200);
  return fmt::format("{}{}.{}", kNames.at(below(random, kNames.size())), tenths / 10, tenths % 10);
}

// Returns a turn by a small angle, so that turns do not dominate a job's time. U is an axis that no profile has.
std::string turn_command(std::mt19937& random) {
  const int degrees = std::uniform_int_distribution(-90, 90)(random);
  return fmt::format("!ZE{}{}", below(random, 4) == 0 ? "U" : "A", degrees);
}

std::string command(std::mt19937& random) {
  constexpr std::array kFlat = {"PU", "PD", "PA", "PR", "M", "R", "D", "I", "^PU", "pd"};
  constexpr std::array kOtherCommands = {"Z", "!ZZ", "!ZEX", "!ZEZ", "H",   "IN",  "DF", "F",   "V",   "W", "@",
                                         "J", "!PZ", "!ZM",  "!ZO",  "!MC", "!RC", "VS", "!VZ", "!DW", "Q"};
  const bool flat = below(random, 2) == 0;
  std::string text =
      flat ? kFlat.at(below(random, kFlat.size())) : kOtherCommands.at(below(random, kOtherCommands.size()));
  for (std::size_t count = below(random, 7), i = 0; i < count; ++i) {
    if (i > 0) text += below(random, 4) == 0 ? " " : ",";
    text += std::to_string(std::uniform_int_distribution(-15000, 15000)(random));
    if (flat && below(random, 5) == 0) text += ".137";
  }
  return text;
}

}  // namespace

std::string random_job(std::mt19937& random) {
  std::string job;
  for (std::size_t commands = 1 + below(random, 12); commands > 0; --commands) {
    const auto kind = below(random, 10);
    job += kind == 0 ? speed_command(random) : kind == 1 ? turn_command(random) : command(random);
    job += below(random, 4) == 0 ? "\r\n" : below(random, 10) == 0 ? "" : ";";
  }
  return job;
}

}  // namespace axisgate::rml1
