// Fuzzer of parser and machine, for any job: the tool stays in the work area, the duration is valid, and the job can be
// drawn.
#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

#include "device/rml1/picture/picture.h"
#include "tests/fuzz/mutator.h"
#include "tests/fuzz/require.h"
#include "tests/rml1/mill.h"

namespace {

using namespace axisgate;
using namespace axisgate::rml1;
using axisgate::require;

bool ordered(const Box& box) {
  return box.lowest.x <= box.highest.x && box.lowest.y <= box.highest.y && box.lowest.z <= box.highest.z;
}

class Guard : public MoveListener {
 public:
  void moved(const Move& move) override {
    strokes.moved(move);
    const Box& box = check->machine().box();
    require(ordered(box));
    require(box.held(move.from) == move.from && box.held(move.to) == move.to);
    require(std::isfinite(move.speed) && move.speed > 0 && move.from != move.to);
  }

  const Check* check = nullptr;
  Strokes strokes;
};

// Random choices that depend on the job only: the same job always gives the same choices, nearly every other job gives
// different ones.
class Choice {
 public:
  explicit Choice(std::string_view job) : dice_(static_cast<std::uint32_t>(job.size() + 1)) {
    for (const char c : job.substr(0, 8))
      dice_.seed(static_cast<std::uint32_t>(dice_() + static_cast<unsigned char>(c)));
  }
  std::size_t below(std::size_t count) { return dice_() % count; }
  bool yes() { return below(2) == 0; }

 private:
  std::minstd_rand dice_;
};

Profile chosen_profile(Choice& choice) {
  Profile profile = test_profile();
  if (choice.yes()) profile.baud = 9600;
  profile.holds_flat_commands = choice.yes();
  if (choice.yes()) profile.up = -1;
  profile.rotary->hundredths = choice.yes();
  if (choice.yes()) profile.dialect.tolerated = {"J", "!0", "!1"};
  if (choice.yes()) profile.dialect.apart = {"XZ", "YA"};
  if (choice.yes()) profile.default_z2 = 0;
  return profile;
}

CheckOptions chosen_options(Choice& choice) {
  CheckOptions options;
  if (choice.below(3) != 0) {
    options.origin = jobs::Origin{static_cast<double>(choice.below(400)), 100, static_cast<double>(choice.below(60))};
  }
  if (choice.yes()) options.stock = jobs::Stock{50, 40, 3};
  if (choice.yes()) options.others = {{"other mill", 0.025, 155}};
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view job(reinterpret_cast<const char*>(data), size);
  Choice choice(job);
  const Profile profile = chosen_profile(choice);
  const CheckOptions options = chosen_options(choice);
  Guard guard;
  Check check(profile, options, &guard);
  guard.check = &check;
  const std::size_t piece = choice.below(3) == 0 ? 1 : choice.yes() ? 7 : size + 1;
  for (std::size_t begin = 0; begin < size; begin += piece) check.feed(job.substr(begin, piece));
  check.finish();
  const Summary& summary = check.summary();
  require(std::isfinite(summary.seconds_high) && std::isfinite(summary.distance_mm));
  require(summary.seconds_low >= 0 && summary.seconds_low <= summary.seconds_high * (1 + 1e-9) + 1e-9);
  require(ordered(check.machine().box()));
  require(check.machine().box().held(summary.final) == summary.final);
  const bool known = options.origin.has_value();
  require(!to_svg(make_picture("job", {&check}, profile, options.stock, known, guard.strokes)).empty());
  // The limit exceeds the number of places in the code that report a diagnostic.
  require(check.diagnostics().kept().size() <= 64 * Diagnostics::kSame);
  return 0;
}
