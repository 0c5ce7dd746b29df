// Tests of a job's picture: nothing lies outside its view, and the legend lists exactly the colours shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "device/rml1/picture/picture.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Shown {
 public:
  explicit Shown(const std::string& job, std::optional<jobs::Origin> origin = {}, std::optional<jobs::Stock> stock = {})
      : check_(profile_, {origin, stock, {}}, &strokes_) {
    check_.feed(job);
    check_.finish();
    picture_.emplace(make_picture("job", {&check_}, profile_, stock, origin.has_value(), strokes_));
  }
  const Picture& operator*() const { return *picture_; }
  const Picture* operator->() const { return &*picture_; }

  std::vector<std::string> labels() const {
    std::vector<std::string> texts;
    for (const Picture::Label& label : picture_->labels) texts.push_back(label.text);
    return texts;
  }
  std::vector<std::string> legend() const {
    std::vector<std::string> texts;
    for (const auto& entry : picture_->shades->legend()) texts.push_back(entry.text);
    return texts;
  }
  // Returns the range that a view shows, in steps.
  jobs::Reach across(std::size_t view) const {
    const Picture::View& one = picture_->views[view];
    const double scale = one.scale_across();
    return {true, (one.frame.x - one.x) / scale, (one.frame.x + one.frame.width - one.x) / scale};
  }
  jobs::Reach up(std::size_t view) const {
    const Picture::View& one = picture_->views[view];
    const double scale = one.scale_up();
    return {true, (one.y - one.frame.y - one.frame.height) / scale, (one.y - one.frame.y) / scale};
  }

 private:
  const Profile profile_ = test_profile();
  Strokes strokes_;
  Check check_;
  std::optional<Picture> picture_;
};

const std::string kSquare = "@-50,200;PU1000,1000;PD3000,1000,3000,2000,1000,1000;PU;H;";

bool lies_in(const Picture& picture, const Picture::Rectangle& one) {
  return one.x >= 0 && one.y >= 0 && one.x + one.width <= picture.width && one.y + one.height <= picture.height;
}

TEST(Views, LieOnThePageApartFromEachOther) {
  for (const char* job : {kSquare.c_str(), "@-50,200;PU0,0;PD50000,0;PU;", "@-50,200;PU0,0;PD0,50000;PU;", "Z9,9,-9;",
                          "F5;", "PU99,99;"}) {
    for (const auto& origin : {std::optional<jobs::Origin>(), std::optional<jobs::Origin>(kMidway)}) {
      const Shown shown(job, origin);
      for (const Picture::View& view : shown->views) EXPECT_TRUE(lies_in(*shown, view.frame)) << job;
      for (const Picture::Rectangle& one : shown->rectangles) EXPECT_TRUE(lies_in(*shown, one)) << job;
      EXPECT_LT(shown->views[0].frame.y + shown->views[0].frame.height, shown->views[1].frame.y) << job;
      EXPECT_LT(shown->views[0].frame.x + shown->views[0].frame.width, shown->views[2].frame.x) << job;
    }
  }
}

// Z2 is 200, and the job begins and ends at the top, 6050 above the assumed Z0, or 5000: if the view showed the lifts,
// it would show little of a cut of 50.
TEST(Views, ShowTheCutAndNotTheLift) {
  for (const auto& origin : {std::optional<jobs::Origin>(), std::optional<jobs::Origin>(kMidway)}) {
    const jobs::Reach z = Shown(kSquare, origin).up(1);
    EXPECT_GE(z.highest, 50);
    EXPECT_LE(z.highest, 60);
    EXPECT_LE(z.lowest, -50);
    EXPECT_GE(z.lowest, -70);
  }
}

// The views, with the margins of their scales between them, cover the page except for a corner: the views of Z have the
// size of Z, beside and below the view from above.
TEST(Views, LeaveNoHalfOfThePageWhite) {
  for (const char* job : {"@-50,200;PU0,0;PD3000,0,3000,3000,0,0;PU;", "@-50,200;PU0,0;PD3000,0,3000,1500,0,0;PU;",
                          "@-50,200;PU0,0;PD1500,0,1500,3000,0,0;PU;", "@-50,200;PU0,0;PD9000,0,9000,2000,0,0;PU;"}) {
    const Shown shown(job);
    const Picture::Rectangle& top = shown->views[0].frame;
    const Picture::Rectangle& side = shown->views[2].frame;
    EXPECT_LE(shown->width - (side.x + side.width), 0.2 * shown->width) << job;
    EXPECT_GE(top.width + side.width, 0.6 * shown->width) << job;
    EXPECT_EQ(top.y, side.y) << job;
    EXPECT_EQ(top.height, side.height) << "Y is at the same height in both";
  }
}

