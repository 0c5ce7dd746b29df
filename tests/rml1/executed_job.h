// What a simulated mill executes of a job, by the bytes that reached it and by its record, compared with the course
// that the gateway's model takes.
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
  // `text`: all that is sent of the job. The mill begins at the top above the work origin of kWork.
  ExecutedJob(const std::string& text, const Profile& profile);

  // A byte that the mill is given next. `through`: the bytes of the text with it; 0: it is none of the job's.
  void receives(char byte, std::uint64_t through);
  // The byte that this one of the text became is another, or is not there: of what follows nothing is compared.
  void changed(std::uint64_t through);
  // From here on the mill's buffer may overflow, so that bytes of the job are lost.
  void flow_control_is_ignored() { may_overflow_ = true; }
  void recorded(const std::string& line);

  // Bytes of the text that were read when the last command began, and when the one before did.
  std::uint64_t begun() const { return begun_; }
  std::uint64_t begun_before() const { return begun_before_; }
  // Of the text, by the mill, in full or in part.
  std::uint64_t received() const { return received_; }
  bool whole() const { return next_ == course_.size(); }
  // The first disagreement.
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
  std::size_t next_ = 0;  // of course_
  std::vector<Byte> bytes_;
  std::uint64_t received_ = 0, begun_ = 0, begun_before_ = 0;
  std::optional<std::uint64_t> same_through_;  // of the text
  bool of_job_ = false;                        // the last command that began
  bool other_begun_ = false, ended_ = false;   // a command that is none of the job's; in the middle of a movement
  bool compared_ = true, may_overflow_ = false;
  std::optional<std::string> violation_;
};

}  // namespace axisgate::rml1
