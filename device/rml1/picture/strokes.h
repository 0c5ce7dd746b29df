// Strokes of a job's path, kept to be drawn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/jobs/bounds.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::rml1 {

// Collects the moves while a job is checked: 28 bytes each, without a limit. Not thread safe.
class Strokes : public MoveListener {
 public:
  enum class Kind : std::uint8_t { travel, cut, left_out };
  enum class Done : std::uint8_t { yes, perhaps, no };
  struct Stroke {
    std::array<float, 3> from, to;  // steps
    Kind kind;
    Done done;
    std::uint8_t part;      // counts from 0
    double length() const;  // steps
  };

  // `executed`: range within which the executed part of the job ends, in lines and columns. By default nothing was
  // executed.
  explicit Strokes(const jobs::PlaceRange& executed = {}) : executed_(executed) {}

  // Begins the next part of the job; the following moves belong to it.
  void begin_part() { ++part_; }
  void moved(const Move& move) override;
  void left_out(const jobs::Point& from, const jobs::Point& to) override;

  const std::vector<Stroke>& all() const { return all_; }
  std::size_t parts() const { return part_ + 1U; }
  const jobs::PlaceRange& executed() const { return executed_; }
  // Reports whether this stroke is drilled: straight down, and straight up again.
  bool is_hole(std::size_t index) const;
  const jobs::Reach& feeds() const { return feeds_; }  // mm/s, of cuts along or down
  bool any_left_out() const { return any_left_out_; }

 private:
  void add(const jobs::Point& from, const jobs::Point& to, Kind kind, Done done);
  Done done(const jobs::Place& begin) const;

  const jobs::PlaceRange executed_;
  std::vector<Stroke> all_;
  jobs::Reach feeds_;
  bool any_left_out_ = false;
  std::uint8_t part_ = 0;
};

}  // namespace axisgate::rml1
