// CPU time of a question and of a move: with the simulated controller alone, and through the gateway's core. The time
// on the line is virtual, so nothing waits. Compare only figures of one run: their difference is the share of the core.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

#include "device/shrc203/controller.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203 {
namespace {

using simulator::Simulator;

// A Cable keeps the bytes that were sent to a machine until deliver() or take() is called.
class Cable : public ByteLink {
 public:
  void write(std::string_view bytes) override { waiting_.append(bytes); }
  void reopen(Duration) override {}
  bool deliver(LineMachine& to, TimePoint now) {
    if (waiting_.empty()) return false;
    const std::string bytes = std::exchange(waiting_, {});
    to.receive(bytes, now);
    return true;
  }
  std::string take() { return std::exchange(waiting_, {}); }

 private:
  std::string waiting_;
};

class Nobody : public EventSink {
 public:
  void on_event(const Event&, TimePoint) override {}
};

// Simulator without a gateway, asked as by a program that owns the port.
class Alone {
 public:
  Alone() : device_({}, answers_) { device_.link_up(now_); }

  std::string ask(std::string_view line) {
    device_.receive(line, now_);
    std::string answer;
    while ((answer = answers_.take()).empty()) pass();
    return answer;
  }
  void wait_until_ready() {
    while (ask("!:\r\n") != "R\r\n") now_ += std::chrono::milliseconds(50);
  }

 private:
  void pass() {
    now_ = std::max(now_, device_.next_deadline().value_or(now_ + std::chrono::milliseconds(1)));
    device_.advance(now_);
  }

  Cable answers_;
  Simulator device_;
  TimePoint now_{std::chrono::seconds(1)};
};

// Simulator behind the gateway's core.
class Gateway {
 public:
  Gateway() : device_({}, answers_), controller_({}, commands_, nobody_) {
    device_.link_up(now_);
    controller_.link_up(now_);
    run_until([this] { return controller_.state().link == LinkState::up; });
  }

  void question() {
    bool ended = false;
    controller_.execute({{"?:D1"}, context()}, now_,
                        [&](const ExecuteEvent& event) { ended = event.kind == ExecuteEvent::Kind::ended; });
    run_until([&] { return ended; });
  }
  // Waits for one answer while `waiting` other lines wait; each call first adds a line in place of the answered one.
  // All lines are different, because equal questions share an exchange.
  void setting_among(std::size_t waiting) {
    while (begun_ < answered_ + waiting) {
      ++begun_;
      controller_.execute({{fmt::format("D:1S1000F{}R100", 1000 + begun_ % 10'000)}, context()}, now_,
                          [this](const ExecuteEvent& event) { answered_ += event.kind == ExecuteEvent::Kind::ended; });
    }
    run_until([this, before = answered_] { return answered_ > before; });
  }
  void move(std::int64_t target) {
    MotionId id = 0;
    MoveRequest request{{{1, Quantity{{target, 0}, Unit::pulses}, {}}}, false, context()};
    controller_.move(std::move(request), now_, [&](const Result<Motion>& motion) { id = motion.value().id; });
    run_until([&] { return id != 0 && is_outcome(controller_.find_motion(id)->state); });
  }

 private:
  RequestContext context() const { return {.who = "bench", .not_after = now_ + std::chrono::seconds(60)}; }

  void run_until(const std::function<bool()>& done) {
    while (!done()) {
      if (commands_.deliver(device_, now_) || answers_.deliver(controller_, now_)) continue;
      const TimePoint never = TimePoint::max();
      const TimePoint next =
          std::min(device_.next_deadline().value_or(never), controller_.next_deadline().value_or(never));
      now_ = std::max(now_, next);
      device_.advance(now_);
      controller_.advance(now_);
    }
  }

  std::size_t begun_ = 0, answered_ = 0;
  Cable commands_, answers_;
  Nobody nobody_;
  Simulator device_;
  Controller controller_;
  TimePoint now_{std::chrono::seconds(1)};
};

void QuestionDirect(benchmark::State& state) {
  Alone alone;
  for (auto _ : state) benchmark::DoNotOptimize(alone.ask("?:D1\r\n"));
}
BENCHMARK(QuestionDirect)->Unit(benchmark::kMicrosecond);

void QuestionThroughTheCore(benchmark::State& state) {
  Gateway gateway;
  for (auto _ : state) gateway.question();
}
BENCHMARK(QuestionThroughTheCore)->Unit(benchmark::kMicrosecond);

// The cost of sharing the line must not grow with the number of waiting callers: compare the times for 10 and for 250.
void SettingAmongOthers(benchmark::State& state) {
  Gateway gateway;
  for (auto _ : state) gateway.setting_among(static_cast<std::size_t>(state.range(0)));
}
BENCHMARK(SettingAmongOthers)->Arg(10)->Arg(250)->Unit(benchmark::kMicrosecond);

void MoveDirect(benchmark::State& state) {
  Alone alone;
  bool there = false;
  for (auto _ : state) {
    there = !there;
    alone.ask(fmt::format("A:1+P{}\r\n", there ? 1000 : 0));
    alone.ask("G:1\r\n");
    alone.wait_until_ready();
  }
}
BENCHMARK(MoveDirect)->Unit(benchmark::kMicrosecond);

void MoveThroughTheCore(benchmark::State& state) {
  Gateway gateway;
  bool there = false;
  for (auto _ : state) {
    there = !there;
    gateway.move(there ? 1000 : 0);
  }
}
BENCHMARK(MoveThroughTheCore)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace axisgate::shrc203

BENCHMARK_MAIN();
