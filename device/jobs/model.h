// Model of a configured machine that is sent jobs: the language of its jobs, and its technical data.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/simulation.h"
#include "device/core/time.h"
#include "device/jobs/check.h"
#include "device/jobs/hand_act.h"
#include "device/jobs/job.h"
#include "device/jobs/machine.h"
#include "device/jobs/measured_pace.h"
#include "device/jobs/named_origin.h"
#include "device/jobs/origin.h"
#include "device/jobs/send_settings.h"
#include "device/use/permission.h"

namespace axisgate::jobs {

// Bytes of a job's part, and the settings for sending it.
struct PartToPrepare {
  std::string_view bytes;                  // all bytes of the part, checked
  const Job& job;                          // Job::part is this part; JobSetup::from is the place at which it continues
  std::optional<Origin> origin{};          // the origin of the check
  SendSettings sending{};                  // as configured
  std::optional<MeasuredPace> measured{};  // nullopt: no job could measure the pace
};

// Immutable and thread safe.
class Model {
 public:
  virtual ~Model() = default;

  virtual std::string_view name() const = 0;             // "MDX-20"
  virtual std::string_view configured_name() const = 0;  // as in the configuration: "mdx-20", or a path
  virtual std::string_view description() const = 0;  // technical data as text; if it changes, jobs are checked again
  virtual std::optional<int> baud() const = 0;       // nullopt: the line is faster than the machine
  virtual OriginLimits origin_limits() const = 0;
  // Returns the origin in mm. If the origin has no height, Z0 has the height that the machine gives it after power-on.
  virtual Origin place_of(const NamedOrigin& origin) const = 0;

  // Returns the name of a machine that jobs may have been made for. Fails with invalid_request if no machine is called
  // `name`.
  virtual Result<std::string> machine_named(std::string_view name) const = 0;
  // Fails with invalid_request if no warning of a check has this name.
  virtual Result<void> check_warning_name(std::string_view name) const = 0;
  virtual std::unique_ptr<Check> make_check(const CheckOptions& options) const = 0;

  // Prepares a part for sending. Reads the whole part, so do not call it on a device's strand. Fails with
  // invalid_request if the part cannot continue at JobSetup::from.
  virtual Result<std::shared_ptr<const PreparedJob>> prepare(const PartToPrepare& part) const = 0;
  // Returns the place of the first command at this line and column, both counted from 1, or after them. Fails with
  // invalid_request if there is no such command, or if the part cannot continue at it.
  virtual Result<Place> rest_from(const PartToPrepare& part, std::uint64_t line, std::uint64_t column) const = 0;

  // Returns the longest time that an act by hand takes. Fails with out_of_range; too_fast. `slack`: see SendSettings.
  virtual Result<Duration> longest(const HandAct& act, double slack) const = 0;

  // The model and the other arguments must outlive the machine.
  virtual std::unique_ptr<Machine> make_machine(const MachineSettings& settings, FlowLink& line, MachineEvents& events,
                                                use::Permission& permission) const = 0;
  // `options`: must have passed Kind::check_option(). `slower_percent`: by how many percent each motion takes longer
  // than in the model. The model and `line` must outlive the simulation.
  virtual std::unique_ptr<Simulation> make_simulation(const Words& options, std::size_t buffer, double slower_percent,
                                                      ByteLink& line) const = 0;
};

}  // namespace axisgate::jobs
