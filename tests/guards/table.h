// What shows that each guard is needed: seeds in which something goes wrong without it, or tests that fail.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/core/guard.h"

namespace axisgate::guards {

// Without the guard, one of `count` seeds from `first` on violates something within `minutes` of virtual time.
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
  std::optional<Seeds> seeds;  // nothing: no seed can show it, or none does within reasonable time
  std::string_view tests;      // gtest's filter; some of these fail without the guard. Used where there are no seeds
  bool open = false;           // nobody knows yet what fails without it: `tests` are the nearest that pass all the same
};

// A row for each guard, in the order of the enumeration.
std::span<const Row> table();

// Nothing for a name that no guard has.
const Row* row_named(std::string_view name);

// Removes a guard for as long as it lives.
class Without {
 public:
  explicit Without(Guard guard) { removed_guard = guard; }
  ~Without() { removed_guard.reset(); }
  Without(const Without&) = delete;
  Without& operator=(const Without&) = delete;
};

}  // namespace axisgate::guards
