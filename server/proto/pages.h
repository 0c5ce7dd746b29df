// Pages of lists that are short enough to be complete in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"

namespace axisgate::proto {

inline constexpr std::int32_t kPageUsual = 100, kPageMax = 1000;

// Every token of a page begins with this, so that a text that is no token is refused.
inline constexpr std::string_view kTokenMark = "after:";

// Fails with invalid_request if `page_size` is not within 0 to kPageMax, or `page_token` is no token.
inline Result<void> check_page(std::int32_t page_size, std::string_view page_token) {
  if (page_size < 0 || page_size > kPageMax) {
    return fail(Reason::invalid_request, "page_size is not within 1 to 1000", "leave it 0 for 100");
  }
  if (page_token.empty() || page_token.starts_with(kTokenMark)) return {};
  return fail(Reason::invalid_request, "page_token is not a token of this list",
              "give the next_page_token of the previous page");
}

// Keeps the page after `page_token`, which was checked, and drops the other items. Returns the token of the next page;
// empty if there is none. `key` returns a text by which the items are in ascending order; a page continues correctly
// even if the item before it has gone.
template <class Item, class Key>
std::string cut_page(std::vector<Item>& items, std::int32_t page_size, std::string_view page_token, Key key) {
  const auto size = static_cast<std::size_t>(page_size == 0 ? kPageUsual : page_size);
  if (!page_token.empty()) {
    page_token.remove_prefix(kTokenMark.size());
    items.erase(items.begin(), std::ranges::upper_bound(items, page_token, {}, key));
  }
  if (items.size() <= size) return "";
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(size), items.end());
  return std::string(kTokenMark) + key(items.back());
}

}  // namespace axisgate::proto
