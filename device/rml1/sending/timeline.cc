#include "device/rml1/sending/timeline.h"

#include "device/rml1/diagnostic.h"
#include "device/rml1/parser.h"
#include "device/rml1/planner.h"

namespace axisgate::rml1 {
namespace {

class Recorder : public MachineListener {
 public:
  Recorder(const Profile& profile, std::vector<Step>& steps)
      : profile_(profile),
        steps_(steps),
        slowest_(profile.acceleration.worst, profile.acceleration.corner_mm, 1 + profile.acceleration.slower) {}

 private:
  void moved(const Move& move) override {
    const Point way = (move.to - move.from) * profile_.step_mm;
    const double before = slowest_.finish();
    slowest_.move(way, move.speed, 0);
    steps_.push_back({move.end, static_cast<float>(length(way) / move.speed),
                      static_cast<float>(slowest_.finish() - before), move.turning});
  }
  void waited(Wait what, double seconds, std::uint64_t end) override {
    const auto most = static_cast<float>(seconds);
    const bool rests = what == Wait::spin_up;  // until then, and how long that takes is not known
    const bool turning = !rests && !steps_.empty() && steps_.back().turning;
    steps_.push_back({end, rests ? 0 : most, most, turning});
  }
  void commanded(const Point&, const Point&, bool, const Instruction&) override {}
  void lifted(double, const Instruction&) override {}

  const Profile& profile_;
  std::vector<Step>& steps_;
  Planner slowest_;
};

}  // namespace

Timeline::Timeline(std::string_view job, const Profile& profile, std::optional<Origin> origin) {
  Diagnostics diagnostics;
  Recorder recorder(profile, steps_);
  Machine machine(profile, origin, diagnostics, recorder);
  Parser parser(profile.dialect, diagnostics, machine);
  parser.feed(job);
  parser.finish();
  turns_at_end_ = machine.spindle_turns();
  for (const Step& step : steps_) {
    least_s_ += step.least_s;
    most_s_ += step.most_s;
  }
}

}  // namespace axisgate::rml1
