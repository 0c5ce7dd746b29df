// The check of a job, or of a part that is sent by itself, before the job is queued.
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
  std::optional<Origin> origin{};  // nullopt: only sizes are judged
  std::optional<Stock> stock{};
  std::string made_for{};  // name of a machine, by the job's maker; empty: the job itself decides
};

// First error of a job.
struct FoundError {
  Place place;
  std::string text;
  std::string section;     // of the language's manual
  std::uint64_t more = 0;  // number of further errors
};

// All of one kind of warning in a job.
struct FoundWarning {
  std::string name;    // "deep-pass"
  std::string remedy;  // advice as the end of a sentence: "cut in several passes"
  Place place;         // of the first
  std::string text;
  std::uint64_t more = 0;  // number of further places
  Place last{};            // of these
};

// A run of bytes that can only be sent at once.
struct Piece {
  Place begin;
  std::size_t bytes = 0;
};

// Not thread safe.
class Check {
 public:
  virtual ~Check() = default;

  // Takes over the workpiece as `before`, a check by the same Model, has left it. Call it once, before feed().
  virtual void continues(Check& before) = 0;
  virtual void feed(std::string_view bytes) = 0;
  virtual void finish() = 0;

  // All that follows is valid after finish().
  virtual std::optional<FoundError> error() const = 0;     // nullopt if there is none
  virtual std::vector<FoundWarning> warnings() const = 0;  // one for each kind, by name
  virtual Leaves leaves() const = 0;
  virtual Extent extent() const = 0;
  virtual Piece longest_piece() const = 0;
};

}  // namespace axisgate::jobs
