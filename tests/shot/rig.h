// Test rig with the controller and the simulated unit, connected by a line in virtual time that can lose lines.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/shot/controller.h"
#include "tests/shot/simulated_unit.h"

namespace axisgate::shot2 {

class Rig : public EventSink {
 public:
  explicit Rig(int axes)
      : unit(axes, {}, unit_side_), controller(model_of(axes), {}, gateway_side_, *this, use::everybody_may()) {
    controller.link_up(now);
    run(std::chrono::seconds(2));
  }

  // Runs both ends for this time, event by event.
  void run(Duration time) {
    const TimePoint until = now + time;
    for (int steps = 0;; ++steps) {
      const auto next = next_event();
      if (!next || *next > until) break;
      ASSERT_LT(steps, 100'000) << "time stands still";
      now = std::max(now, *next);
      step();
    }
    now = until;
    step();
  }

  MotionId move(std::map<int, std::int64_t> targets) {
    MoveRequest request{{}, false, {.who = "anna"}};
    for (const auto& [axis, target] : targets) {
      request.moves.push_back({.axis = axis, .distance = pulses(target), .profile = {}});
    }
    controller.move(std::move(request), now, answer());
    return newest();
  }
  MotionId home() {
    controller.home({{}, {.who = "anna"}}, now, answer());
    return newest();
  }
  StageController::OnStarted answer() {
    return [this](const Result<Motion>& started) { answers.push_back(started); };
  }
  MotionId newest() { return controller.motions().empty() ? 0 : controller.motions().back().id; }
  Motion motion(MotionId id) { return controller.find_motion(id).value_or(Motion{}); }
  // Runs until the motion has an outcome, at most a minute, and returns its state.
  MotionState outcome(MotionId id) {
    for (int i = 0; i < 6000 && !is_outcome(motion(id).state); ++i) run(std::chrono::milliseconds(10));
    return motion(id).state;
  }

  template <class What>
  int seen() const {
    return static_cast<int>(
        std::ranges::count_if(events, [](const Event& event) { return std::holds_alternative<What>(event); }));
  }
  int written(const std::string& line) const { return static_cast<int>(std::ranges::count(commands, line + "\r\n")); }

  void on_event(const Event& event, TimePoint) override { events.push_back(event); }

  TimePoint now{std::chrono::seconds(1000)};
  std::vector<Event> events;
  std::vector<Result<Motion>> answers;
  std::vector<std::string> commands;
  int reopened = 0;
  std::string lose_command, lose_answer_to;  // the next line that begins so, or its answer, is lost

 private:
  struct UnderWay {
    TimePoint due;
    std::string bytes;
  };
  class Side : public ByteLink {
   public:
    Side(Rig& rig, bool gateway) : rig_(rig), gateway_(gateway) {}
    void write(std::string_view bytes) override { rig_.send(gateway_, std::string(bytes)); }
    void reopen(Duration wait) override {
      ++rig_.reopened;
      rig_.opens_ = rig_.now + wait;
      rig_.to_unit_.clear();
      rig_.to_gateway_.clear();
    }

   private:
    Rig& rig_;
    bool gateway_;
  };

  static bool lost(std::string& which, const std::string& line) {
    const bool hit = !which.empty() && line.starts_with(which);
    if (hit) which.clear();
    return hit;
  }

  void send(bool by_gateway, std::string bytes) {
    constexpr Duration kWay = std::chrono::milliseconds(2);
    if (by_gateway) {
      commands.push_back(bytes);
      losing_answer_ = lost(lose_answer_to, bytes);
      if (!lost(lose_command, bytes)) to_unit_.push_back({now + kWay, std::move(bytes)});
    } else if (!std::exchange(losing_answer_, false)) {
      to_gateway_.push_back({now + kWay, std::move(bytes)});
    }
  }

  std::optional<TimePoint> next_event() const {
    std::optional<TimePoint> next = controller.next_deadline();
    const auto sooner = [&next](std::optional<TimePoint> at) {
      if (at && (!next || *at < *next)) next = at;
    };
    sooner(unit.next_deadline());
    if (!to_unit_.empty()) sooner(to_unit_.front().due);
    if (!to_gateway_.empty()) sooner(to_gateway_.front().due);
    sooner(opens_);
    return next;
  }

  void step() {
    unit.advance(now);
    if (opens_ && *opens_ <= now) {
      opens_.reset();
      unit.link_up(now);
      controller.link_up(now);
    }
    for (auto* const way : {&to_unit_, &to_gateway_}) {
      while (!way->empty() && way->front().due <= now) {
        const std::string bytes = std::move(way->front().bytes);
        way->pop_front();
        way == &to_unit_ ? unit.receive(bytes, now) : controller.receive(bytes, now);
      }
    }
    controller.advance(now);
  }

  std::deque<UnderWay> to_unit_, to_gateway_;
  std::optional<TimePoint> opens_;
  bool losing_answer_ = false;
  Side gateway_side_{*this, true}, unit_side_{*this, false};

 public:
  SimulatedUnit unit;
  Controller controller;
};

}  // namespace axisgate::shot2
