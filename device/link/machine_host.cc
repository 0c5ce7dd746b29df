#include "device/link/machine_host.h"

#include <chrono>
#include <utility>

#include "device/link/clock.h"

namespace axisgate {

void MachineHost::post(std::function<void(TimePoint now)> request, std::function<void()> too_late) {
  inbox_.post([self = shared_from_this(),
               request = std::move(request)] { self->call([&](LineMachine&, TimePoint now) { request(now); }); },
              std::move(too_late));
}

void MachineHost::detach() {
  machine_ = nullptr;
  inbox_.close();
  armed_.reset();
  deadline_timer_.cancel();
}

void MachineHost::arm() {
  // settle() may have detached the machine.
  const auto deadline = machine_ == nullptr ? std::nullopt : machine_->next_deadline();
  // Leaves an earlier timer as it is, because most deadlines are time limits that never pass. When that timer fires,
  // the machine's next deadline is read again.
  if (!deadline || (armed_ && *armed_ <= *deadline)) return;
  armed_ = deadline;
  // Asio's clock stops while the host sleeps; monotonic_now() does not.
  deadline_timer_.expires_after(*deadline - monotonic_now());
  deadline_timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (error) return;
    self->armed_.reset();
    self->call([](LineMachine& machine, TimePoint now) {
      const auto due = machine.next_deadline();
      if (due && *due <= now) machine.advance(now);
    });
  });
}

}  // namespace axisgate
