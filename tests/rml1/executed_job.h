// Comparison of a simulated mill's execution of a job, from received bytes and record, with the course of the gateway's
// model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/machine/profile.h"
#include "tests/rml1/courses.h"

namespace axisgate::rml1 {

class ExecutedJob {
 public:
  // `text` is all that is sent for the job. The mill begins at the top above the work origin of kWork.
  ExecutedJob(const std::string& text, const Profile& profile);

  // Takes the next byte for the mill. `through` is the number of text bytes up to and including it; 0 if it is not part
  // of the job.
  void receives(char byte, std::uint64_t through);
  // The text byte at `through` was changed or lost on the line. Nothing after it is compared.
  void changed(std::uint64_t through);
  // The mill's buffer may overflow from here on, so that bytes of the job are lost.
  void flow_control_is_ignored() { may_overflow_ = true; }
  void recorded(const std::string& line);

  // Bytes of the text read when the last command began, and when the previous command began.
  std::uint64_t begun() const { return begun_; }
  std::uint64_t begun_before() const { return begun_before_; }
  // Bytes of the text that the mill received; whether it executed the whole text.
  std::uint64_t received() const { return received_; }
  bool whole() const { return next_ == course_.size(); }
  // Returns the first disagreement.
  const std::optional<std::string>& violation() const { return violation_; }

 private:
  struct Byte {
    char value;
    std::uint64_t through;
  };

  void lost(std::uint64_t through);
  void begins(std::size_t buffered);
  void happened(const Course::Event& event);
  bool is_part_of(const Course::Event& event) const;
  std::size_t unfinished_escape() const;
  void violate(std::string what);

  const std::vector<Course::Event> course_;
  simulator::Position tool_;
  std::size_t next_ = 0;  // index into course_
  std::vector<Byte> bytes_;
  std::uint64_t received_ = 0, begun_ = 0, begun_before_ = 0;
  std::optional<std::uint64_t> same_through_;  // bytes of the text
  bool of_job_ = false;                        // the last command that began belongs to the job
  bool other_begun_ = false, ended_ = false;   // a command outside the job began; a movement was ended in its middle
  bool compared_ = true, may_overflow_ = false;
  std::optional<std::string> violation_;
};

}  // namespace axisgate::rml1
