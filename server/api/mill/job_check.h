// The check of a job for a mill while its bytes come: each part by itself, as each is sent by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/check/check.h"
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
  rml1::Extent extent;
  std::vector<rml1::Warning> accepted;  // in their order; each occurs in the job
};

// A JobPast is what came before a job that is checked.
struct JobPast {
  std::vector<rml1::Warning> accepted{};  // when it was sent first; it may no longer have them
  rml1::Check* workpiece = nullptr;       // has played the jobs that have cut its workpiece; null: that is new
};

// invalid_request, where the mill of that name has no such tool, or there are too many parts, or one without bytes.
Result<void> check_parts(const std::vector<PartToSend>& parts, const std::vector<std::string>& tools,
                         std::string_view mill);

// Fails with invalid_request if one of them is no name of a rml1::Warning.
Result<void> check_warning_names(const std::vector<std::string>& names);

// Not thread safe. What both calls refuse is invalid_request: the first error of a part that has come whole; a piece
// that cannot be cut and is longer than the mill's buffer; and bytes that are more or less than those of the parts.
// finish() also refuses all kinds of warnings that are not accepted, and accepted kinds that the job does not have.
class JobCheck {
 public:
  // All outlive this, but for what `before` refers to, which outlives the first feed(). `buffer`: of the mill, in
  // bytes. `parts`: at least one. `accepted`: names of warnings.
  JobCheck(const rml1::Profile& profile, rml1::CheckOptions options, std::size_t buffer,
           const std::vector<PartToSend>& parts, const std::vector<std::string>& accepted, JobPast before = {});

  Result<void> feed(std::string_view bytes);
  Result<CheckedJob> finish();

 private:
  // A Found is all of one kind of warning in the job.
  struct Found {
    std::string first;       // its place and text
    std::uint64_t more = 0;  // places beyond the first
    std::string last;        // of these
  };

  const PartToSend& part() const { return parts_[checked_.parts.size()]; }
  Result<void> finish_part();
  Result<void> judge_errors() const;
  void take_warnings();
  bool is_accepted(rml1::Warning warning) const;
  Result<void> judge_warnings();
  Result<void> check_pieces() const;
  std::string place_text(const rml1::Place& place) const;
  std::string file_text() const;

  const rml1::Profile& profile_;
  const rml1::CheckOptions options_;
  const std::size_t buffer_;
  const std::vector<PartToSend>& parts_;
  const std::vector<std::string>& accepted_;
  const std::vector<rml1::Warning> accepted_before_;
  std::unique_ptr<rml1::Check> check_;  // of part(); null: all parts have come
  std::map<rml1::Warning, Found> warnings_;
  rml1::LongestPiece pieces_;  // of part()
  std::uint64_t begin_ = 0;    // of part(), in bytes of the job
  std::uint64_t come_ = 0;     // bytes of part()
  CheckedJob checked_;
};

}  // namespace axisgate::api
