// Record of requests and of their answers.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace axisgate::stress {

// A Ledger records the requests of one caller. Thread safe. It must outlive all callbacks that may answer.
class Ledger {
 public:
  // A Ticket stands for one request, and is owned by its callback.
  class Ticket {
   public:
    Ticket(Ledger& ledger, std::string asked) : ledger_(ledger), asked_(std::move(asked)) {}
    void answered() { ledger_.note_answer(*this); }
    const std::string& asked() const { return asked_; }

   private:
    friend class Ledger;
    Ledger& ledger_;
    const std::string asked_;
    int answers_ = 0;
  };

  std::shared_ptr<Ticket> issue(std::string asked);
  std::size_t issued() const;
  std::size_t answered() const;

  // Waits until at most `count` requests are unanswered. Returns false if that takes more than two minutes.
  [[nodiscard]] bool wait_until_open(std::size_t count);

  // Returns the first ten requests that were not answered exactly once, or whose callback still exists. Call it when no
  // more answers can arrive. With `dropped`, unanswered requests are accepted, too.
  std::string wrong(bool dropped) const;

 private:
  void note_answer(Ticket& ticket);

  mutable std::mutex mutex_;
  std::condition_variable fewer_;
  std::deque<std::shared_ptr<Ticket>> tickets_;
  std::size_t answered_ = 0;
};

}  // namespace axisgate::stress
