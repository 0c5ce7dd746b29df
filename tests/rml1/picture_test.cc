// The picture of a job as a file: what the title may hold, and whether it was written.
#include "device/rml1/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "device/rml1/check.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// A square that is cut, drawn under that title.
class Drawn {
 public:
  explicit Drawn(const std::string& title) {
    check_.feed("PU10,10;PD20,10;PD20,20;PU;");
    check_.finish();
    picture_.emplace(make_picture(title, check_, profile_, {}, true, strokes_));
  }
  const Picture& picture() const { return *picture_; }

 private:
  const Profile profile_ = test_profile();
  Strokes strokes_;
  Check check_{profile_, {.origin = Origin{0, 0, 30}, .stock = {}, .others = {}}, &strokes_};
  std::optional<Picture> picture_;
};

TEST(Svg, ATitleIsTextAndNothingElse) {
  EXPECT_THAT(to_svg(Drawn("a<b>&\"c").picture()), HasSubstr("a&#60;b&#62;&#38;&#34;c"));
  EXPECT_THAT(to_svg(Drawn("tab\t, unit\x1F, space ").picture()), HasSubstr("tab?, unit?, space "));
}

TEST(Png, SaysWhetherItWasWritten) {
  const Drawn drawn("job");
  const std::string file = testing::TempDir() + "axisgate-picture-" + std::to_string(::getpid()) + ".png";
  EXPECT_TRUE(write_png(drawn.picture(), file));
  std::ifstream written(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(written), {}};
  EXPECT_THAT(bytes, StartsWith("\x89PNG\r\n"));
  std::filesystem::remove(file);
  EXPECT_FALSE(write_png(drawn.picture(), "/no/such/folder/job.png"));
}

}  // namespace
}  // namespace axisgate::rml1
