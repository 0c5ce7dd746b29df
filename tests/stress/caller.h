// One of the threads that ask everything of every device at once.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <cstddef>
#include <random>
#include <string>

#include "device/stage/stage_controller.h"
#include "tests/stress/bench.h"
#include "tests/stress/ledger.h"

namespace axisgate::stress {

// Every question has one right answer, which depends on the device and the axis. Instead of it only a problem of the
// line or of the time may come; anything else is a test failure.
class Caller {
 public:
  Caller(Bench& bench, unsigned number) : bench_(bench), number_(number), random_(number) {}

  // On a thread of its own. Before most requests it waits for the device to be up, and with `window` open requests for
  // answers.
  void ask(int requests, std::size_t window);
  // Without waiting for anything.
  void flood(int requests);

  Ledger& ledger() { return ledger_; }
  int right_answers() const { return right_answers_; }
  int motions_started() const { return motions_started_; }

 private:
  using Ticket = std::shared_ptr<Ledger::Ticket>;

  void request(std::size_t device);
  void question(std::size_t device);
  void transaction(std::size_t device);
  void refresh(std::size_t device);
  void move(std::size_t device);
  void path(std::size_t device);
  void home(std::size_t device);
  void set_and_go(std::size_t device);
  void stop(std::size_t device);
  void cancel(std::size_t device);
  void rearm(std::size_t device);
  void execute(std::size_t device, std::vector<std::string> lines, std::vector<std::string> right);

  std::string name() const { return fmt::format("caller {}", number_); }
  Ticket ticket(std::size_t device, const std::string& what);
  stage::RequestContext context(const Ticket& ticket) const;
  stage::StageController::OnStarted on_started(const Ticket& ticket, std::size_t device);
  int draw(int minimum, int maximum) { return std::uniform_int_distribution(minimum, maximum)(random_); }

  Bench& bench_;
  const unsigned number_;
  std::mt19937 random_;
  Ledger ledger_;
  std::atomic<int> right_answers_ = 0;
  std::atomic<int> motions_started_ = 0;
  std::array<std::atomic<stage::MotionId>, kDevices> newest_motion_{};
};

}  // namespace axisgate::stress
