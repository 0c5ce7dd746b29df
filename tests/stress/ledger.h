// Who was promised an answer, and who got one.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace axisgate::stress {

// One caller's requests. Thread safe; outlives everything that may answer.
class Ledger {
 public:
  // Held by the callback of one request.
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

  // Waits until at most `count` requests are unanswered. False when that takes absurdly long.
  [[nodiscard]] bool wait_until_open(std::size_t count);

  // The first ten requests that were not answered once, or are still held by somebody. Call it when nobody can answer
  // any more; with `dropped`, no answer is as good as one.
  std::string wrong(bool dropped) const;

 private:
  void note_answer(Ticket& ticket);

  mutable std::mutex mutex_;
  std::condition_variable fewer_;
  std::deque<std::shared_ptr<Ticket>> tickets_;
  std::size_t answered_ = 0;
};

}  // namespace axisgate::stress
