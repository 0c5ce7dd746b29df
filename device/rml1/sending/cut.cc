#include "device/rml1/sending/cut.h"

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {

Cutter::Cutter(std::string_view job, std::size_t window) : job_(job), window_(window), end_(find_end()) {}

void Cutter::next() {
  begin_ = end_;
  end_ = find_end();
}

// Returns the end of the write that begins at begin_, and lets `places_` take the bytes up to that end. A list that can
// be cut within the window is not read beyond the window.
std::size_t Cutter::find_end() {
  const std::size_t full = begin_ + window_;
  CutPlaces places = places_;
  std::size_t at = begin_, cut = 0;  // `cut`: last place found at which the list can be cut; 0: none
  bool ended = false;
  while (at < job_.size() && !ended && (cut == 0 || at < full)) {
    const CutPlaces::Cut found = places.take(job_[at++]);
    ended = found == CutPlaces::Cut::between_commands && (at >= full || at == job_.size() || !is_delimiter(job_[at]));
    if (found != CutPlaces::Cut::in_list) continue;
    cut = at;
    places_ = places;
  }
  const bool whole = cut == 0 || (at <= full && (ended || at == job_.size()));
  if (whole) places_ = places;
  return whole ? at : cut;
}

}  // namespace axisgate::rml1
