#include "tests/stress/ledger.h"

#include <fmt/format.h>

#include <chrono>

namespace axisgate::stress {

std::shared_ptr<Ledger::Ticket> Ledger::issue(std::string asked) {
  const std::lock_guard lock(mutex_);
  return tickets_.emplace_back(std::make_shared<Ticket>(*this, std::move(asked)));
}

std::size_t Ledger::issued() const {
  const std::lock_guard lock(mutex_);
  return tickets_.size();
}

std::size_t Ledger::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}

void Ledger::note_answer(Ticket& ticket) {
  {
    const std::lock_guard lock(mutex_);
    if (++ticket.answers_ == 1) ++answered_;
  }
  fewer_.notify_all();
}

bool Ledger::wait_until_open(std::size_t count) {
  std::unique_lock lock(mutex_);
  return fewer_.wait_for(lock, std::chrono::minutes(2), [&] { return tickets_.size() - answered_ <= count; });
}

std::string Ledger::wrong(bool dropped) const {
  const std::lock_guard lock(mutex_);
  std::string text;
  int left_to_tell = 10;
  for (const auto& ticket : tickets_) {
    const bool good = ticket->answers_ == 1 || (dropped && ticket->answers_ == 0);
    if ((good && ticket.use_count() == 1) || left_to_tell-- <= 0) continue;
    if (!good) text += fmt::format("{} was answered {} times\n", ticket->asked_, ticket->answers_);
    if (ticket.use_count() != 1) text += fmt::format("{} is still held\n", ticket->asked_);
  }
  return text;
}

}  // namespace axisgate::stress
