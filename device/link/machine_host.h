// Base of every shell around a LineMachine: it calls the machine on one strand with the clock's time, and has one
// timer, which is never later than the machine's next deadline.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "device/core/line_machine.h"
#include "device/link/asio.h"
#include "device/link/clock.h"
#include "device/link/inbox.h"

namespace axisgate {

// A MachineHost is owned by shared pointers only: handlers that wait in the io_context keep it alive. All members must
// be called on the strand, except attach(), strand() and post().
class MachineHost : public std::enable_shared_from_this<MachineHost> {
 public:
  virtual ~MachineHost() = default;
  MachineHost(const MachineHost&) = delete;
  MachineHost& operator=(const MachineHost&) = delete;

  void attach(LineMachine& machine) { machine_ = &machine; }
  // Runs the request on the strand. After detach() `too_late` is called instead, if given.
  void post(std::function<void(TimePoint now)> request, std::function<void()> too_late = {});
  const Strand& strand() const { return strand_; }

 protected:
  explicit MachineHost(Strand strand) : strand_(std::move(strand)), inbox_(strand_), deadline_timer_(strand_) {}

  bool attached() const { return machine_ != nullptr; }

  // Ends all calls of the machine.
  void detach();

  // Calls the machine. All calls must go through here: the machine's requests are then carried out, and its deadline is
  // read again.
  template <class Call>
  void call(Call&& call) {
    if (machine_ == nullptr) return;
    call(*machine_, monotonic_now());
    settle();
    arm();
  }

  // Carries out the requests that the machine made in the call that has just ended.
  virtual void settle() = 0;

 private:
  void arm();

  Strand strand_;
  Inbox inbox_;
  boost::asio::steady_timer deadline_timer_;
  std::optional<TimePoint> armed_;
  LineMachine* machine_ = nullptr;
};

}  // namespace axisgate
