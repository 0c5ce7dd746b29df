// Tests of the picture of a job as a file: the text of the title, and the part of the job already done.
#include "device/rml1/picture/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "device/rml1/check/check.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A picture with the given title of two cut lines, 10 and 20 mm long.
class Drawn {
 public:
  explicit Drawn(const std::string& title, const jobs::PlaceRange& executed = {}) : strokes_(executed) {
    check_.feed("PU1000,1000;PD2000,1000;\nPD2000,3000;PU;");
    check_.finish();
    picture_.emplace(make_picture(title, {&check_}, profile_, {}, true, strokes_));
  }
  const Picture& picture() const { return *picture_; }

 private:
  const Profile profile_ = test_profile();
  Strokes strokes_;
  Check check_{profile_, {.origin = jobs::Origin{0, 0, 30}, .stock = {}, .others = {}}, &strokes_};
  std::optional<Picture> picture_;
};

TEST(Svg, ATitleIsTextAndNothingElse) {
  EXPECT_THAT(to_svg(Drawn("a<b>&\"c").picture()), HasSubstr("a&#60;b&#62;&#38;&#34;c"));
  EXPECT_THAT(to_svg(Drawn("tab\t, unit\x1F, space ").picture()), HasSubstr("tab?, unit?, space "));
}

std::vector<std::string> texts(const Picture& picture) {
  std::vector<std::string> all;
  for (const Picture::Label& label : picture.labels) all.push_back(label.text);
  return all;
}

std::vector<Strokes::Done> done_of(const Picture& picture) {
  std::vector<Strokes::Done> all;
  for (const Strokes::Stroke& stroke : picture.strokes->all()) all.push_back(stroke.done);
  return all;
}

// The tool travels 14.1 mm along and across, and 1 mm down to Z1 of -100 steps: test_profile().
TEST(WhatRemains, IsAllByDefault) {
  const Drawn drawn("job");
  EXPECT_THAT(done_of(drawn.picture()), Each(Strokes::Done::no));
  EXPECT_THAT(texts(drawn.picture()), Not(Contains(AnyOf(StartsWith("done"), HasSubstr("remains")))));
  EXPECT_THAT(to_svg(drawn.picture()), Not(HasSubstr("class=\"done\"")));
}

TEST(WhatRemains, BeginsAtThePlaceOrBehindIt) {
  const Drawn drawn("job", {{0, 2, 1}, {0, 2, 1}});
  EXPECT_THAT(texts(drawn.picture()),
              AllOf(Contains("job: what remains on the test mill"), Contains("done"), Not(Contains("perhaps done")),
                    Contains(StartsWith("done up to line 2, column 1: ")), Contains(EndsWith(" driven, 11 mm cutting")),
                    Contains(EndsWith(" driven, 21 mm cutting"))));
  const std::string svg = to_svg(drawn.picture());
  EXPECT_THAT(svg, HasSubstr("class=\"done\""));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"perhaps\"")));
}

TEST(WhatRemains, OfARangeIsPerhapsDone) {
  const Drawn drawn("job", {{0, 1, 13}, {0, 2, 1}});
  EXPECT_THAT(texts(drawn.picture()),
              AllOf(Not(Contains("done")), Contains("travel"), Contains("perhaps done"),
                    Contains(StartsWith("done up to line 1, column 13: ")),
                    Contains(StartsWith("perhaps done up to line 2, column 1: ")), Contains(StartsWith("remains: "))));
  EXPECT_THAT(to_svg(drawn.picture()), HasSubstr("class=\"perhaps\""));
}

// Each set of a list counts by the place where it begins.
TEST(WhatRemains, OfAListOfCoordinates) {
  const Profile profile = test_profile();
  Strokes strokes({{0, 1, 13}, {0, 1, 13}});
  Check check(profile, {.origin = jobs::Origin{0, 0, 30}, .stock = {}, .others = {}}, &strokes);
  check.feed("PA;PD100,200,300,400;");
  check.finish();
  ASSERT_FALSE(strokes.all().empty());
  EXPECT_EQ(strokes.all().front().done, Strokes::Done::yes);
  EXPECT_EQ(strokes.all().back().done, Strokes::Done::no);
}

}  // namespace
}  // namespace axisgate::rml1
