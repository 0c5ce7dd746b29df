// Folds the stops of a caller who stops again and again although nothing moves, so that a loop of stops does not push
// the entries of others out of the history, the log or the events. Each stop is carried out nevertheless.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "device/stage/event.h"
#include "server/limits.h"

namespace axisgate::server {

// Not thread safe: runs on the device's strand.
class RepeatedStops {
 public:
  // Returns the stops to report: the stop itself, the count of a series, or none if the stop is folded.
  std::vector<stage::StopRequested> add(const stage::StopRequested& stop, TimePoint now);
  // Returns the counts of series that are over.
  std::vector<stage::StopRequested> ended(TimePoint now);
  // Reports whether this caller's stops are being folded, so that their lines and their ends are folded, too.
  bool folds(std::string_view who) const;

 private:
  using Key = std::tuple<std::string, std::vector<int>, bool>;  // identity, axes, emergency
  struct Series {
    stage::StopRequested stop;
    TimePoint reported{}, last{};
    std::int64_t folded = 0;
  };
  static constexpr std::size_t kSeriesMax = 64;  // further stops are reported one by one

  static stage::StopRequested count_of(Series& series, TimePoint now);

  std::map<Key, Series> series_;
};

}  // namespace axisgate::server
