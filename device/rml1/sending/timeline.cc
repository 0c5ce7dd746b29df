#include "device/rml1/sending/timeline.h"

#include <algorithm>

#include "device/rml1/diagnostic.h"
#include "device/rml1/move_time.h"
#include "device/rml1/parser.h"

namespace axisgate::rml1 {
namespace {

class Recorder : public MachineListener {
 public:
  Recorder(const Profile& profile, std::optional<Origin> origin, Diagnostics& diagnostics, std::vector<Step>& steps)
      : profile_(profile),
        knows_height_(origin.has_value()),
        steps_(steps),
        machine_(profile, origin, diagnostics, *this) {}

  Machine& machine() { return machine_; }

 private:
  void moved(const Move& move) override {
    const Point way = (move.to - move.from) * profile_.step_mm;
    StepTime time = move_time(length(way), move.speed, profile_.acceleration);
    // Where Z0 is not known, nobody knows from how high the tool comes down at first.
    const bool unknown = !knows_height_ && !moved_ && way.x == 0 && way.y == 0;
    moved_ = true;
    if (unknown) time.least = 0;
    add(move.end, time, move.turning, length(way));
  }
  void waited(Wait what, double seconds, std::uint64_t end) override {
    const bool rests = what == Wait::spin_up;  // until then
    add(end, wait_time(what, seconds, profile_.acceleration), !rests && machine_.spindle_turns());
  }
  void commanded(const Point&, const Point&, bool, const Instruction& by) override {
    if (by.first || machine_.dwell_s() == 0) return;
    add(by.end, dwell_between_points(machine_.dwell_s()), machine_.spindle_turns());
  }
  void lifted(double, const Instruction&) override {}

  void add(std::uint64_t end, const StepTime& time, bool turning, double mm = 0) {
    steps_.push_back({end, static_cast<float>(time.least), static_cast<float>(time.most),
                      static_cast<float>(time.slowest), static_cast<float>(mm), turning});
  }

  const Profile& profile_;
  const bool knows_height_;
  std::vector<Step>& steps_;
  Machine machine_;
  bool moved_ = false;
};

}  // namespace

Timeline::Timeline(std::string_view job, const Profile& profile, std::optional<Origin> origin) {
  Diagnostics diagnostics;
  Recorder recorder(profile, origin, diagnostics, steps_);
  Parser parser(profile.dialect, diagnostics, recorder.machine());
  parser.feed(job);
  parser.finish();
  turns_at_end_ = recorder.machine().spindle_turns();
  for (const Step& step : steps_) slowest_s_ += step.slowest_s;
}

double Timeline::slowest_after(std::uint64_t executed) const {
  double seconds = 0;
  for (auto step = std::ranges::upper_bound(steps_, executed, {}, &Step::end); step != steps_.end(); ++step) {
    seconds += step->slowest_s;
  }
  return seconds;
}

}  // namespace axisgate::rml1
