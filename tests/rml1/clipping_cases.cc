#include "tests/rml1/clipping_cases.h"

namespace axisgate::rml1 {
namespace {

// Returns a mill with X 0 to 1000, Y 0 to 1000, Z -1000 to 500.
Profile small_mill() {
  Profile profile = test_profile();
  profile.x_mm = profile.y_mm = 10;
  profile.z_mm = 15;
  profile.default_z1 = -200;
  profile.default_z2 = 300;
  return profile;
}

std::string jobs(const Paragraph& geometry, bool judged) {
  std::string job;
  bool begun = false;
  for (const auto& [mark, words] : geometry.lines) {
    begun = begun || mark == "begin";
    if (mark == "job" && begun == judged) job += words;
  }
  return job;
}

}  // namespace

ClippingCase play_case(const Paragraph& geometry) {
  constexpr jobs::Origin kOrigin{0, 0, 5};
  const std::string before = jobs(geometry, false);
  const Played beginning = play(before, small_mill(), kOrigin);
  ClippingCase played;
  played.job = before + jobs(geometry, true);
  played.whole = play(played.job, small_mill(), kOrigin);
  played.begin = beginning.moves.size();
  played.commanded = {beginning.final};
  const auto& all = played.whole.commanded;
  played.commanded.insert(played.commanded.end(), all.begin() + static_cast<std::ptrdiff_t>(beginning.commanded.size()),
                          all.end());
  return played;
}

}  // namespace axisgate::rml1
