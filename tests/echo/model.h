// An echo machine: it needs the same time for each line.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/jobs/model.h"

namespace axisgate::echo {

inline constexpr Duration kLineTime = std::chrono::milliseconds(20);
inline constexpr std::string_view kAbort = "STOP\n";

// Lines of a part, each with its LF, and the byte of the job after each.
struct PreparedText final : public jobs::PreparedJob {
  struct Line {
    std::string text;
    std::uint64_t end = 0;
  };
  std::vector<Line> lines;

  jobs::TimeRange takes() const override;
  jobs::RunOn run_on() const override;
};

class EchoModel final : public jobs::Model {
 public:
  explicit EchoModel(std::string name) : name_(std::move(name)) {}

  std::string_view name() const override { return name_; }
  std::string_view configured_name() const override { return name_; }
  std::string_view description() const override { return name_; }
  std::optional<int> baud() const override { return 9600; }
  jobs::OriginLimits origin_limits() const override { return {}; }
  jobs::Origin place_of(const jobs::NamedOrigin&) const override { return {}; }

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
  const std::string name_;
};

}  // namespace axisgate::echo
