// The check of a job of lines of text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "device/jobs/check.h"

namespace axisgate::echo {

inline constexpr std::size_t kLongestLine = 80;  // bytes, without LF

// Finds bytes that are no printable ASCII, and lines that are too long; warns of a last line without LF.
class TextCheck final : public jobs::Check {
 public:
  void continues(jobs::Check&) override {}  // nothing is left of the jobs before
  void feed(std::string_view bytes) override;
  void finish() override {}

  std::optional<jobs::FoundError> error() const override { return error_; }
  std::vector<jobs::FoundWarning> warnings() const override;
  jobs::Leaves leaves() const override { return {}; }
  jobs::Extent extent() const override { return {}; }
  jobs::Piece longest_piece() const override { return longest_; }

 private:
  void found(std::string_view text);

  jobs::Place next_;
  jobs::Piece line_, longest_;
  std::optional<jobs::FoundError> error_;
};

}  // namespace axisgate::echo
