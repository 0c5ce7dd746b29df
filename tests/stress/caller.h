// Caller on one of the threads that send every kind of request to every device at once.
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

// A Caller sends random requests and checks the answers. Every question has one right answer, which depends on the
// device and the axis. The only other accepted result is a problem of the line, of time or of other callers; anything
// else is a test failure.
class Caller {
 public:
  Caller(Bench& bench, unsigned number) : bench_(bench), number_(number), random_(number) {}

  // Sends requests; runs on a separate thread. Waits for the device to be up before most requests, and for answers
  // while `window` requests are open.
  void ask(int requests, std::size_t window);
  // Sends requests without waiting for anything.
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
  use::RequestContext context(const Ticket& ticket) const;
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
