// Curves, rests, approaches and scans, from what callers write to what a controller takes, and what is refused.
#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <utility>
#include <variant>

#include "server/api/stage/paths.h"
#include "server/proto/motions.h"
#include "server/proto/targets.h"

namespace axisgate::rpc {
namespace {

using google::protobuf::TextFormat;
using stage::Curve;
using stage::Rotation;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Message>
Message parsed(const std::string& text) {
  Message message;
  EXPECT_TRUE(TextFormat::ParseFromString(text, &message)) << text;
  return message;
}

stage::Segment segment(const std::string& text) {
  const Result<stage::Segment> result = proto::to_segment(parsed<v1::Segment>(text), api::AxisNames());
  EXPECT_TRUE(result) << text << ": " << result.error().message;
  return result.value_or(stage::Segment{});
}

// "INVALID_REQUEST: message"
std::string refused(const std::string& text) {
  const Result<stage::Segment> taken = proto::to_segment(parsed<v1::Segment>(text), api::AxisNames());
  const Result<void> result = taken ? api::check_segment(*taken) : tl::unexpected(taken.error());
  return result ? "taken" : std::string(name(result.error().reason)) + ": " + result.error().message;
}

std::string written(const Quantity& quantity) { return to_string(quantity.value) + std::string(symbol(quantity.unit)); }

constexpr const char* kCenter =
    "center { axis: \"1\" distance { mm: \"0.05\" } } center { axis: \"2\" distance { um: \"-50\" } }";
constexpr const char* kAround = "rotation: ROTATION_CLOCKWISE turns: 1";
constexpr const char* kPlaneOf13 =
    "center { axis: \"1\" distance { pulses: 1 } } center { axis: \"3\" distance { pulses: 1 } }";

std::string around(const std::string& text, const std::string& rise = "") {
  return "arc { around { " + text + " } " + rise + " }";
}
std::string through(const std::string& text) { return "arc { through { " + text + " } }"; }

TEST(Curves, AroundACenterByTurns) {
  const stage::Segment taken = segment(around(std::string(kCenter) + kAround) + " relative: true");
  EXPECT_TRUE(taken.moves.empty());
  EXPECT_TRUE(taken.relative);
  ASSERT_TRUE(taken.curve);
  EXPECT_THAT(taken.curve->axes, ElementsAre(1, 2));
  EXPECT_FALSE(taken.curve->rise);
  const auto& course = std::get<Curve::Around>(taken.curve->course);
  EXPECT_EQ(written(course.center[0]), "0.05mm");
  EXPECT_EQ(written(course.center[1]), "-50um");
  EXPECT_EQ(course.rotation, Rotation::clockwise);
  EXPECT_EQ(std::get<int>(course.extent), 1);
}

TEST(Curves, AroundACenterByDegreesInPlacesOfAnotherPlane) {
  const stage::Segment taken =
      segment(around("center { axis: \"3\" distance { pulses: 7 } } center { axis: \"2\" distance { pulses: -8 } } "
                     "rotation: ROTATION_COUNTERCLOCKWISE degrees: \"22.5\""));
  EXPECT_FALSE(taken.relative);
  ASSERT_TRUE(taken.curve);
  EXPECT_THAT(taken.curve->axes, ElementsAre(2, 3));
  const auto& course = std::get<Curve::Around>(taken.curve->course);
  EXPECT_EQ(written(course.center[0]), "-8pulse");
  EXPECT_EQ(written(course.center[1]), "7pulse");
  EXPECT_EQ(course.rotation, Rotation::counterclockwise);
  EXPECT_EQ(std::get<Decimal>(course.extent), (Decimal{225, 1}));
}

TEST(Curves, ThroughAPoint) {
  const stage::Segment taken =
      segment(through("point { axis: \"2\" distance { um: \"4\" } } point { axis: \"1\" distance { um: \"3\" } } "
                      "end { axis: \"1\" distance { um: \"5\" } } end { axis: \"2\" distance { um: \"-6\" } }"));
  ASSERT_TRUE(taken.curve);
  EXPECT_THAT(taken.curve->axes, ElementsAre(1, 2));
  const auto& course = std::get<Curve::Through>(taken.curve->course);
  EXPECT_EQ(written(course.point[0]) + " " + written(course.point[1]), "3um 4um");
  EXPECT_EQ(written(course.end[0]) + " " + written(course.end[1]), "5um -6um");
}

TEST(Curves, AHelixRisesAlongAxis3) {
  const std::string text = std::string(kCenter) + "rotation: ROTATION_CLOCKWISE turns: 1000";
  const stage::Segment taken = segment(around(text, "rise { axis: \"3\" distance { um: \"-2\" } }"));
  ASSERT_TRUE(taken.curve && taken.curve->rise);
  EXPECT_EQ(written(*taken.curve->rise), "-2um");
  EXPECT_EQ(std::get<int>(std::get<Curve::Around>(taken.curve->course).extent), 1000);
}

TEST(Curves, WhatIsNoCurveIsRefused) {
  const std::string center = kCenter;
  EXPECT_EQ(refused("arc {}"), "INVALID_REQUEST: an arc has no course");
  EXPECT_EQ(refused(around(kAround)), "INVALID_REQUEST: the center of an arc has two coordinates, not 0");
  EXPECT_EQ(refused(around(center + "center { axis: \"3\" distance { pulses: 1 } }" + kAround)),
            "INVALID_REQUEST: the center of an arc has two coordinates, not 3");
  EXPECT_EQ(
      refused(around("center { axis: \"2\" distance { pulses: 1 } } center { axis: \"2\" distance { pulses: 1 } }")),
      "INVALID_REQUEST: the center of an arc names axis 2 twice");
  EXPECT_EQ(
      refused(around("center { axis: \"1\" distance { pulses: 1 } } center { axis: \"9\" distance { pulses: 1 } }")),
      "UNKNOWN_AXIS: there is no axis \"9\"");
  EXPECT_EQ(refused(around("center { axis: \"1\" distance {} } center { axis: \"2\" distance { pulses: 1 } }")),
            "INVALID_REQUEST: axis 1: a distance has no amount");
  EXPECT_EQ(
      refused(through("point { axis: \"1\" distance { pulses: 1 } } point { axis: \"2\" distance { pulses: 1 } }")),
      "INVALID_REQUEST: the end of an arc has two coordinates, not 0");
  EXPECT_EQ(refused(through("point { axis: \"1\" distance { pulses: 1 } } point { axis: \"2\" distance { pulses: 1 } }"
                            "end { axis: \"1\" distance { pulses: 1 } } end { axis: \"3\" distance { pulses: 1 } }")),
            "INVALID_REQUEST: an arc goes through a point of axes 1 and 2 to an end of axes 1 and 3");
}

TEST(Curves, AnArcAroundACenterSaysWhichWayAndHowFar) {
  const std::string center = kCenter;
  EXPECT_EQ(refused(around(center + "turns: 1")),
            "INVALID_REQUEST: an arc around a center does not say which way round it goes");
  const std::string way = center + "rotation: ROTATION_COUNTERCLOCKWISE ";
  EXPECT_EQ(refused(around(way)), "INVALID_REQUEST: an arc around a center does not say how far it goes");
  EXPECT_EQ(refused(around(way + "turns: 2")), "OUT_OF_RANGE: a circle of 2 turns; in one plane it has 1");
  EXPECT_EQ(refused(around(way + "turns: 0")), "OUT_OF_RANGE: a circle of 0 turns; in one plane it has 1");
  EXPECT_THAT(refused(around(way + "degrees: \"1e\"")), HasSubstr("INVALID_REQUEST: "));
  const std::string rise = "rise { axis: \"3\" distance { pulses: 1 } }";
  for (const char* turns : {"0", "1001", "-1"}) {
    EXPECT_EQ(refused(around(way + "turns: " + turns, rise)),
              "OUT_OF_RANGE: a helix of " + std::string(turns) + " turns; 1 to 1000 are possible");
  }
}

// Manual 74) to 76), 80) to 82): axis setting A alone.
TEST(Curves, NoOtherHelixIsKnown) {
  EXPECT_EQ(refused(around(std::string(kCenter) + kAround, "rise { axis: \"2\" distance { pulses: 1 } }")),
            "INVALID_REQUEST: a helix rises along axis 3, not along axis 2");
  EXPECT_EQ(refused(around(std::string(kPlaneOf13) + kAround, "rise { axis: \"3\" distance { pulses: 1 } }")),
            "INVALID_REQUEST: the circle of a helix is one of axes 1 and 2, not of axes 1 and 3");
  EXPECT_EQ(refused(around(std::string(kCenter) + kAround, "rise { axis: \"3\" }")),
            "INVALID_REQUEST: axis 3: a distance has no amount");
}

TEST(Segments, RestAndWaitForInputs) {
  const std::string way = "single { axis: \"1\" distance { pulses: 1 } } ";
  EXPECT_EQ(segment(way).rest, Duration::zero());
  EXPECT_FALSE(segment(way).inputs);
  EXPECT_EQ(segment(way + "rest_time { seconds: 255 } inputs { on: [1, 2, 3, 4, 5, 6] }").rest, milliseconds(255'000));
  EXPECT_EQ(segment(way + "inputs { on: [6, 1] }").inputs, 33);
  EXPECT_EQ(segment(way + "inputs {}").inputs, 0);
  EXPECT_EQ(
      segment(around(std::string(kCenter) + kAround) + " rest_time { nanos: 1000000 } speed { pulses_per_s: 9 }").rest,
      milliseconds(1));
  EXPECT_EQ(refused(way + "rest_time { seconds: -1 }"), "OUT_OF_RANGE: a time is negative or longer than an hour");
  EXPECT_EQ(refused(way + "rest_time { seconds: 255 nanos: 1000000 }"),
            "OUT_OF_RANGE: a rest of 255001 ms; 0 to 255000 ms are possible");
  EXPECT_EQ(refused(way + "rest_time { nanos: 1 }"), "NOT_REPRESENTABLE: a time of 1 ns is not a whole number of ms");
  EXPECT_EQ(refused(way + "inputs { on: 0 }"), "OUT_OF_RANGE: there is no pin 0");
  EXPECT_EQ(refused(way + "inputs { on: 7 }"), "OUT_OF_RANGE: there is no pin 7");
  EXPECT_EQ(refused("rest_time { seconds: 1 }"), "INVALID_REQUEST: the segment has no shape");
}

TEST(Moves, Approach) {
  const auto move = [](const std::string& approach) {
    return proto::to_move(parsed<v1::MoveRequest>("targets { axis: \"2\" distance { mm: \"1\" } " + approach + " }"),
                          api::AxisNames());
  };
  ASSERT_TRUE(move("approach { um: \"-10\" }"));
  EXPECT_EQ(written(move("approach { um: \"-10\" }")->targets.at(0).approach.value()), "-10um");
  EXPECT_FALSE(move("")->targets.at(0).approach);
  const Result<stage::MoveRequest> from_no_side = api::completed(*move("approach { um: \"0\" }"), {}, {});
  ASSERT_FALSE(from_no_side);
  EXPECT_EQ(from_no_side.error().message, "axis 2: an approach of 0 has no direction");
  EXPECT_EQ(move("approach {}").error().message, "axis 2: a distance has no amount");
}

Result<api::Scan> scan(const std::string& text) {
  return proto::to_scan(parsed<v1::ScanRequest>(text), api::AxisNames());
}

TEST(Scans, AreTakenAsWritten) {
  const auto taken = scan(
      "axis: \"2\" start { mm: \"-1\" } end { um: \"500\" } speed { um_per_s: \"20\" } acceleration_time { nanos: "
      "50000000 } "
      "distance { "
      "pulses: 100 }");
  ASSERT_TRUE(taken);
  const stage::ScanRequest& request = taken->request;
  EXPECT_EQ(request.axis, 2);
  EXPECT_EQ(written(request.from) + " " + written(request.to), "-1mm 500um");
  EXPECT_EQ(written(request.speed.value()), "20um");
  EXPECT_EQ(request.acceleration_ms, 50);
  EXPECT_EQ(std::pair(request.by_scale, written(taken->interval)), std::pair(false, std::string("100pulse")));
  const auto by_scale = scan("axis: \"3\" start { pulses: 9 } end { pulses: 1 } scale_pulses: 2");
  ASSERT_TRUE(by_scale);
  EXPECT_EQ(std::pair(by_scale->request.by_scale, written(by_scale->interval)), std::pair(true, std::string("2pulse")));
  EXPECT_FALSE(by_scale->request.speed || by_scale->request.acceleration_ms);
}

TEST(Scans, WhatIsMissingIsNamed) {
  const auto message = [](const std::string& text) {
    const auto taken = scan(text);
    return taken ? "taken" : std::string(name(taken.error().reason)) + ": " + taken.error().message;
  };
  EXPECT_EQ(message("axis: \"9\""), "UNKNOWN_AXIS: there is no axis \"9\"");
  EXPECT_EQ(message("axis: \"1\" start { pulses: 1 } distance { pulses: 2 }"),
            "INVALID_REQUEST: axis 1: a distance has no amount");
  EXPECT_EQ(message("axis: \"1\" start { pulses: 1 } end { pulses: 2 } speed {} distance { pulses: 2 }"),
            "INVALID_REQUEST: axis 1: a speed has no amount");
  EXPECT_EQ(message("axis: \"1\" start { pulses: 1 } end { pulses: 2 }"),
            "INVALID_REQUEST: a scan does not say how far apart its trigger pulses are");
}

TEST(Scans, AreToldWithWhatIsKnown) {
  stage::Motion motion;
  motion.kind = stage::MotionKind::scan;
  motion.axes = stage::AxisSet::of(1);
  EXPECT_FALSE(proto::to_proto("stage", motion, 1, server::Moment(), proto::Shown(nullptr)).has_scan());
  motion.scan = stage::ScanResult{-200, 1300, 100, 16, 11, {}};
  const v1::Motion running = proto::to_proto("stage", motion, 1, server::Moment(), proto::Shown(nullptr));
  EXPECT_EQ(running.kind(), v1::MOTION_KIND_SCAN);
  EXPECT_EQ(running.scan().run_from_pulses(), -200);
  EXPECT_EQ(running.scan().run_to_pulses(), 1300);
  EXPECT_EQ(running.scan().interval_pulses(), 100);
  EXPECT_EQ(running.scan().expected_triggers(), 16);
  EXPECT_EQ(running.scan().expected_triggers_in_range(), 11);
  EXPECT_FALSE(running.scan().has_observed_triggers());
  motion.scan = stage::ScanResult{0, 0, {}, {}, {}, 0};
  const v1::Motion ended = proto::to_proto("stage", motion, 1, server::Moment(), proto::Shown(nullptr));
  EXPECT_FALSE(ended.scan().has_expected_triggers() || ended.scan().has_expected_triggers_in_range());
  EXPECT_TRUE(ended.scan().has_observed_triggers());
}

}  // namespace
}  // namespace axisgate::rpc
