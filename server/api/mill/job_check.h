// Check of a job for a mill while its bytes arrive. Each part is checked separately, because each is sent separately.
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
#include "device/jobs/check.h"
#include "device/jobs/job.h"
#include "device/jobs/model.h"

namespace axisgate::api {

struct PartToSend {
  std::string tool;
  std::optional<std::uint64_t> bytes{};  // nullopt: all that arrive; only for a job with one part
};

struct CheckedJob {
  std::vector<jobs::JobPart> parts;
  jobs::Leaves leaves;
  jobs::Extent extent;
  std::vector<std::string> accepted;  // names of warnings, in their order; each occurs in the job
};

// A JobPast is the history of a job that is checked.
struct JobPast {
  std::vector<std::string> accepted{};  // names of the warnings when the job was first sent; it may no longer have them
  jobs::Check* workpiece = nullptr;     // check that has played the jobs that cut its workpiece; null: a new
                                        // workpiece
};

// Fails with invalid_request if the named mill lacks a tool, if there are too many parts, or if a part has no bytes.
Result<void> check_parts(const std::vector<PartToSend>& parts, const std::vector<std::string>& tools,
                         std::string_view mill);

// Not thread safe. Both functions fail with invalid_request: for the first error of a complete part; for a piece that
// cannot be divided and is longer than the mill's buffer; and if there are more or fewer bytes than those of the parts.
// finish() also fails for kinds of warnings that are not accepted, and for accepted kinds that the job does not have.
class JobCheck {
 public:
  // The referenced objects must outlive this one, but those of `before` only the first feed(). `buffer`: size of the
  // mill's buffer in bytes. `parts`: at least one. `accepted`: names of warnings.
  JobCheck(const jobs::Model& model, jobs::CheckOptions options, std::size_t buffer,
           const std::vector<PartToSend>& parts, const std::vector<std::string>& accepted, JobPast before = {});

  Result<void> feed(std::string_view bytes);
  Result<CheckedJob> finish();

 private:
  // A Found collects the warnings of one kind.
  struct Found {
    std::string first;  // place and text of the first warning
    std::string remedy;
    std::uint64_t more = 0;  // number of further places
    std::string last;        // last of the further places
  };

  const PartToSend& part() const { return parts_[checked_.parts.size()]; }
  Result<void> finish_part();
  Result<void> judge_errors() const;
  void take_warnings();
  bool is_accepted(std::string_view warning) const;
  Result<void> judge_warnings();
  Result<void> check_pieces() const;
  std::string place_text(const jobs::Place& place) const;
  std::string file_text() const;

  const jobs::Model& model_;
  const jobs::CheckOptions options_;
  const std::size_t buffer_;
  const std::vector<PartToSend>& parts_;
  const std::vector<std::string>& accepted_;
  const std::vector<std::string> accepted_before_;
  std::unique_ptr<jobs::Check> check_;     // check of part(); null: all parts are complete
  std::map<std::string, Found> warnings_;  // by name
  std::uint64_t begin_ = 0;                // byte offset of part() in the job
  std::uint64_t come_ = 0;                 // bytes of part() received up to now
  CheckedJob checked_;
};

}  // namespace axisgate::api
