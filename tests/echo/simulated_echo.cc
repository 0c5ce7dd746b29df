#include "tests/echo/simulated_echo.h"

#include <utility>

#include "tests/echo/model.h"

namespace axisgate::echo {

void SimulatedEcho::receive(std::string_view bytes, TimePoint now) {
  received_ += bytes;
  for (std::size_t end = received_.find('\n'); end != std::string::npos; end = received_.find('\n')) {
    std::string line = received_.substr(0, end + 1);
    received_.erase(0, end + 1);
    if (line == kAbort) {
      lines_.clear();
      due_.reset();
      line_.write(line);
    } else {
      lines_.push_back(std::move(line));
    }
  }
  if (!due_) begin_next(now);
}

void SimulatedEcho::begin_next(TimePoint now) { due_ = lines_.empty() ? std::nullopt : std::optional(now + kLineTime); }

void SimulatedEcho::advance(TimePoint now) {
  if (!due_ || now < *due_) return;
  line_.write(lines_.front());
  lines_.pop_front();
  ++executed_;
  begin_next(now);
}

Result<std::string> SimulatedEcho::operate(std::string_view command, TimePoint) {
  if (command == "count") return std::to_string(executed_);
  return fail(Reason::invalid_request, "an echo machine only counts", "say: count");
}

}  // namespace axisgate::echo
