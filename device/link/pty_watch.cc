#include "device/link/pty_watch.h"

#include <fmt/format.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace axisgate {

Result<PtyWatch> PtyWatch::open(const Pty& pty) {
  Descriptor events(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!events.valid() || ::inotify_add_watch(events.get(), pty.device().c_str(), IN_OPEN | IN_MODIFY | IN_CLOSE) < 0) {
    return fail(Reason::link_down,
                fmt::format("{} cannot be watched: {}", pty.device(), std::generic_category().message(errno)),
                "Raise fs.inotify.max_user_instances if too many programs watch files.");
  }
  return PtyWatch(std::move(events));
}

void PtyWatch::Visits::add(const Visits& later) {
  if (later.came > 0) others_wrote = others_wrote || std::exchange(last_wrote, false);
  came += later.came;
  last_wrote = last_wrote || later.last_wrote;
  others_wrote = others_wrote || later.others_wrote;
}

PtyWatch::Visits PtyWatch::drain() {
  Visits visits;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t size = ::read(events_.get(), buffer.data(), buffer.size());
    if (size <= 0) return visits;
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof event);
      count(event.mask, visits);
      at += sizeof event + event.len;
    }
  }
}

void PtyWatch::count(std::uint32_t event, Visits& visits) {
  if ((event & IN_OPEN) != 0) {
    if (clients_++ == 0) visits.add({1, false, false});
  } else if ((event & IN_CLOSE) != 0) {
    clients_ = std::max(0, clients_ - 1);
  } else if ((event & IN_MODIFY) != 0) {
    visits.add({0, true, false});
  }
}

}  // namespace axisgate
