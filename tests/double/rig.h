// Test rig with a rotor's controller and a simulated rotor, connected by a line in virtual time that can lose frames.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/double/controller.h"
#include "tests/double/frame.h"
#include "tests/double/simulated_rotor.h"

namespace axisgate::rotor {

// A Porter refuses if the test has set it to, and records each request and each call.
class Porter final : public Permission {
 public:
  Result<void> authorize(const Use& use, TimePoint) override {
    ++asked;
    if (answers_left && (*answers_left)-- == 0) {
      answers_left.reset();
      refusing = true;
    }
    last = use;
    if (!refusing) return {};
    return fail(Reason::lease_held, "somebody else has it");
  }
  void begin(const Use& use, Occupation, TimePoint) override { begun.push_back(use.activity); }
  void due(MotionId, TimePoint) override {}
  void end(MotionId motion, TimePoint) override { ended.push_back(motion); }
  void stop_asked(const Use& stop, const std::vector<Use>&, TimePoint) override { stops.push_back(stop.who); }
  void device_restarted(TimePoint) override { ++restarts; }
  void settings_changed(std::uint64_t) override {}
  Orders advance(TimePoint) override { return std::exchange(orders, {}); }
  void stopped(std::uint64_t order, TimePoint) override { carried_out.push_back(order); }
  void settings_restored(std::uint64_t lease, TimePoint) override { restored.push_back(lease); }
  std::optional<TimePoint> next_deadline() const override {
    return orders.stops.empty() && orders.restoring.empty() ? std::nullopt : std::optional(TimePoint{});
  }

  bool refusing = false;
  std::optional<int> answers_left;  // number of requests to allow before all are refused
  int asked = 0, restarts = 0;
  Use last;
  std::vector<MotionId> begun, ended;
  std::vector<std::string> stops;
  Orders orders;
  std::vector<std::uint64_t> carried_out, restored;
};

class Rig : public EventSink {
 public:
  explicit Rig(bool reversed = false, Profile profile = {}, SimulatedRotor::Options options = {})
      : rotor(options, device_side_), controller(std::move(profile), reversed, gateway_side_, *this, porter) {
    controller.link_up(now);
    run(std::chrono::milliseconds(100));
  }

  // Runs both ends for this time, event by event.
  void run(Duration time) {
    const TimePoint until = now + time;
    for (int steps = 0;; ++steps) {
      const auto next = next_event();
      if (!next || *next > until) break;
      if (steps > 100'000) {
        ADD_FAILURE() << "time stands still: a deadline that has passed is named again and again";
        return;
      }
      now = std::max(now, *next);
      step();
    }
    now = until;
    step();
  }

  // Runs until the motion has an outcome, at most a minute, and returns its state.
  MotionState outcome(MotionId id) {
    for (int i = 0; i < 6000 && !is_outcome(motion(id).state); ++i) run(std::chrono::milliseconds(10));
    return motion(id).state;
  }
  Motion motion(MotionId id) { return controller.find_motion(id).value_or(Motion{}); }

  MotionId move(std::int64_t target, const std::string& who = "anna") {
    controller.move({{AxisMove{.axis = 1, .distance = pulses(target), .profile = {}}}, false, {.who = who}}, now,
                    answer());
    return newest();
  }
  MotionId home() {
    controller.home({{}, {.who = "anna"}}, now, answer());
    return newest();
  }
  MotionId jog(int direction, RequestContext context = {.who = "anna"}) {
    return controller.jog({{{1, direction, {}}}, std::move(context)}, now, answer());
  }
  StageController::OnStarted answer() {
    return [this](const Result<Motion>& started) { answers.push_back(started); };
  }
  Reason refusal() const {
    return answers.empty() || answers.back() ? Reason::unspecified : answers.back().error().reason;
  }
  MotionId newest() {
    const auto all = controller.motions();
    return all.empty() ? 0 : all.back().id;
  }

  // Returns how many frames with this opcode the controller has written.
  int written(Opcode opcode) const {
    return static_cast<int>(std::ranges::count_if(commands, [opcode](const std::string& bytes) {
      return static_cast<std::uint8_t>(bytes[1]) == static_cast<std::uint8_t>(opcode);
    }));
  }

  template <class What>
  int told() const {
    return static_cast<int>(
        std::ranges::count_if(events, [](const Event& event) { return std::holds_alternative<What>(event); }));
  }

  void on_event(const Event& event, TimePoint) override { events.push_back(event); }

  TimePoint now{std::chrono::seconds(1000)};
  Porter porter;
  std::vector<Event> events;
  std::vector<Result<Motion>> answers;
  std::vector<std::string> commands;
  std::vector<Duration> reopened;
  std::optional<Opcode> lose_command, lose_answer;  // opcodes of which every frame is lost

 private:
  static constexpr Duration kWay = std::chrono::milliseconds(2);

  struct UnderWay {
    TimePoint due;
    std::string bytes;
  };
  class Side : public ByteLink {
   public:
    Side(Rig& rig, bool gateway) : rig_(rig), gateway_(gateway) {}
    void write(std::string_view bytes) override { rig_.send(gateway_, std::string(bytes)); }
    void reopen(Duration wait) override {
      rig_.reopened.push_back(wait);
      rig_.opens_ = rig_.now + wait;
      rig_.to_rotor_.clear();
      rig_.to_gateway_.clear();
    }

   private:
    Rig& rig_;
    bool gateway_;
  };

  void send(bool by_gateway, std::string bytes) {
    const auto opcode = static_cast<Opcode>(static_cast<std::uint8_t>(bytes[1]) & ~kAnswerBit);
    if (by_gateway) commands.push_back(bytes);
    if (opcode == (by_gateway ? lose_command : lose_answer)) return;
    (by_gateway ? to_rotor_ : to_gateway_).push_back({now + kWay, std::move(bytes)});
  }

  std::optional<TimePoint> next_event() const {
    auto next = controller.next_deadline();
    const auto sooner = [&next](TimePoint at) { next = next ? std::min(*next, at) : at; };
    if (!to_rotor_.empty()) sooner(to_rotor_.front().due);
    if (!to_gateway_.empty()) sooner(to_gateway_.front().due);
    if (opens_) sooner(*opens_);
    return next;
  }

  void step() {
    rotor.advance(now);
    if (opens_ && *opens_ <= now) {
      opens_.reset();
      rotor.link_up(now);
      controller.link_up(now);
    }
    while (!to_rotor_.empty() && to_rotor_.front().due <= now) {
      const std::string bytes = std::move(to_rotor_.front().bytes);
      to_rotor_.pop_front();
      rotor.receive(bytes, now);
    }
    while (!to_gateway_.empty() && to_gateway_.front().due <= now) {
      const std::string bytes = std::move(to_gateway_.front().bytes);
      to_gateway_.pop_front();
      controller.receive(bytes, now);
    }
    controller.advance(now);
  }

  std::deque<UnderWay> to_rotor_, to_gateway_;
  std::optional<TimePoint> opens_;
  Side gateway_side_{*this, true}, device_side_{*this, false};

 public:
  SimulatedRotor rotor;
  Controller controller;
};

}  // namespace axisgate::rotor
