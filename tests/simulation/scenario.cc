#include "tests/simulation/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace axisgate::simulation {

using namespace shrc203;
using std::chrono::seconds;

Setup quiet() {
  Setup setup;
  setup.profile.baud = setup.baud;
  return setup;
}

Setup shared_by(Permission& permission) {
  auto setup = quiet();
  setup.permission = &permission;
  return setup;
}

MoveRequest move_of(const World& world, const Ways& ways, bool relative) {
  MoveRequest request;
  request.relative = relative;
  request.context = world.context("tester");
  for (const auto& [axis, way] : ways) request.moves.push_back({axis, pulses(way), {}});
  return request;
}

void move_by(World& world, const Ways& ways) { move_for(world, "tester", ways); }

void move_for(World& world, const std::string& who, const Ways& ways) {
  MoveRequest request = move_of(world, ways, true);
  request.context.who = who;
  world.controller().move(std::move(request), world.now(), [](Result<Motion>) {});
}

Reason refusal_of(World& world, const Ways& ways) {
  std::optional<Reason> refusal;
  world.controller().move(move_of(world, ways, true), world.now(), [&](const Result<Motion>& motion) {
    refusal = motion ? Reason::unspecified : motion.error().reason;
  });
  return refusal.value_or(Reason::unspecified);
}

PathRequest line_of(const World& world, int segments) {
  PathRequest path;
  path.context = world.context("tester");
  for (int i = 0; i < segments; ++i) {
    path.segments.push_back({{{1, pulses(i % 2 ? 2000 : -1000), {}}, {2, pulses(2000), {}}}, true, pulses(20000), {}});
  }
  return path;
}

void home(World& world, AxisSet axes) {
  world.controller().home({axes, world.context("tester")}, world.now(), [](Result<Motion>) {});
}

Reason reason_of(const Motion& motion) { return motion.problem ? motion.problem->reason : Reason::unspecified; }

std::vector<std::string> execute(World& world, std::vector<std::string> lines) {
  std::vector<std::string> heard;
  bool over = false;
  const auto hear = [&](const ExecuteEvent& event) {
    if (event.kind == ExecuteEvent::Kind::reply) heard.push_back(event.answer);
    if (event.kind == ExecuteEvent::Kind::completion) heard.push_back("completion " + std::to_string(event.axis));
    if (event.kind != ExecuteEvent::Kind::ended) return;
    over = true;
    if (event.problem) heard.push_back(std::string(name(event.problem->reason)));
  };
  world.controller().execute({std::move(lines), world.context("tester")}, world.now(), hear);
  EXPECT_TRUE(world.run_until([&] { return over; }, seconds(30))) << world.replay();
  return heard;
}

Motion outcome_of(World& world, std::size_t number, Duration limit) {
  const bool ended = world.run_until([&] { return world.outcomes().size() >= number; }, limit);
  EXPECT_TRUE(ended) << "no outcome " << number << "\n" << world.replay();
  EXPECT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
  return ended ? world.outcomes()[number - 1] : Motion{};
}

void moved(World& world, const Ways& ways) {
  const std::size_t before = world.outcomes().size();
  move_by(world, ways);
  EXPECT_EQ(outcome_of(world, before + 1).state, MotionState::succeeded) << world.replay();
}

StopReport stopped(World& world, Duration limit) {
  auto report = std::make_shared<std::optional<StopReport>>();
  world.controller().stop({}, world.context("stopper"), world.now(), [report](const StopReport& r) { *report = r; });
  EXPECT_TRUE(world.run_until([&] { return report->has_value(); }, limit)) << world.replay();
  return report->value_or(StopReport{});
}

int written(World& world, std::string_view prefix, std::size_t first) {
  const auto& lines = world.wire().commands();
  return static_cast<int>(std::count_if(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(),
                                        [&](const std::string& line) { return line.starts_with(prefix); }));
}

int motion_lines(World& world, std::size_t first) {
  int count = 0;
  for (const char* prefix : {"HRT", "ZRT", "H:", "Z:", "M:", "A:", "K:", "MP:", "AP:", "KP:", "J:", "G"}) {
    count += written(world, prefix, first);
  }
  return count - written(world, "GC:", first);
}

std::vector<std::string> prebuffer_lines(World& world, std::size_t first) {
  std::vector<std::string> lines;
  for (std::size_t i = first; i < world.wire().commands().size(); ++i) {
    const std::string& one = world.wire().commands()[i];
    if (one.starts_with("KP:") || one.starts_with("EP:") || one.starts_with("AP:") || one.starts_with("MP:")) {
      lines.push_back(one);
    }
  }
  return lines;
}

void foreign_traffic(World& world, const std::vector<std::string>& lines) {
  world.wire().cut(world.now(), seconds(1));
  for (const auto& line : lines) world.device().receive(line + "\r\n", world.now());
  EXPECT_TRUE(world.run_until_up()) << world.replay();
}

Script drop_first(World& world, LineKind kind, std::string prefix) {
  return [&world, kind, prefix, done = false](LineKind seen, const std::string& line) mutable {
    const std::string& command = kind == LineKind::reply ? world.wire().commands().back() : line;
    if (done || seen != kind || !command.starts_with(prefix)) return Scripted{};
    done = true;
    return Scripted{.drop = true, .delay = {}, .instead = {}};
  };
}

}  // namespace axisgate::simulation
