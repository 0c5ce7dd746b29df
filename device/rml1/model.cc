#include "device/rml1/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <utility>

#include "device/rml1/language/warning.h"
#include "device/rml1/mill/approach.h"
#include "device/rml1/mill/by_hand.h"
#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/mill/prepared_job.h"
#include "device/rml1/mill/queued_check.h"
#include "device/rml1/sending/pace_meter.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1 {
namespace {

// Rounds, because a quotient such as 203.2 / 0.025 is not always computed as a whole number.
std::int64_t whole_steps(const Profile& profile, double mm) {
  constexpr double kRounding = 1e-6;
  return static_cast<std::int64_t>(std::floor(profile.steps(mm) + kRounding));
}

// Returns the bytes of the part that the mill may have been sent.
std::string_view sent_of(const jobs::PartToPrepare& part) {
  const jobs::Job& job = part.job;
  if (job.executed) return part.bytes.substr(0, job.executed->most.offset);
  const bool known = job.written && job.written->most >= part_begin(job);
  return known ? part.bytes.substr(0, job.written->most - part_begin(job)) : part.bytes;
}

}  // namespace

// Heights are machine coordinates.
jobs::OriginLimits MillModel::origin_limits() const {
  const double bottom = profile_.top - profile_.up * std::round(profile_.steps(profile_.z_mm));
  return {whole_steps(profile_, profile_.x_mm), whole_steps(profile_, profile_.y_mm),
          std::llround(std::min(profile_.top, bottom)), std::llround(std::max(profile_.top, bottom))};
}

jobs::Origin MillModel::place_of(const jobs::NamedOrigin& origin) const {
  const double z0 = origin.z ? static_cast<double>(*origin.z) : profile_.default_z0;
  return {static_cast<double>(origin.x) * profile_.step_mm, static_cast<double>(origin.y) * profile_.step_mm,
          std::abs(profile_.top - z0) * profile_.step_mm};
}

Result<std::string> MillModel::machine_named(std::string_view name) const {
  using boost::algorithm::iequals;
  if (name == configured_name_ || iequals(name, profile_.name)) return profile_.name;
  std::string names;
  for (const KnownMachine& other : others_) {
    if (iequals(name, other.name)) return other.name;
    names += (names.empty() ? "" : ", ") + boost::algorithm::to_lower_copy(other.name);
  }
  return fail(Reason::invalid_request, fmt::format("there is no profile \"{}\"", name),
              fmt::format("profiles are {}", names));
}

Result<void> MillModel::check_warning_name(std::string_view name) const {
  if (warning_named(name)) return {};
  return fail(Reason::invalid_request, fmt::format("there is no warning \"{}\" that could be accepted", name),
              fmt::format("warnings are {}", all_warning_names()));
}

std::unique_ptr<jobs::Check> MillModel::make_check(const jobs::CheckOptions& options) const {
  return std::make_unique<QueuedCheck>(
      profile_, CheckOptions{options.origin, options.stock, others_, std::nullopt, options.made_for});
}

Result<std::shared_ptr<const jobs::PreparedJob>> MillModel::prepare(const jobs::PartToPrepare& part) const {
  const jobs::Job& job = part.job;
  Result<Approach> approach;
  if (job.setup.from) {
    approach = approach_to(part.bytes, job.setup.from->offset, profile_, part.origin);
    if (!approach) return tl::unexpected(approach.error());
    const auto checked = check_continued(part.bytes, *approach, profile_, part.origin, job.stock);
    if (!checked) return tl::unexpected(checked.error());
  }
  jobs::SendSettings settings = with_pace(part.sending, part.measured);
  settings.streaming = job.streaming.value_or(settings.streaming);
  return std::make_shared<const PreparedJob>(part.bytes, job.setup.digest, profile_, part.origin, settings,
                                             part_begin(job), job.setup.from, *approach);
}

Result<jobs::Place> MillModel::rest_from(const jobs::PartToPrepare& part, std::uint64_t line,
                                         std::uint64_t column) const {
  const auto approach = approach_to(part.bytes, jobs::offset_of(part.bytes, line, column), profile_, part.origin);
  if (!approach) return tl::unexpected(approach.error());
  return check_unchanged(sent_of(part), *approach, profile_, part.origin)
      .and_then([&] { return check_continued(part.bytes, *approach, profile_, part.origin, part.job.stock); })
      .map([&] { return approach->at; });
}

Result<Duration> MillModel::longest(const jobs::HandAct& act, double slack) const {
  return words_of(act, profile_, slack).map([](const HandCommands& words) { return words.longest; });
}

std::unique_ptr<jobs::Machine> MillModel::make_machine(const jobs::MachineSettings& settings, FlowLink& line,
                                                       jobs::MachineEvents& events, use::Permission& permission) const {
  return std::make_unique<MillController>(profile_, settings, line, events, permission);
}

std::unique_ptr<Simulation> MillModel::make_simulation(const Words& options, std::size_t buffer, double slower_percent,
                                                       ByteLink& line) const {
  simulator::Options chosen;
  for (const auto& [name, value] : options) (void)chosen.set(name, value);  // checked before
  return std::make_unique<simulator::Simulator>(
      simulator::MillSetup{profile_, std::move(chosen), buffer, simulator::Flow::none, slower_percent}, line);
}

}  // namespace axisgate::rml1
