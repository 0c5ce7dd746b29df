// Evidence that each guard is needed: seeds that violate something without it, or tests that fail.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/core/guard.h"

namespace axisgate::guards {

// Range of seeds. Without the guard, at least one of `count` seeds from `first` on violates something within `minutes`
// of virtual time.
struct Seeds {
  std::uint64_t first = 0;
  int count = 0;
  int minutes = 10;
  std::string_view profile = "hostile";
};

struct Row {
  Guard guard;
  std::string_view name;
  std::string_view what;
  std::optional<Seeds> seeds;  // nullopt if no seed detects the removal within reasonable time
  std::string_view
      tests;  // gtest filter; at least one of these tests fails without the guard. Used if there are no seeds
};

// Returns one row for each guard, in the order of the enumeration.
std::span<const Row> table();

// Returns null if no guard has this name.
const Row* row_named(std::string_view name);

// A Without removes one guard during its lifetime.
class Without {
 public:
  explicit Without(Guard guard) { removed_guard = guard; }
  ~Without() { removed_guard.reset(); }
  Without(const Without&) = delete;
  Without& operator=(const Without&) = delete;
};

}  // namespace axisgate::guards
