// A mill that reads RML-1, as its profile describes it.
#pragma once

#include <string>
#include <vector>

#include "device/jobs/model.h"
#include "device/rml1/machine/known_machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

class MillModel final : public jobs::Model {
 public:
  // `configured_name`: "mdx-20", or the path of the profile's file. `text`: content of that file.
  MillModel(std::string configured_name, std::string text, Profile profile, std::vector<KnownMachine> others)
      : configured_name_(std::move(configured_name)),
        text_(std::move(text)),
        profile_(std::move(profile)),
        others_(std::move(others)) {}

  std::string_view name() const override { return profile_.name; }
  std::string_view configured_name() const override { return configured_name_; }
  std::string_view description() const override { return text_; }
  std::optional<int> baud() const override { return profile_.baud; }
  jobs::OriginLimits origin_limits() const override;
  jobs::Origin place_of(const jobs::NamedOrigin& origin) const override;

  Result<std::string> machine_named(std::string_view name) const override;
  Result<void> check_warning_name(std::string_view name) const override;
  std::unique_ptr<jobs::Check> make_check(const jobs::CheckOptions& options) const override;

  Result<std::shared_ptr<const jobs::PreparedJob>> prepare(const jobs::PartToPrepare& part) const override;
  Result<jobs::Place> rest_from(const jobs::PartToPrepare& part, std::uint64_t line,
                                std::uint64_t column) const override;
  Result<Duration> longest(const jobs::HandAct& act, double slack) const override;

  std::unique_ptr<jobs::Machine> make_machine(const jobs::MachineSettings& settings, FlowLink& line,
                                              jobs::MachineEvents& events, use::Permission& permission) const override;
  std::unique_ptr<Simulation> make_simulation(const Words& options, std::size_t buffer, double slower_percent,
                                              ByteLink& line) const override;

 private:
  const std::string configured_name_, text_;
  const Profile profile_;
  const std::vector<KnownMachine> others_;
};

}  // namespace axisgate::rml1
