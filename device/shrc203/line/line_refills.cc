// Reservations of Line for the refills of running paths.
#include "device/shrc203/line/line.h"

namespace axisgate::shrc203 {

void Line::keep_free(MotionId path, TimePoint due, TimePoint now) {
  now_ = now;
  reservations_.keep(path, due);
  pump(now);
}

void Line::release(MotionId path, TimePoint now) {
  now_ = now;
  reservations_.release(path);
  pump(now);
}

// Reports whether the request delays no refill. Lines of the handshake always may be sent: without their replies no
// refill could be sent either.
bool Line::leaves_refills_alone(const ExchangeRequest& request, TimePoint now) const {
  if (profile_.refills != Refills::reserved || request.handshake || request.lane <= Lane::path_refill) return true;
  if (queue_.size(Lane::path_refill) > 0) return false;
  if (reservations_.empty()) return true;
  Duration length = timing_.longest_exchange(request.command);
  if (continuity_.due(now)) length += timing_.longest_exchange(commands::ask(kLineBefore));
  return reservations_.allow(request.motion, length, now);
}

bool Line::may_settle(TimePoint now) const {
  return reservations_.empty() || reservations_.allow(0, timing_.longest_exchange(commands::ask(kSettling)), now);
}

}  // namespace axisgate::shrc203
