// Check of a job before it is queued: errors, warnings by kind, and the longest piece that must be sent at once.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/jobs/check.h"
#include "device/rml1/check/check.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/sending/longest_piece.h"

namespace axisgate::rml1 {

// Not thread safe.
class QueuedCheck final : public jobs::Check {
 public:
  // The profile must outlive this object.
  QueuedCheck(const Profile& profile, CheckOptions options) : check_(profile, std::move(options)) {}

  // `before` must be a QueuedCheck.
  void continues(jobs::Check& before) override { check_.continues(static_cast<QueuedCheck&>(before).check_); }
  void feed(std::string_view bytes) override;
  void finish() override { check_.finish(); }

  std::optional<jobs::FoundError> error() const override;
  std::vector<jobs::FoundWarning> warnings() const override;
  jobs::Leaves leaves() const override { return check_.leaves(); }
  jobs::Extent extent() const override { return check_.extent(); }
  jobs::Piece longest_piece() const override { return pieces_.longest(); }

 private:
  rml1::Check check_;
  LongestPiece pieces_;
};

}  // namespace axisgate::rml1
