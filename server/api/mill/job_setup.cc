#include "server/api/mill/job_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

bool has(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

std::string tools_text(const std::vector<jobs::JobPart>& parts) {
  std::vector<std::string> tools;
  for (const jobs::JobPart& part : parts) tools.push_back(part.tool);
  return fmt::format("{}", fmt::join(tools, ", "));
}

// Reports whether the station includes the caller: "unix" includes everybody on the Unix socket, "unix anna" only anna.
bool is_at_station(const server::Mill& mill, std::string_view who) {
  return std::ranges::any_of(mill.config().station, [who](std::string_view place) {
    return who == place || (who.starts_with(place) && who.substr(place.size()).starts_with(' '));
  });
}

}  // namespace

Result<void> check_setup(const server::Mill& mill, const jobs::Job& job) {
  const server::MillConfig& config = mill.config();
  const bool has_origin =
      job.setup.origin.empty() ||
      std::ranges::find(config.origins, job.setup.origin, &jobs::NamedOrigin::name) != config.origins.end();
  const auto has_tool = [&](const jobs::JobPart& part) { return has(config.tools, part.tool); };
  const bool as_checked = job.setup.profile == config.model->name() && has_origin &&
                          job.checked_for == server::checked_for(config, job.setup.origin);
  if (as_checked && std::ranges::all_of(job.parts, has_tool)) return {};
  return fail(
      Reason::setup_changed,
      fmt::format(
          "{} was checked for the profile {}, the origin \"{}\" and the tools {}, and {} is configured otherwise now",
          text_of(job), job.setup.profile, job.setup.origin, tools_text(job.parts), mill.name()),
      "cancel it, and send it again");
}

Result<void> check_at_station(const server::Mill& mill, std::string_view who) {
  if (is_at_station(mill, who)) return {};
  return fail(Reason::not_allowed, fmt::format("{} is not at the station of {}", who, mill.name()),
              fmt::format("confirm as {}: `station` in the configuration", fmt::join(mill.config().station, ", ")));
}

}  // namespace axisgate::api
