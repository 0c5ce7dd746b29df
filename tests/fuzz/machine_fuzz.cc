// Whatever the job, the tool stays in the work area, its time is a time, and it can be drawn.
#include <cmath>
#include <cstdlib>

#include "device/rml1/picture.h"
#include "tests/fuzz/mutator.h"
#include "tests/rml1/mill.h"

namespace {

using namespace axisgate::rml1;

class Guard : public MoveListener {
 public:
  void moved(const Move& move) override {
    strokes.moved(move);
    const Box& box = check->machine().box();
    const bool inside = box.held(move.from) == move.from && box.held(move.to) == move.to;
    if (!inside || !std::isfinite(move.speed) || move.speed <= 0 || move.from == move.to) std::abort();
  }

  const Check* check = nullptr;
  Strokes strokes;
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
  Guard guard;
  Check check(profile, options, &guard);
  guard.check = &check;
  check.feed({reinterpret_cast<const char*>(data), size});
  check.finish();
  const Summary& summary = check.summary();
  require(std::isfinite(summary.seconds_high) && std::isfinite(summary.distance_mm));
  require(summary.seconds_low >= 0 && summary.seconds_low <= summary.seconds_high * (1 + 1e-9) + 1e-9);
  require(check.machine().box().held(summary.final) == summary.final);
  const bool known = options.origin.has_value();
  require(!to_svg(make_picture("job", check, profile, options.stock, known, guard.strokes)).empty());
  require(check.diagnostics().kept().size() <= Diagnostics::kKept);
  return 0;
}