// The path ends at 3000, 5 mm from the edge of the cut of a tool of 10 mm.
TEST(Views, ShowCutsInTheirWidth) {
  const Profile profile = test_profile();
  Strokes strokes;
  Check check(profile, {.origin = {}, .stock = {}, .others = {}, .tool_mm = 10}, &strokes);
  check.feed(kSquare);
  check.finish();
  const Picture::View view = make_picture("job", {&check}, profile, {}, false, strokes).views[0];
  EXPECT_GE((view.frame.x + view.frame.width - view.x) / view.scale, 3000 + 500);
}

TEST(Views, CutOffWhatLeavesThem) {
  const std::string svg = to_svg(*Shown(kSquare));
  for (const char* part :
       {"<clipPath id=\"view0\">", "<g clip-path=\"url(#view0)\">", "<g clip-path=\"url(#view2)\">"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
}

// The cuts are 2000 x 1000 steps in an area of 60500, and 1000 from the work origin, which a person uses to clamp the
// workpiece.
TEST(Views, ShowTheCutsAndTheWorkOriginAndNotTheWorkArea) {
  const Shown shown(kSquare, kMidway);
  EXPECT_LT(shown.across(0).lowest, -50);
  EXPECT_GE(shown.across(0).lowest, -200);
  EXPECT_LE(shown.across(0).highest, 3200);
  EXPECT_GT(shown->views[0].frame.width, 400);
  EXPECT_THAT(shown.labels(), Contains(HasSubstr("work area: 605 x 605 mm")));
  const auto is_area = [](const Picture::Rectangle& one) { return one.kind == Picture::Rectangle::Kind::work_area; };
  EXPECT_EQ(std::ranges::count_if(shown->rectangles, is_area), 1);
  EXPECT_THAT(Shown(kSquare).labels(), Not(Contains(HasSubstr("work area:"))));
}

TEST(Views, ShowAFlatJobHigher) {
  const Shown shown("@-50,200;PU0,0;PD20000,0,20000,10000,0,0;PU;");
  EXPECT_GE(shown->views[1].frame.height, 50);
  EXPECT_GT(shown->views[1].stretch, 1);
  EXPECT_THAT(shown.labels(), Contains(fmt::format("front: X, Z (Z {} times as high)", shown->views[1].stretch)));
  EXPECT_THAT(shown.labels(), Contains(fmt::format("side: Z x {}, Y", shown->views[2].stretch)));
}

TEST(Scales, AreInMillimetres) {
  const Shown shown(kSquare);
  EXPECT_THAT(shown.labels(), Contains("20"));
  EXPECT_THAT(shown.labels(),
              Contains(HasSubstr("cuts X 10.00 to 30.00 mm (20.00 mm), Y 10.00 to 20.00 mm (10.00 mm), 0.50 mm deep")));
  const double right = shown->width - 52;  // the margin, at which the bar ends
  const auto bar = std::ranges::find_if(
      shown->lines, [right](const auto& line) { return line.to_x == right && line.from_x < right; });
  ASSERT_NE(bar, shown->lines.end());
  const double mm = (bar->to_x - bar->from_x) / shown->views[0].scale * 0.01;
  EXPECT_THAT(shown.labels(), Contains(fmt::format("{:g} mm", mm)));
}

TEST(Legend, HasTheDepthsThatThereAre) {
  const std::string job = "@-10,200;PU0,0;PD100,0;@-20,200;PU0,0;PD100,0;@-35,200;PU0,0;PD100,0;PU;";
  EXPECT_THAT(Shown(job).legend(), ElementsAre("travel", "0.10 mm deep", "0.20 mm deep", "0.35 mm deep"));
  EXPECT_THAT(Shown("Z0,0,-1;Z99,0,-1;").legend(), ElementsAre("travel", "0.01 mm deep"));
  EXPECT_THAT(Shown("PU99,0;PU0,0;").legend(), ElementsAre("travel"));
}

// Eight ranges from 0.01 to 0.80 mm, of which the second and the third are empty.
TEST(Legend, HasTheRangesThatThereAre) {
  std::string job = "Z0,0,0;";
  for (const int z : {1, 2, 3, 4, 5, 41, 51, 61, 71, 80}) job += fmt::format("Z{},0,0;Z{},0,-{};Z{},0,0;", z, z, z, z);
  EXPECT_THAT(Shown(job).legend(), ElementsAre("travel", "to 0.11 mm deep", "to 0.41 mm deep", "to 0.51 mm deep",
                                               "to 0.61 mm deep", "to 0.71 mm deep", "to 0.80 mm deep"));
}

// A finishing pass of 9 to 11 mm depth throughout has all colours.
TEST(Legend, DividesTheDepthsThatOccur) {
  std::string job = "Z0,0,0;";
  for (int z = 900; z <= 1100; z += 10) job += fmt::format("Z{},0,0;Z{},0,-{};Z{},0,0;", z, z, z, z);
  EXPECT_THAT(Shown(job).legend(), testing::SizeIs(1 + kDepths));
}

// "to 16.00 mm deep" is wider than "0.10 mm deep".
TEST(Legend, TextsEndBeforeTheNextSwatch) {
  std::string job = "Z0,0,0;";
  for (int z = 100; z <= 1600; z += 100) job += fmt::format("Z{},0,0;Z{},0,-{};Z{},0,0;", z, z, z, z);
  const Shown shown(job);
  double before = -1000;
  for (const Picture::Rectangle& one : shown->rectangles) {
    if (one.kind != Picture::Rectangle::Kind::swatch) continue;
    if (one.x > before) {
      EXPECT_GE(one.x - before, 14 + 5 + 16 * 6.0) << "16 figures of 6 pixels, at least";
    }
    before = one.x;
  }
}

TEST(Legend, ShowsTheSpeedOfTheMachineAndOfTheJob) {
  EXPECT_THAT(Shown("VS16.7;!VZ60;" + kSquare).labels(),
              Contains(HasSubstr("cuts at 15 mm/s, 6500 rpm; the job sets up to 60 mm/s")));
  EXPECT_THAT(Shown("VS4;!VZ4;" + kSquare).labels(), Contains("cuts at 4 mm/s, 6500 rpm"));
}

TEST(Reports, StandInThePicture) {
  EXPECT_THAT(Shown(kSquare + "!NR;").labels(), Contains(HasSubstr("warning, line 1: !NR pauses")));
  std::string many = kSquare;
  for (int line = 0; line < 30; ++line) many += "\nQ;";
  const Shown shown(many);
  EXPECT_THAT(shown.labels(), Contains("error, line 2: there is no command \"Q\""));
  EXPECT_THAT(shown.labels(), Contains(testing::MatchesRegex("and [0-9]+ more")));
}

// X ends at 50500; Z at -1050.
TEST(LeftOut, IsMarked) {
  const Shown beside("@-50,200;PU50000,0;PD51000,0;PU;", kMidway);
  EXPECT_THAT(beside.legend(), ElementsAre("travel", "0.50 mm deep", "not driven"));
  EXPECT_THAT(to_svg(*beside), HasSubstr("class=\"left-out\""));
  EXPECT_THAT(to_svg(*beside), HasSubstr("d=\"M50500 0l500 0\""));
  EXPECT_GE(beside.across(0).highest, 51000);
  EXPECT_THAT(Shown("Z0,0,-1100;Z99,0,-1100;", kMidway).legend(), Contains("not driven"));
  EXPECT_THAT(Shown(kSquare, kMidway).legend(), Not(Contains("not driven")));
  EXPECT_THAT(Shown("@-50,200;PU50000,0;PD51000,0;PU;").legend(), Not(Contains("not driven")));
}

TEST(Holes, AreSeenFromAbove) {
  const std::string svg = to_svg(*Shown("Z100,200,50;Z100,200,-30;Z100,200,50;"));
  EXPECT_THAT(svg, HasSubstr("class=\"hole\""));
  EXPECT_THAT(svg, HasSubstr("d=\"M100 200h0\""));
  for (const std::string& job : {kSquare, std::string("Z9,9,50;Z9,9,-30;Z9,9,-60;Z99,9,-60;Z99,9,50;")}) {
    EXPECT_THAT(to_svg(*Shown(job)), Not(HasSubstr("class=\"hole\""))) << job;
  }
}

}  // namespace
}  // namespace axisgate::rml1
