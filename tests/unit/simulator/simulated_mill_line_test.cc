#include <gmock/gmock.h>

#include <memory>
#include <optional>
#include <string>

#include "device/link/runner.h"
#include "server/devices/line.h"
#include "server/kinds.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::simulated_mill_line_test {
namespace {

using ::testing::HasSubstr;

// The built-in mill, with the test as the host at the other end of its line.
class Mill {
 public:
  Mill(link_test::EventLoop& loop, const std::string& keys) : loop_(loop) {
    const auto config = parse_config(
        "[[device]]\nname = \"m\"\nkind = \"rml1\"\nprofile = \"mdx-20\"\nconnection = \"simulated\"\n" + keys,
        "lab.toml", device_kinds());
    EXPECT_TRUE(config) << to_string(config.error().front());
    line_ = make_line(config->devices.at(0), loop.strand());
    host_.emplace(loop.strand(), line_->opener());
    machine_.emplace(*host_);
    host_->attach(*machine_);
    line_->start();
    host_->start();
    EXPECT_TRUE(loop.run_until([this] { return machine_->count("up") == 1; }));
  }

  void send(const std::string& bytes) {
    host_->post([this, bytes](TimePoint) { host_->write(bytes); });
  }

  Result<std::string> operate(const std::string& command) {
    const auto answer = std::make_shared<std::optional<Result<std::string>>>();
    line_->operate(command, [answer](const Result<std::string>& given) { *answer = given; });
    EXPECT_TRUE(loop_.run_until([&] { return answer->has_value(); }));
    return answer->value_or(fail(Reason::link_down, "no answer", ""));
  }

  bool shows(const std::string& what) {
    const auto state = operate("state");
    return state && state->find(what) != std::string::npos;
  }

  // Waits until the mill shows `what`; returns false after kPatience.
  bool will_show(const std::string& what) {
    const TimePoint limit = monotonic_now() + link_test::kPatience;
    while (monotonic_now() < limit) {
      if (shows(what)) return true;
    }
    return false;
  }

  const Line& line() const { return *line_; }

 private:
  link_test::EventLoop& loop_;
  std::unique_ptr<Line> line_;
  std::optional<Runner> host_;
  std::optional<link_test::RecordingMachine> machine_;
};

TEST(SimulatedMillLine, CarriesOutWhatTheHostWrites) {
  link_test::EventLoop loop;
  Mill mill(loop, "speed = 100\n");
  EXPECT_EQ(mill.line().description(), "built-in simulator, speed 100");
  mill.send("PU400,200;");
  EXPECT_TRUE(mill.will_show("x=400 y=200 "));
  EXPECT_TRUE(mill.shows("errors=none"));
}

TEST(SimulatedMillLine, IsOperatedAsAtItsPanel) {
  link_test::EventLoop loop;
  Mill mill(loop, "");
  EXPECT_TRUE(mill.operate("view"));
  EXPECT_TRUE(mill.shows("paused=view"));
  const auto unknown = mill.operate("lift");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().reason, Reason::invalid_request);
}

TEST(SimulatedMillLine, HasTheBufferOfTheConfiguration) {
  link_test::EventLoop loop;
  Mill mill(loop, "buffer = 20\nwindow = 16\n");
  EXPECT_TRUE(mill.operate("view"));
  mill.send("PU400,200;PU0,0;PU400,200;PU0,0;");
  EXPECT_TRUE(mill.will_show("buffered=20 "));
}

TEST(SimulatedMillLine, HasTheOptionsOfTheConfiguration) {
  link_test::EventLoop loop;
  Mill usual(loop, ""), ignoring(loop, "options = { cover_open = \"ignored\" }\n");
  EXPECT_TRUE(usual.operate("cover open"));
  EXPECT_TRUE(ignoring.operate("cover open"));
  EXPECT_TRUE(usual.shows("paused=cover"));
  EXPECT_TRUE(ignoring.shows("paused=no"));
}

// The usual mill needs half a second, the slower one eleven times as long.
TEST(SimulatedMillLine, IsAsMuchSlowerAsTheConfigurationSays) {
  link_test::EventLoop loop;
  Mill usual(loop, ""), slower(loop, "slower = 1000\n");
  slower.send("PU300,0;");
  usual.send("PU300,0;");
  EXPECT_TRUE(usual.will_show("x=300 "));
  EXPECT_TRUE(slower.shows("moving=yes"));
}

}  // namespace
}  // namespace axisgate::server::simulated_mill_line_test
