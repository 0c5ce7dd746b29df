// Tests of the recorder under every fault of the simulated line: the recording has every byte, and the core does the
// same again when fed with it.
#include "device/stage/recording/recorder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "device/shrc203/recording/replay.h"
#include "tests/simulation/callers.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::minutes;
using std::chrono::seconds;

// A Tap between the wire and the gateway keeps the bytes received.
class Tap : public LineMachine {
 public:
  explicit Tap(LineMachine& gateway) : gateway_(gateway) {}
  void link_up(TimePoint now) override { gateway_.link_up(now); }
  void link_down(TimePoint now, std::string_view why) override { gateway_.link_down(now, why); }
  void receive(std::string_view bytes, TimePoint now) override {
    received += bytes;
    gateway_.receive(bytes, now);
  }
  void advance(TimePoint now) override { gateway_.advance(now); }
  std::optional<TimePoint> next_deadline() const override { return gateway_.next_deadline(); }

  std::string received;

 private:
  LineMachine& gateway_;
};

// A world with its recording from the first connect on.
class RecordedWorld {
 public:
  explicit RecordedWorld(Setup setup)
      : header_{.device = setup.profile.name, .baud = setup.profile.baud, .reply_limit = setup.profile.reply_limit},
        recorder_(header_, TimePoint{}, [this](const std::string& line) { lines_.push_back(line); }),
        world_(heard_by(recorder_, std::move(setup))) {
    world_.wire().connect(tap_, world_.device());
  }

  World& world() { return world_; }
  const std::string& received() const { return tap_.received; }
  std::string text() {
    recorder_.flush();
    std::string text = to_text(header_);
    for (const auto& line : lines_) text += line + "\n";
    return text;
  }

 private:
  static Setup heard_by(Recorder& recorder, Setup setup) {
    setup.listener = &recorder;
    return setup;
  }

  RecordingHeader header_;
  std::vector<std::string> lines_;
  Recorder recorder_;
  World world_;
  Tap tap_{world_.controller()};
};

// Returns all bytes of one direction in the recording.
std::string bytes(const Recording& recording, RecordedItem::Kind kind) {
  std::string all;
  for (const auto& line : recording.lines) {
    const auto* exchange = std::get_if<RecordedExchange>(&line.event);
    if (!exchange) continue;
    for (const auto& item : exchange->items) {
      if (item.kind == kind) all += item.text;
    }
  }
  return all;
}

Recording parsed(const std::string& text) {
  auto recording = parse_recording(text);
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? *std::move(recording) : Recording{};
}

std::string line_of(std::string_view text, int number) {
  for (; number > 1; --number) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return std::string(text.substr(0, text.find('\n')));
}

// Returns each difference as text: the line of the recording, the recorded event and what the core did. Empty without a
// difference.
std::string differences(const std::string& text) {
  std::string all;
  for (const auto& one : replay(parsed(text)).differences) {
    all += fmt::format("line {}: {} / {}\n", one.line, one.recorded, one.now);
    for (int line = std::max(1, one.line - 8); line <= one.line + 1; ++line) {
      all += fmt::format("  {}: {}\n", line, line_of(text, line));
    }
  }
  return all;
}

class Recorded : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Recorded, HoldsEveryByteAndIsDoneAgain) {
  RecordedWorld recorded(drawn_setup(GetParam(), Faults::hostile()));
  World& world = recorded.world();
  Callers callers(world, GetParam(), Faults::hostile().mishaps_an_hour);
  callers.act_for(minutes(10));
  callers.become_stationary();
  ASSERT_TRUE(world.violations().empty()) << world.violations().front();

  const std::string text = recorded.text();
  const Recording recording = parsed(text);
  std::string written;
  for (const auto& line : world.wire().commands()) written += line + "\r\n";
  EXPECT_EQ(bytes(recording, RecordedItem::Kind::written), written);
  EXPECT_EQ(bytes(recording, RecordedItem::Kind::received), recorded.received());

  const ReplayReport report = replay(recording);
  EXPECT_EQ(report.exchanges, world.exchanges());
  EXPECT_EQ(differences(text), "");
}

// 7000: a question that waited until no completion was outstanding. 7001: an identity reported twice, the second
// directly after the first. 7002, 7003: an exchange requested just after the line had sent its own question. 20094,
// 20114: two stops that waited for the end of one exchange.
INSTANTIATE_TEST_SUITE_P(Hostile, Recorded,
                         testing::Values(7000, 7001, 7002, 7003, 7004, 7005, 7006, 7007, 20094, 20114));

// A recording that begins when the stage has been in use for a long time.
TEST(RecordedFromTheMiddle, IsDoneAgain) {
  RecordedWorld recorded(drawn_setup(7100, Faults::none()));
  Callers callers(recorded.world(), 7100);
  callers.act_for(minutes(1));
  callers.become_stationary();
  const Recording whole = parsed(recorded.text());
  Recording rest{whole.header, {}};
  int begun = 0;
  for (std::size_t i = 0; i < whole.lines.size(); ++i) {
    if (i % 25 == 24 && rest.header.axes) {
      rest.lines.assign(whole.lines.begin() + static_cast<std::ptrdiff_t>(i), whole.lines.end());
      const ReplayReport report = replay(rest);
      ++begun;
      EXPECT_TRUE(report.differences.empty())
          << fmt::format("begun at line {}, line {}: {} / {}", whole.lines[i].number, report.differences[0].line,
                         report.differences[0].recorded, report.differences[0].now);
      EXPECT_TRUE(report.exchanges > 100 || i + 200 >= whole.lines.size()) << report.exchanges;
    }
    pass(rest.header, whole.lines[i].event);
  }
  EXPECT_GT(begun, 10);
}

// Another reply limit makes the core behave differently, like changed code.
TEST(RecordedOnABadLine, IsNotDoneByAnotherCore) {
  RecordedWorld recorded(drawn_setup(7200, Faults::hostile()));
  Callers callers(recorded.world(), 7200);
  callers.act_for(minutes(1));
  Recording recording = parsed(recorded.text());
  ASSERT_TRUE(replay(recording).differences.empty());
  recording.header.reply_limit *= 2;
  const ReplayReport report = replay(recording);
  EXPECT_GT(report.differences.size(), 0u);
  EXPECT_LE(report.differences.size(), ReplayReport::kDifferencesMax);
}

}  // namespace
}  // namespace axisgate::simulation
