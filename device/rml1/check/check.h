// A Check reads a whole job, plays it, times it and judges it, in bounded memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/bounds.h"
#include "device/jobs/extent.h"
#include "device/rml1/check/judge.h"
#include "device/rml1/check/opening.h"
#include "device/rml1/check/profile_judge.h"
#include "device/rml1/check/state_judge.h"
#include "device/rml1/check/workload.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/move_time.h"

namespace axisgate::rml1 {

struct CheckOptions {
  std::optional<jobs::Origin> origin;  // nullopt: only sizes are judged
  std::optional<jobs::Stock> stock;
  std::vector<KnownMachine> others;
  std::optional<double> tool_mm{};  // diameter, above 0
  // Name of the machine for which the job was made, if its maker named one; empty: the job itself shows it.
  std::string made_for{};
};

// Lengths are steps of the workpiece system.
struct Summary {
  jobs::Point final;    // real place of the tool
  jobs::Bounds bounds;  // bounds of the driven path, without the height at which the job begins
  jobs::Bounds cut;     // bounds of the part of the driven path that cuts
  double seconds_low = 0, seconds_high = 0;
  // Part of seconds_high: descent from the height at which the job begins; 0 if the origin is known.
  double seconds_down = 0;
  double distance_mm = 0, cutting_mm = 0;
  std::uint64_t spin_ups = 0;
  jobs::Reach rpm;  // while cutting
  std::uint64_t commands = 0;
};

std::string time_text(const Summary& summary);  // "45 s to 1 min 30 s"
// Returns the reason why the two times differ: "at full speed throughout, or by a mill that stops at each point ...".
std::string time_reason(const Summary& summary, const Profile& profile);

class Check : private MachineListener, private ParserListener {
 public:
  // `moves` receives each real move, and the paths that clipping leaves out. The referenced objects must outlive this
  // one.
  Check(const Profile& profile, CheckOptions options, MoveListener* moves = nullptr);

  // Takes over the workpiece as `before` has left it, with the depths already cut. Call once, before feed().
  void continues(Check& before) { workload_.continues(before.workload_); }
  void feed(std::string_view bytes);
  void finish();

  // Reports whether the file is not a job but G-code, a picture or a page, for instance: this is then the only
  // diagnostic.
  bool is_other_file() const;
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const Summary& summary() const { return summary_; }  // call after finish()
  const std::vector<Section>& sections() const { return workload_.sections(); }
  const jobs::Leaves& leaves() const { return state_judge_.leaves(); }
  const std::optional<double>& tool_mm() const { return options_.tool_mm; }
  std::optional<double> speed_not_reached() const { return profile_judge_.speed_not_reached(); }  // mm/s
  const Machine& machine() const { return machine_; }
  jobs::Extent extent() const;  // call after finish()

 private:
  void execute(const Instruction& instruction) override;
  void quit() override { machine_.quit(); }
  void moved(const Move& move) override;
  void waited(Wait what, double seconds, std::uint64_t end) override;
  void commanded(const jobs::Point& from, const jobs::Point& target, bool height_alone, const Instruction& by) override;
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
