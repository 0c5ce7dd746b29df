#include "device/use/occupation.h"

#include <fmt/format.h>

#include "device/core/spans.h"

namespace axisgate::use {

std::string text_of(const Occupation& occupation, TimePoint now) {
  std::string left;
  if (occupation.due && *occupation.due > now) {
    left = fmt::format(", {} left", for_people(std::chrono::ceil<std::chrono::seconds>(*occupation.due - now)));
  }
  return fmt::format("{} ({}{}){}", occupation.before, occupation.by, left, occupation.after);
}

}  // namespace axisgate::use
