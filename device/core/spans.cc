#include "device/core/spans.h"

#include <string>

namespace axisgate {

std::string for_people(Duration time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time).count();
  const auto text = [](auto count, const char* unit) { return std::to_string(count) + unit; };
  if (seconds < 60) return text(seconds, " s");
  if (seconds < 3600) return text(seconds / 60, " min ") + text(seconds % 60, " s");
  return text(seconds / 3600, " h ") + text(seconds / 60 % 60, " min");
}

}  // namespace axisgate
