// State of a job at the place where it continues, found by simulating the commands before this place.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/jobs/leaves.h"
#include "device/rml1/check/state_judge.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

class Prefix : private ParserListener, private MachineListener {
 public:
  // The first command or set of coordinates that begins at the byte `from` of the job or later.
  struct Next {
    jobs::Place begins;
    std::string_view name;  // name of the command
    bool first = true;      // the command begins here, with its name; false: in the middle of its list of coordinates
  };
  // Coordinate system in which the tool's height was commanded. Without an origin, the height cannot be converted to
  // another coordinate system.
  enum class Height { workpiece, machine, top, unknown };
  // Modes that were set since the last DF or IN. `revolutions` (!RC) counts from the beginning of the job, because DF
  // and IN do not reset it.
  struct Modes {
    std::optional<double> plane_speed{}, height_speed{}, dwell_ms{}, z1{}, z2{}, revolutions{};
  };

  // Reads the whole job. `profile` must outlive this object.
  Prefix(std::string_view job, std::uint64_t from, const Profile& profile, std::optional<jobs::Origin> origin);

  const std::optional<Next>& next() const { return next_; }
  bool has_effect() const { return has_effect_; }  // a command begins before `from`
  const Machine& machine() const { return machine_; }
  const Modes& modes() const { return modes_; }
  const jobs::Leaves& leaves() const { return judge_.leaves(); }
  Height height() const { return height_; }
  double machine_height() const { return machine_height_; }  // machine coordinate, valid for Height::machine

 private:
  void execute(const Instruction& instruction) override;
  void quit() override;
  void moved(const Move&) override {}
  void waited(Wait, double, std::uint64_t) override {}
  void commanded(const jobs::Point&, const jobs::Point&, bool, const Instruction&) override {}
  void lifted(double, const Instruction&) override {}

  void take_mode(const Instruction& instruction);
  void take_height(const Instruction& instruction);
  void take_machine_height(const Instruction& instruction);

  const std::uint64_t from_;
  const bool origin_known_;
  Diagnostics diagnostics_;
  Machine machine_;
  StateJudge judge_;
  std::optional<Next> next_;
  bool has_effect_ = false;
  Modes modes_;
  Height height_ = Height::top;
  double machine_height_ = 0;
};

}  // namespace axisgate::rml1
