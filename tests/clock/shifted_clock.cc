// Library for LD_PRELOAD that shifts the wall clock of a program. The file named by AXISGATE_CLOCK_SHIFT contains the
// shift in seconds, as 8 bytes in the byte order of this machine, and can be changed while the program runs. Other
// clocks, such as the monotonic clock, are not shifted.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>

namespace {

using Arguments = std::array<long, 6>;

constexpr std::int64_t kSecond = 1'000'000'000;  // in ns
constexpr std::int64_t kLook = kSecond / 20;     // longest delay before a wait notices a new shift

// Maps the file with the shift. Aborts without the file, because the test would then test nothing.
const volatile std::int64_t* map_shift() {
  const char* const path = std::getenv("AXISGATE_CLOCK_SHIFT");
  const int file = path == nullptr ? -1 : ::open(path, O_RDONLY | O_CLOEXEC);
  void* const mapped = ::mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED) std::abort();
  ::close(file);
  return static_cast<const std::int64_t*>(mapped);
}

std::int64_t shift() {
  static const volatile std::int64_t* const seconds = map_shift();
  return *seconds;
}

long system_call(long number, const Arguments& with) {
  using Function = long (*)(long, ...);
  static const auto next = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "syscall"));
  return next(number, with[0], with[1], with[2], with[3], with[4], with[5]);
}

timespec real_time(clockid_t clock) {
  timespec now{};
  system_call(SYS_clock_gettime, {clock, reinterpret_cast<long>(&now)});
  return now;
}

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * kSecond + time.tv_nsec; }

// Waits on a futex until a time of the wall clock, also if the clock is set during the wait.
long wait_for_wall_time(Arguments with) {
  const std::int64_t end = nanoseconds(*reinterpret_cast<const timespec*>(with[3]));
  while (true) {
    const std::int64_t now = nanoseconds(real_time(CLOCK_REALTIME));
    const std::int64_t left = end - shift() * kSecond - now;
    const std::int64_t look = now + std::clamp(left, std::int64_t{0}, kLook);
    const timespec until{look / kSecond, look % kSecond};
    with[3] = reinterpret_cast<long>(&until);
    const long result = system_call(SYS_futex, with);
    if (result == 0 || errno != ETIMEDOUT || left <= kLook) return result;
  }
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto failed = static_cast<int>(system_call(SYS_clock_gettime, {clock, reinterpret_cast<long>(time)}));
  if (failed == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) time->tv_sec += shift();
  return failed;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* where) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (where != nullptr) *where = now.tv_sec;
  return now.tv_sec;
}

// Intercepts futex waits: gRPC's threads wait for times of the wall clock through this call.
long syscall(long number, ...) noexcept {
  Arguments with{};
  std::va_list given;
  va_start(given, number);
  for (long& argument : with) argument = va_arg(given, long);
  va_end(given);
  constexpr int kWaits = FUTEX_WAIT_BITSET | FUTEX_CLOCK_REALTIME;
  const bool waits = number == SYS_futex && (with[1] & ~FUTEX_PRIVATE_FLAG) == kWaits && with[3] != 0;
  return waits ? wait_for_wall_time(with) : system_call(number, with);
}

}  // extern "C"
