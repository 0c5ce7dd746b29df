// Check of a job, or of one part of a job, before the job is queued.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/extent.h"
#include "device/jobs/leaves.h"
#include "device/jobs/origin.h"
#include "device/jobs/place.h"
#include "device/jobs/stock.h"

namespace axisgate::jobs {

struct CheckOptions {
  std::optional<Origin> origin{};  // nullopt: only sizes are checked
  std::optional<Stock> stock{};
  std::string made_for{};  // name of the machine that the job was made for; empty: concluded from the job itself
};

// First error of a job.
struct FoundError {
  Place place;
  std::string text;
  std::string section;     // section of the language's manual
  std::uint64_t more = 0;  // number of further errors
};

// All warnings of one kind in a job.
struct FoundWarning {
  std::string name;    // "deep-pass"
  std::string remedy;  // advice as the end of a sentence: "cut in several passes"
  Place place;         // place of the first warning
  std::string text;
  std::uint64_t more = 0;  // number of further warnings
  Place last{};            // place of the last of the further warnings
};

// A Piece is a sequence of bytes that must be sent in one write.
struct Piece {
  Place begin;
  std::size_t bytes = 0;
};

// Not thread safe.
class Check {
 public:
  virtual ~Check() = default;

  // Begins with the workpiece that the job of the check `before` leaves. `before` must be a check by the same Model.
  // Call this at most once, before feed().
  virtual void continues(Check& before) = 0;
  virtual void feed(std::string_view bytes) = 0;
  virtual void finish() = 0;

  // The following results are valid after finish().
  virtual std::optional<FoundError> error() const = 0;     // nullopt if the job has no error
  virtual std::vector<FoundWarning> warnings() const = 0;  // one element for each kind, in the order of the names
  virtual Leaves leaves() const = 0;
  virtual Extent extent() const = 0;
  virtual Piece longest_piece() const = 0;
};

}  // namespace axisgate::jobs
