#include "device/rml1/sending/timeline.h"

#include <algorithm>
#include <iterator>

#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/machine/move_time.h"

namespace axisgate::rml1 {
namespace {

class Recorder : public MachineListener {
 public:
  Recorder(const Profile& profile, std::optional<jobs::Origin> origin, Diagnostics& diagnostics,
           std::vector<Step>& steps)
      : profile_(profile),
        knows_z0_(origin.has_value()),
        steps_(steps),
        machine_(profile, origin, diagnostics, *this) {}

  Machine& machine() { return machine_; }

 private:
  void moved(const Move& move) override {
    add(move.end, move_time(move, profile_, knows_z0_), move.turning, length(move.to - move.from) * profile_.step_mm);
  }
  void waited(Wait what, double seconds, std::uint64_t end) override {
    const bool rests = what == Wait::spin_up;  // the spindle does not turn at the beginning of its spin-up
    add(end, wait_time(what, seconds, profile_.acceleration), !rests && machine_.spindle_turns());
  }
  void commanded(const jobs::Point&, const jobs::Point&, bool, const Instruction& by) override {
    if (by.first || machine_.dwell_s() == 0) return;
    add(by.end, dwell_between_points(machine_.dwell_s()), machine_.spindle_turns());
  }
  void lifted(double, const Instruction&) override {}

  void add(std::uint64_t end, const StepTime& time, bool turning, double mm = 0) {
    steps_.push_back({end, static_cast<float>(time.least), static_cast<float>(time.most),
                      static_cast<float>(time.slowest), static_cast<float>(mm), 0, turning});
  }

  const Profile& profile_;
  const bool knows_z0_;
  std::vector<Step>& steps_;
  Machine machine_;
};

}  // namespace

Timeline::Timeline(std::string_view job, const Profile& profile, std::optional<jobs::Origin> origin) {
  Diagnostics diagnostics;
  Recorder recorder(profile, origin, diagnostics, steps_);
  Parser parser(profile.dialect, diagnostics, recorder.machine());
  parser.feed(job);
  parser.finish();
  turns_at_end_ = recorder.machine().spindle_turns();
  for (Step& step : steps_) step.slowest_until_s = slowest_s_ += step.slowest_s;
}

double Timeline::slowest_until(std::uint64_t end) const {
  const auto next = std::ranges::upper_bound(steps_, end, {}, &Step::end);
  return next == steps_.begin() ? 0 : std::prev(next)->slowest_until_s;
}

}  // namespace axisgate::rml1
