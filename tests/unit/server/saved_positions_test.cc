// Names of saved positions: their numbers are assigned and freed again, and the names outlive the daemon.
#include "server/devices/saved_positions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace axisgate::server::saved_positions_test {
namespace {

using testing::ElementsAre;
using testing::Pair;

class SavedPositionsTest : public testing::Test {
 protected:
  SavedPositionsTest() : path_(testing::TempDir() + "axisgate-positions-" + std::to_string(::getpid())) { open(); }
  ~SavedPositionsTest() override { ::unlink(path_.c_str()); }

  void open() {
    auto opened = SavedPositions::open(path_);
    ASSERT_TRUE(opened) << opened.error().message;
    positions_ = *std::move(opened);
  }
  static SavedPosition position(const std::string& name, int number, bool place = true,
                                const std::string& device = "stage") {
    return {device,
            name,
            place,
            number,
            {{1, 100}, {2, -20'000}, {3, 0}},
            std::chrono::sys_seconds(std::chrono::seconds(1'800'000'000)),
            "unix anna maria",
            "2106001001",
            Frame{3, 4, {1, 0, 0}, {}}};
  }
  void keep(const SavedPosition& position) {
    const auto kept = positions_->keep(position);
    EXPECT_TRUE(kept) << kept.error().message;
  }
  int number(const std::string& name, bool place = true, const std::string& device = "stage") {
    const auto taken = positions_->take_number(device, name, place, false);
    return taken ? **taken : 0;
  }
  void write(const std::string& text) { std::ofstream(path_) << text; }
  std::string file() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  std::string why_not_opened() {
    const auto opened = SavedPositions::open(path_);
    return opened ? "opened" : std::string(name(opened.error().reason)) + ": " + opened.error().message;
  }

  std::string path_;
  std::unique_ptr<SavedPositions> positions_;
};

TEST_F(SavedPositionsTest, OutliveTheDaemon) {
  keep(position("sample", 3));
  keep(position("Park_2-b", 1, false));
  EXPECT_EQ(file(),
            "# axisgate positions 1: device name kind number coordinates saved serial who\n"
            "stage Park_2-b coordinates 1 1:100,2:-20000,3:0 1800000000 2106001001 unix anna maria\n"
            "stage sample place 3 1:100,2:-20000,3:0 1800000000 2106001001 unix anna maria\n");
  open();
  const auto found = positions_->find("stage", "sample");
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->place);
  EXPECT_EQ(found->number, 3);
  EXPECT_THAT(found->coordinates, ElementsAre(Pair(1, 100), Pair(2, -20'000), Pair(3, 0)));
  EXPECT_EQ(found->saved.time_since_epoch().count(), 1'800'000'000);
  EXPECT_EQ(found->who, "unix anna maria");
  EXPECT_EQ(found->serial_number, "2106001001");
  EXPECT_FALSE(found->frame) << "epochs count from 1 in every run of the daemon";
  EXPECT_FALSE(positions_->find("stage", "Park_2-b")->place);
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST_F(SavedPositionsTest, AreForgotten) {
  keep(position("sample", 3));
  ASSERT_TRUE(positions_->forget("stage", "sample"));
  EXPECT_FALSE(positions_->find("stage", "sample"));
  EXPECT_TRUE(positions_->forget("stage", "sample"));
  open();
  EXPECT_TRUE(positions_->list("stage").empty());
}

TEST_F(SavedPositionsTest, AreOfOneDevice) {
  keep(position("sample", 1));
  keep(position("sample", 1, true, "other"));
  keep(position("a", 2));
  EXPECT_EQ(positions_->list("stage").size(), 2u);
  EXPECT_EQ(positions_->list("stage").front().name, "a");
  ASSERT_TRUE(positions_->forget("stage", "sample"));
  EXPECT_TRUE(positions_->find("other", "sample"));
}

TEST_F(SavedPositionsTest, ANameKeepsItsNumberAndOthersGetTheLowest) {
  keep(position("b", 2));
  EXPECT_EQ(number("b"), 2);
  EXPECT_EQ(number("a"), 1);
  keep(position("a", 1));
  EXPECT_EQ(number("c"), 3);
  EXPECT_EQ(number("c", false), 1) << "places and coordinates are numbered each by themselves";
  EXPECT_EQ(number("b", false), 1);
  EXPECT_EQ(number("c", true, "other"), 1);
}

TEST_F(SavedPositionsTest, ANumberIsTakenWhileItIsBeingSaved) {
  auto first = positions_->take_number("stage", "a", true, false);
  const auto second = positions_->take_number("stage", "b", true, false);
  EXPECT_EQ(**first, 1);
  EXPECT_EQ(**second, 2);
  EXPECT_EQ(positions_->take_number("stage", "a", true, true).error().reason, Reason::invalid_request);
  first = SavedPositions::Number();
  EXPECT_EQ(number("c"), 1);
}

TEST_F(SavedPositionsTest, ThereAreTwentyOfEachKind) {
  for (int i = 1; i <= 20; ++i) {
    const std::string name = "p" + std::to_string(i);
    ASSERT_EQ(number(name), i);
    keep(position(name, i));
  }
  EXPECT_EQ(positions_->take_number("stage", "more", true, false).error().reason, Reason::queue_full);
  EXPECT_EQ(number("p7"), 7);
  EXPECT_EQ(number("more", false), 1);
  ASSERT_TRUE(positions_->forget("stage", "p7"));
  EXPECT_EQ(number("more"), 7);
}

TEST_F(SavedPositionsTest, Names) {
  for (const char* name : {"a", "1", "-", "_x", "aaaaaaaaaabbbbbbbbbbccccccccccdddddddddd"}) {
    EXPECT_TRUE(is_position_name(name)) << name;
  }
  for (const char* name : {"", "a b", "a.b", "a/b", "a\n", "Bär", "aaaaaaaaaabbbbbbbbbbccccccccccdddddddddde"}) {
    EXPECT_FALSE(is_position_name(name)) << name;
    EXPECT_EQ(positions_->take_number("stage", name, true, false).error().reason, Reason::invalid_request) << name;
  }
  keep(position("a", 1));
  EXPECT_EQ(positions_->take_number("stage", "a", true, true).error().reason, Reason::invalid_request);
}

TEST_F(SavedPositionsTest, WhereTheControllerWasSeenToHoldIt) {
  const SavedPosition saved = position("a", 1);
  keep(saved);
  EXPECT_EQ(positions_->find("stage", "a")->frame, saved.frame);
  positions_->held_in(saved, Frame{5, 6, {}, {}});
  EXPECT_EQ(positions_->find("stage", "a")->frame->device_epoch, 5u);
  // The name now means another position.
  SavedPosition other = saved;
  other.coordinates[1] = 7;
  keep(other);
  positions_->held_in(saved, {});
  EXPECT_TRUE(positions_->find("stage", "a")->frame);
}

TEST_F(SavedPositionsTest, WhatCannotBeWrittenIsNot) {
  auto nowhere = SavedPositions::open("/proc/axisgate/positions");
  ASSERT_TRUE(nowhere);
  EXPECT_EQ((*nowhere)->keep(position("a", 1)).error().reason, Reason::internal);
  EXPECT_TRUE((*nowhere)->list("stage").empty());
}

// A bad line is an error: no line is skipped silently or read in part.
TEST_F(SavedPositionsTest, ALineThatIsNoneIsNamed) {
  const std::string good = "stage a place 1 1:100,2:0 1800000000 2106001001 unix anna\n";
  for (const std::string& bad :
       {std::string("stage b place 2 1:100,2:0 1800000000\n"), std::string("stage b place 21 1:1 18 2106001001 anna\n"),
        std::string("stage b plaice 2 1:1 18 2106001001 anna\n"),
        std::string("stage b place 2 1:1,1:2 18 2106001001 anna\n"),
        std::string("stage b place 2 9:1 18 2106001001 anna\n"),
        std::string("stage b place 2 1:x 18 2106001001 anna\n"), std::string("stage b place 2 1 18 2106001001 anna\n"),
        std::string("stage b.c place 2 1:1 18 2106001001 anna\n"),
        std::string("stage b place two 1:1 18 2106001001 anna\n")}) {
    write("# axisgate positions 1\n" + good + bad);
    EXPECT_EQ(why_not_opened(), "INTERNAL: " + path_ + ":3: is no saved position") << bad;
  }
  const std::string twice = "INTERNAL: " + path_ + ":2: its name or its number is used above already";
  write(good + "stage a place 2 1:1 18 2106001001 anna\n");
  EXPECT_EQ(why_not_opened(), twice);
  write(good + "stage b place 1 1:1 18 2106001001 anna\n");
  EXPECT_EQ(why_not_opened(), twice);
  write(good + "stage b coordinates 1 1:1 18 2106001001 anna\n");
  EXPECT_EQ(why_not_opened(), "opened");
}

TEST(FrameOfAState, ChangesWithWhateverChangesCoordinates) {
  stage::State state;
  state.device_epoch = 1;
  state.frame_epoch = 1;
  state.axes[0].controllable = true;
  state.axes[0].scale = Scale{{10, 0}, false};
  const Frame before = frame_of(state);
  EXPECT_EQ(frame_of(state), before);
  state.axes[0].position_pulses = 5;
  EXPECT_EQ(frame_of(state), before);
  stage::State other = state;
  other.frame_epoch = 2;
  EXPECT_NE(frame_of(other), before);
  other = state;
  other.device_epoch = 2;
  EXPECT_NE(frame_of(other), before);
  other = state;
  other.axes[0].homings = 1;
  EXPECT_NE(frame_of(other), before);
  other = state;
  other.axes[0].scale = Scale{{5, 0}, false};
  EXPECT_NE(frame_of(other), before);
}

}  // namespace
}  // namespace axisgate::server::saved_positions_test
