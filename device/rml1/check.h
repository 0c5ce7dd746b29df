// A whole job: read, played, timed and judged, in bounded memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/bounds.h"
#include "device/rml1/diagnostic.h"
#include "device/rml1/job_kind.h"
#include "device/rml1/judge.h"
#include "device/rml1/machine.h"
#include "device/rml1/parser.h"
#include "device/rml1/planner.h"

namespace axisgate::rml1 {

struct CheckOptions {
  std::optional<Origin> origin;  // none: only sizes are judged
  std::optional<Stock> stock;
  std::vector<KnownMachine> others;
};

// Steps of the workpiece system.
struct Summary {
  Point final;    // where the tool really is
  Bounds bounds;  // of what was really driven, but for an assumed height at which the job begins
  double seconds_low = 0, seconds_high = 0;
  double distance_mm = 0, cutting_mm = 0;
  std::uint64_t spin_ups = 0;
  Reach rpm;  // at which it cuts
  std::uint64_t commands = 0;
};

std::string time_text(const Summary& summary);  // "45 s to 1 min 30 s"

class Check : private MachineListener {
 public:
  // `moves` receives each real move, too. Everything referred to outlives this.
  Check(const Profile& profile, CheckOptions options, MoveListener* moves = nullptr);

  void feed(std::string_view bytes);
  void finish();

  bool is_g_code() const { return verdict_ == JobKind::Verdict::g_code; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const Summary& summary() const { return summary_; }  // after finish()
  const Machine& machine() const { return machine_; }

 private:
  void moved(const Move& move) override;
  void waited(Wait what, double seconds, std::uint64_t end) override;
  void commanded(const Point& from, const Point& target, bool height_alone, const Instruction& by) override;
  void lifted(double steps, const Instruction& by) override;

  std::string_view recognise(std::string_view bytes);
  double arrival(std::uint64_t end) const;
  bool begins_assumed(const Move& move) const;

  const Profile& profile_;
  MoveListener* moves_;
  bool origin_known_;
  Diagnostics diagnostics_;
  JobKind kind_;
  JobKind::Verdict verdict_ = JobKind::Verdict::nothing_yet;
  std::string held_;  // until the kind is known
  Machine machine_;
  Parser parser_;
  Judge judge_;
  Planner best_, worst_;
  Summary summary_;
  bool begun_ = false;
};

}  // namespace axisgate::rml1
