// A whole job: read, played, timed and judged, in bounded memory.
#pragma once

#include <cstdint>
#include <optional>
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
  Bounds bounds;  // of where it really was; X and Y from the first move in them on
  double seconds_low = 0, seconds_high = 0;
  double distance_mm = 0, cutting_mm = 0;
  std::uint64_t spin_ups = 0;
  std::uint64_t commands = 0;
};

class Check : private MachineListener {
 public:
  // `moves` hears of each real move, too. Everything referred to outlives this.
  Check(const Profile& profile, CheckOptions options, MachineListener* moves = nullptr);

  void feed(std::string_view bytes);
  void finish();

  bool is_g_code() const { return g_code_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  const Summary& summary() const { return summary_; }  // after finish()
  const Machine& machine() const { return machine_; }

 private:
  void moved(const Move& move) override;
  void turned(double seconds, const Move& beside) override;
  void spun_up(double seconds) override;
  void dwelt(double seconds) override;
  void commanded(const Point& target, const Instruction& by) override;
  void lifted(double steps, const Instruction& by) override;

  bool refuse_g_code(std::string_view bytes);
  void pause(double seconds);
  double arrival(std::uint64_t end) const;

  const Profile& profile_;
  MachineListener* moves_;
  Diagnostics diagnostics_;
  JobKind kind_;
  JobKind::Told told_ = JobKind::Told::nothing_yet;
  bool g_code_ = false;
  Machine machine_;
  Parser parser_;
  Judge judge_;
  Planner best_, worst_;
  Summary summary_;
  bool plane_known_ = false;
};

}  // namespace axisgate::rml1
