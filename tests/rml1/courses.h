// What a job makes a mill do, in order: by the gateway's model and by the simulator.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "device/rml1/machine/machine.h"
#include "device/rml1/simulator/options.h"
#include "device/rml1/simulator/route.h"

namespace axisgate::rml1 {

struct Course {
  struct Event {
    enum class Kind { moved, spin_up, dwell, turn };
    Kind kind = Kind::moved;
    simulator::Position to{};  // of a move: steps from the home corner and from the top
    double amount = 0;         // seconds of a wait, degrees of a turn without their sign
  };
  std::vector<Event> events;
  simulator::Position final{};
  double seconds = 0;  // until the last event has ended; 0 of the model
};

// A millionth of a step or of a unit is the rounding of what is recorded.
bool operator==(const Course::Event& a, const Course::Event& b);
void PrintTo(const Course::Event& event, std::ostream* out);

// Where the work origin is, and Z0, in both: in mm.
inline constexpr Origin kWork{100, 100, 50};

// Of a line of the simulated mill's record; nothing where it is no movement and no wait.
std::optional<Course::Event> recorded_event(const std::string& line);

Course course_of_model(const std::string& job, const Profile& profile);
// Byte by byte: each when all before it has been executed, or at a baud rate.
Course course_of_mill(const std::string& job, const simulator::MillSetup& setup);
Course course_of_mill(const std::string& job, const simulator::MillSetup& setup, int baud);

}  // namespace axisgate::rml1
