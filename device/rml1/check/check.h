// A whole job: read, played, timed and judged, in bounded memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/check/judge.h"
#include "device/rml1/check/opening.h"
#include "device/rml1/check/profile_judge.h"
#include "device/rml1/check/state_judge.h"
#include "device/rml1/check/workload.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/machine/bounds.h"
#include "device/rml1/machine/extent.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/move_time.h"

namespace axisgate::rml1 {

struct CheckOptions {
  std::optional<Origin> origin;  // none: only sizes are judged
  std::optional<Stock> stock;
  std::vector<KnownMachine> others;
  std::optional<double> tool_mm{};  // the diameter, above 0
  std::string made_for{};           // the name of a machine, as its maker said; empty: it is judged by the job
};

// Steps of the workpiece system.
struct Summary {
  Point final;    // where the tool really is
  Bounds bounds;  // of what was really driven, but for the height at which the job begins
  Bounds cut;     // of what of that cuts
  double seconds_low = 0, seconds_high = 0;
  double seconds_down = 0;  // of seconds_high: from the height at which the job begins, where that is not known
  double distance_mm = 0, cutting_mm = 0;
  std::uint64_t spin_ups = 0;
  Reach rpm;  // at which it cuts
  std::uint64_t commands = 0;
};

std::string time_text(const Summary& summary);  // "45 s to 1 min 30 s"
// Why the two ends differ: "at full speed throughout, or by a mill that stops at each point ...".
std::string time_reason(const Summary& summary, const Profile& profile);

class Check : private MachineListener, private ParserListener {
 public:
  // `moves` receives each real move, and what clipping leaves out. Everything referred to outlives this.
  Check(const Profile& profile, CheckOptions options, MoveListener* moves = nullptr);

  // Takes over the workpiece as `before` has left it, by the tool's depths. Once, before feed().
  void continues(Check& before) { workload_.continues(before.workload_); }
  void feed(std::string_view bytes);
  void finish();

  // G-code, a picture, a page: then this is the only diagnostic.
  bool is_other_file() const;
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const Summary& summary() const { return summary_; }  // after finish()
  const std::vector<Section>& sections() const { return workload_.sections(); }
  const Leaves& leaves() const { return state_judge_.leaves(); }
  const std::optional<double>& tool_mm() const { return options_.tool_mm; }
  std::optional<double> speed_not_reached() const { return profile_judge_.speed_not_reached(); }  // mm/s
  const Machine& machine() const { return machine_; }
  Extent extent() const;  // after finish()

 private:
  void execute(const Instruction& instruction) override;
  void quit() override { machine_.quit(); }
  void moved(const Move& move) override;
  void waited(Wait what, double seconds, std::uint64_t end) override;
  void commanded(const Point& from, const Point& target, bool height_alone, const Instruction& by) override;
  void lifted(double steps, const Instruction& by) override;

  void judge_opening();
  void begin_job();
  void report_no_command();
  double arrival(std::uint64_t end) const;
  void take(const StepTime& time, std::uint64_t end);

  const Profile& profile_;
  const CheckOptions options_;
  MoveListener* moves_;
  Diagnostics diagnostics_;
  Opening opening_;
  std::uint64_t bytes_ = 0;
  Machine machine_;
  Parser parser_;
  Judge judge_;
  ProfileJudge profile_judge_;
  StateJudge state_judge_;
  Workload workload_;
  Summary summary_;
  bool moved_ = false;
};

}  // namespace axisgate::rml1
