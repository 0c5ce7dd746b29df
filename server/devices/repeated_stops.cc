#include "server/devices/repeated_stops.h"

#include <algorithm>
#include <utility>

#include "server/access/access.h"

namespace axisgate::server {

using stage::StopRequested;

StopRequested RepeatedStops::count_of(Series& series, TimePoint now) {
  StopRequested count = series.stop;
  count.count = std::exchange(series.folded, 0);
  series.reported = now;
  return count;
}

std::vector<StopRequested> RepeatedStops::add(const StopRequested& stop, TimePoint now) {
  std::vector<StopRequested> reported = ended(now);
  const Key key{identity_of(stop.who), stop.axes.list(), stop.emergency};
  const auto found = series_.find(key);
  if (found == series_.end() || stop.moved) {
    if (found != series_.end() && found->second.folded > 0) reported.push_back(count_of(found->second, now));
    reported.push_back(stop);
    if (found != series_.end()) series_.erase(found);
    if (!stop.moved && series_.size() < kSeriesMax) series_.emplace(key, Series{stop, now, now, 0});
    return reported;
  }
  Series& series = found->second;
  series.last = now;
  ++series.folded;
  if (now - series.reported >= kStopSeriesReport) reported.push_back(count_of(series, now));
  return reported;
}

std::vector<StopRequested> RepeatedStops::ended(TimePoint now) {
  std::vector<StopRequested> over;
  for (auto entry = series_.begin(); entry != series_.end();) {
    Series& series = entry->second;
    if (now - series.last <= kStopSeriesPause) {
      ++entry;
      continue;
    }
    if (series.folded > 0) over.push_back(count_of(series, now));
    entry = series_.erase(entry);
  }
  return over;
}

bool RepeatedStops::folds(std::string_view who) const {
  const std::string identity = identity_of(who);
  return std::ranges::any_of(
      series_, [&](const auto& entry) { return std::get<0>(entry.first) == identity && entry.second.folded > 0; });
}

}  // namespace axisgate::server
