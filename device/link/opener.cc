#include "device/link/opener.h"

#include <utility>

#include "device/link/blocking_task.h"

namespace axisgate {

Opener opener_on_strand(std::function<OpenedLine()> open) {
  return [open = std::move(open)](const Strand& strand, OnOpened opened) {
    auto waiting = std::make_shared<OnOpened>(std::move(opened));
    boost::asio::post(strand, [open, attempt = std::weak_ptr(waiting)] {
      const auto still = attempt.lock();
      if (still) std::exchange(*still, {})(open());
    });
    return Opening(waiting);
  };
}

Opener opener_on_thread(std::function<OpenedLine()> open) {
  return [open = std::move(open)](const Strand& strand, OnOpened opened) {
    return run_blocking_task<OpenedLine>(strand, open, std::move(opened));
  };
}

}  // namespace axisgate
