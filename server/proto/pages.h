// Pages of lists that are short enough to be complete in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "device/core/problem.h"

namespace axisgate::proto {

inline constexpr std::int32_t kPageUsual = 100, kPageMax = 1000;

// Fails with invalid_request if `page_size` is not within 0 to kPageMax.
inline Result<void> check_page_size(std::int32_t page_size) {
  if (page_size >= 0 && page_size <= kPageMax) return {};
  return fail(Reason::invalid_request, "page_size is not within 1 to 1000", "leave it 0 for 100");
}

// Keeps the page after `page_token` and drops the other items. Returns the token of the next page; empty if there is
// none. `key` returns a text by which the items are in ascending order; a page continues correctly even if the item
// before it has gone.
template <class Item, class Key>
std::string cut_page(std::vector<Item>& items, std::int32_t page_size, const std::string& page_token, Key key) {
  const auto size = static_cast<std::size_t>(page_size == 0 ? kPageUsual : page_size);
  const auto first = std::ranges::upper_bound(items, page_token, {}, key);
  items.erase(items.begin(), page_token.empty() ? items.begin() : first);
  if (items.size() <= size) return "";
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(size), items.end());
  return key(items.back());
}

}  // namespace axisgate::proto
