// The check of a job for a mill while its bytes come: each part by itself, as each is sent by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/check.h"
#include "device/rml1/mill/job.h"
#include "device/rml1/sending/longest_piece.h"

namespace axisgate::api {

struct PartToSend {
  std::string tool;
  std::optional<std::uint64_t> bytes{};  // none: all that come; of the only part
};

struct CheckedJob {
  std::vector<rml1::JobPart> parts;
  rml1::Leaves leaves;
};

// invalid_request, where the mill of that name has no such tool, or there are too many parts, or one without bytes.
Result<void> check_parts(const std::vector<PartToSend>& parts, const std::vector<std::string>& tools,
                         std::string_view mill);

using AcceptedWarnings = std::set<std::string, std::less<>>;  // sections of the guideline, "5-2"

// Not thread safe. What both calls refuse is invalid_request: the first error of a part that has come whole, or the
// first warning that is not accepted; a piece that cannot be cut and is longer than the mill's buffer; and bytes that
// are more or less than those of the parts.
class JobCheck {
 public:
  // All outlive this. `buffer`: of the mill, in bytes. `parts`: at least one.
  JobCheck(const rml1::Profile& profile, rml1::CheckOptions options, std::size_t buffer,
           const std::vector<PartToSend>& parts, const AcceptedWarnings& accepted);

  Result<void> feed(std::string_view bytes);
  Result<CheckedJob> finish();

 private:
  const PartToSend& part() const { return parts_[checked_.parts.size()]; }
  Result<void> finish_part();
  Result<void> judge() const;
  Result<void> check_pieces() const;
  std::string file_text() const;

  const rml1::Profile& profile_;
  const rml1::CheckOptions options_;
  const std::size_t buffer_;
  const std::vector<PartToSend>& parts_;
  const AcceptedWarnings& accepted_;
  std::optional<rml1::Check> check_;  // of part(); none: all parts have come
  rml1::LongestPiece pieces_;         // of part()
  std::uint64_t begin_ = 0;           // of part(), in bytes of the job
  std::uint64_t come_ = 0;            // bytes of part()
  CheckedJob checked_;
};

}  // namespace axisgate::api
