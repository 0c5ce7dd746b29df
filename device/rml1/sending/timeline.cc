#include "device/rml1/sending/timeline.h"

#include "device/rml1/diagnostic.h"
#include "device/rml1/parser.h"
#include "device/rml1/planner.h"

namespace axisgate::rml1 {
namespace {

class Recorder : public MachineListener {
 public:
  Recorder(const Profile& profile, std::optional<Origin> origin, Diagnostics& diagnostics, std::vector<Step>& steps)
      : profile_(profile),
        steps_(steps),
        slowest_(profile.acceleration.worst, profile.acceleration.corner_mm, 1 + profile.acceleration.slower),
        machine_(profile, origin, diagnostics, *this) {}

  Machine& machine() { return machine_; }

 private:
  void moved(const Move& move) override {
    const Point way = (move.to - move.from) * profile_.step_mm;
    const double before = slowest_.finish();
    slowest_.move(way, move.speed, 0);
    steps_.push_back({move.end, static_cast<float>(length(way) / move.speed),
                      static_cast<float>(slowest_.finish() - before), move.turning});
  }
  void waited(Wait what, double seconds, std::uint64_t end) override {
    const auto least = static_cast<float>(seconds);
    const bool rests = what == Wait::spin_up;  // until then, and how long that takes is not known
    const double slower = what == Wait::turn ? 1 + profile_.acceleration.slower : 1;
    steps_.push_back(
        {end, rests ? 0 : least, static_cast<float>(seconds * slower), !rests && machine_.spindle_turns()});
  }
  // A mill may dwell before each point of a list (guideline 3-1 W, "when the cutting direction changes").
  void commanded(const Point&, const Point&, bool, const Instruction& by) override {
    if (by.first || machine_.dwell_s() == 0) return;
    steps_.push_back({by.end, 0, static_cast<float>(machine_.dwell_s()), machine_.spindle_turns()});
  }
  void lifted(double, const Instruction&) override {}

  const Profile& profile_;
  std::vector<Step>& steps_;
  Planner slowest_;
  Machine machine_;
};

}  // namespace

Timeline::Timeline(std::string_view job, const Profile& profile, std::optional<Origin> origin) {
  Diagnostics diagnostics;
  Recorder recorder(profile, origin, diagnostics, steps_);
  Parser parser(profile.dialect, diagnostics, recorder.machine());
  parser.feed(job);
  parser.finish();
  turns_at_end_ = recorder.machine().spindle_turns();
  for (const Step& step : steps_) {
    least_s_ += step.least_s;
    most_s_ += step.most_s;
  }
}

}  // namespace axisgate::rml1
