#include "device/rml1/sending/longest_piece.h"

namespace axisgate::rml1 {

void LongestPiece::take(std::string_view bytes) {
  for (const char c : bytes) {
    next_ = after(next_, c);
    ++piece_.bytes;
    if (piece_.bytes > longest_.bytes) longest_ = piece_;
    if (places_.take(c) != CutPlaces::Cut::no) piece_ = {next_, 0};
  }
}

}  // namespace axisgate::rml1
