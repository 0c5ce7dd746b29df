// Whatever the job, the tool stays in the work area, and its time is a time.
#include <cmath>
#include <cstdlib>

#include "device/rml1/check.h"
#include "tests/fuzz/mutator.h"
#include "tests/rml1/mill.h"

namespace {

using namespace axisgate::rml1;

class Guard : public MachineListener {
 public:
  explicit Guard(const Profile& profile) : profile_(profile) {}

  void moved(const Move& move) override {
    const bool known = std::isfinite(move.speed) && move.speed > 0 && move.from != move.to;
    if (!known || (check != nullptr && !within(move))) std::abort();
  }
  void turned(double seconds, const Move&) override { require(seconds); }
  void spun_up(double seconds) override { require(seconds); }
  void dwelt(double seconds) override { require(seconds); }
  void commanded(const Point&, const Instruction&) override {}
  void lifted(double, const Instruction&) override {}

  const Check* check = nullptr;

 private:
  static void require(double seconds) {
    if (!std::isfinite(seconds) || seconds < 0) std::abort();
  }
  bool within(const Move& move) const {
    const Box& box = check->machine().box();
    return box.held(move.from) == move.from && box.held(move.to) == move.to;
  }

  const Profile& profile_;
};

void require(bool good) {
  if (!good) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Profile profile = test_profile();
  CheckOptions options;
  // Some with an origin, some without; both follow from the job.
  if (size % 3 != 0) options.origin = Origin{static_cast<double>(size % 400), 100, static_cast<double>(size % 60)};
  if (size % 2 != 0) options.stock = Stock{50, 40, 3};
  Guard guard(profile);
  Check check(profile, options, &guard);
  guard.check = &check;
  check.feed({reinterpret_cast<const char*>(data), size});
  check.finish();
  const Summary& summary = check.summary();
  require(std::isfinite(summary.seconds_high) && std::isfinite(summary.distance_mm));
  require(summary.seconds_low >= 0 && summary.seconds_low <= summary.seconds_high * (1 + 1e-9) + 1e-9);
  require(check.machine().box().held(summary.final) == summary.final);
  require(check.diagnostics().kept().size() <= Diagnostics::kKept);
  return 0;
}
