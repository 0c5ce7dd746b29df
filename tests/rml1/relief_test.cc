// Tests of the surface that cuts leave, seen from above: the cut places, their colours, and the light.
#include "device/rml1/picture/relief.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

using testing::HasSubstr;
using testing::Not;

// Returns a job with nine depths along X, 10 mm apart. A step is 0.01 mm: test_profile(). The tool has 2 mm.
std::string nine_depths() {
  std::string job = "Z0,0,0;";
  for (int i = 1; i <= 9; ++i)
    job += fmt::format("Z{0},0,50;Z{0},0,-{1};Z{0},2000,-{1};Z{0},2000,50;", i * 1000, i * 10);
  return job;
}

class Seen {
 public:
  explicit Seen(const std::string& job, std::optional<double> tool_mm = {}) {
    check_.emplace(profile_, CheckOptions{.origin = {}, .stock = {}, .others = {}, .tool_mm = tool_mm}, &strokes_);
    check_->feed(job);
    check_->finish();
    picture_.emplace(make_picture("job", {&*check_}, profile_, {}, false, strokes_));
  }
  const Picture& picture() const { return *picture_; }
  // Returns the pixel at a place in steps.
  std::uint32_t at(double x, double y) const {
    const Picture::View& view = picture_->views[0];
    const Relief relief(strokes_, *picture_->shades, picture_->diameters, view);
    const double cells = static_cast<double>(relief.width()) / view.frame.width;
    const auto column = static_cast<std::size_t>((view.x + x * view.scale - view.frame.x) * cells);
    const auto row = static_cast<std::size_t>((view.y - y * view.scale - view.frame.y) * cells);
    return relief.pixels().at(row * relief.width() + column);
  }

 private:
  const Profile profile_ = test_profile();
  Strokes strokes_;
  std::optional<Check> check_;
  std::optional<Picture> picture_;
};

std::uint32_t colour_of(int shade) {
  return 0xff000000U |
         static_cast<std::uint32_t>(std::stoul(kShadeColours.at(static_cast<std::size_t>(shade)) + 1, nullptr, 16));
}

TEST(Reliefs, AreOfJobsWithManyDepths) {
  EXPECT_TRUE(Seen(nine_depths()).picture().relief);
  EXPECT_FALSE(Seen("Z0,0,50;Z0,0,-10;Z900,0,-10;Z900,0,50;").picture().relief);
  EXPECT_THAT(to_svg(Seen(nine_depths()).picture()), HasSubstr("href=\"data:image/png;base64,iVBORw0KGgo"));
}

TEST(Reliefs, FlatGroundHasTheColourOfItsDepth) {
  const Seen seen(nine_depths());
  EXPECT_EQ(seen.at(1000, 1000), colour_of(kShallowest)) << "0.1 mm deep, the least";
  EXPECT_EQ(seen.at(9000, 1000), colour_of(kShallowest + kDepths - 1)) << "0.9 mm deep, the most";
  EXPECT_EQ(seen.at(1500, 1000), 0u) << "nothing is cut there";
}

// The default is a tool of 2 mm, 1 mm on each side of the path.
TEST(Reliefs, AreAsWideAsTheTool) {
  EXPECT_NE(Seen(nine_depths()).at(1080, 1000), 0u);
  EXPECT_EQ(Seen(nine_depths()).at(1120, 1000), 0u);
  EXPECT_NE(Seen(nine_depths(), 6).at(1280, 1000), 0u);
}

// Light comes from the upper left. A groove's wall on that side turns away from the light.
TEST(Reliefs, LightComesFromTheUpperLeft) {
  const Seen seen("Z0,0,0;Z0,0,-10;Z4000,0,-1600;Z8000,0,-1600;Z12000,0,-10;" + nine_depths());
  const auto light = [&](double x) {
    const std::uint32_t one = seen.at(x, 0);
    return (one >> 16 & 255) + (one >> 8 & 255) + (one & 255);
  };
  EXPECT_LT(light(500), light(11500)) << "descending to the right, and rising";
}

TEST(Reliefs, TheDeepestCutIsSeen) {
  std::string job = nine_depths();
  job += "Z1000,0,50;Z1000,0,-90;Z1000,2000,-90;Z1000,2000,-20;Z1000,0,-20;";
  EXPECT_EQ(Seen(job).at(1000, 1000), colour_of(kShallowest + kDepths - 1));
}

TEST(Cuts, HaveTheWidthOfTheToolInTheViewFromAbove) {
  const std::string job = "Z0,0,50;Z0,0,-10;Z900,0,-10;Z900,0,50;";
  const std::string with = to_svg(Seen(job, 0.4).picture());
  EXPECT_THAT(with, HasSubstr("class=\"cut\" stroke-width=\"40\" stroke-linecap=\"round\"")) << "40 steps";
  EXPECT_THAT(with, HasSubstr("class=\"cut\" stroke=\"")) << "as lines from the front and from the side";
  EXPECT_THAT(to_svg(Seen(job).picture()), Not(HasSubstr("stroke-linecap=\"round\" stroke=\"#")));
}

TEST(Tints, DistinguishTheParts) {
  const Profile profile = test_profile();
  Strokes strokes;
  Check first(profile, {}, &strokes);
  first.feed("Z0,0,50;Z0,0,-10;Z900,0,-10;Z900,0,50;");
  first.finish();
  strokes.begin_part();
  Check second(profile, {}, &strokes);
  second.continues(first);
  second.feed("Z0,100,50;Z0,100,-10;Z900,100,-10;Z900,100,50;");
  second.finish();
  const Picture picture = make_picture("job", {&first, &second}, profile, {}, false, strokes);
  std::vector<std::string> legend;
  for (const auto& entry : picture.shades->legend()) legend.push_back(entry.text);
  EXPECT_THAT(legend, testing::ElementsAre("travel", "part 1: 0.10 mm deep", "part 2: 0.10 mm deep"));
  const std::string svg = to_svg(picture);
  EXPECT_THAT(svg, HasSubstr(kShadeColours[kShallowest + kDepths / 2]));
  EXPECT_THAT(svg, HasSubstr(kShadeColours[kShallowest + kDepths + kDepths / 2]));
  EXPECT_THAT(svg, HasSubstr("part 2: "));
}

}  // namespace
}  // namespace axisgate::rml1
