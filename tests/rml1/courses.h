// The course of a job: the events that it causes, in order, by the gateway's model and by the simulator.
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
    simulator::Position to{};  // target of a move: steps from the home corner and from the top
    double amount = 0;         // seconds of a wait, degrees of a turn without their sign
  };
  std::vector<Event> events;
  simulator::Position final{};
  double seconds = 0;  // until the last event has ended; 0 for the model
};

// Compares events. Allows a millionth of a step or of a unit for the rounding of recorded numbers.
bool operator==(const Course::Event& a, const Course::Event& b);
void PrintTo(const Course::Event& event, std::ostream* out);

// Work origin and Z0 of model and simulator, in mm.
inline constexpr jobs::Origin kWork{100, 100, 50};

// Parses a line of the simulated mill's record. nullopt if the line is neither a movement nor a wait.
std::optional<Course::Event> recorded_event(const std::string& line);

Course course_of_model(const std::string& job, const Profile& profile);
// Sends the job byte by byte: each byte once all earlier ones have been executed, or at a baud rate.
Course course_of_mill(const std::string& job, const simulator::MillSetup& setup);
Course course_of_mill(const std::string& job, const simulator::MillSetup& setup, int baud);

}  // namespace axisgate::rml1
