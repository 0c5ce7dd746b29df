#include "device/rml1/sending/cut.h"

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {

Cutter::Cutter(std::string_view job, std::size_t window) : job_(job), window_(window), end_(find_end()) {}

void Cutter::next() {
  begin_ = end_;
  end_ = find_end();
}

// A list is read no further than the window, if it can be cut there. `places_` has come to the end that is found.
std::size_t Cutter::find_end() {
  const std::size_t full = begin_ + window_;
  CutPlaces places = places_;
  std::size_t at = begin_, cut = 0;  // of the list that is cut there
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
