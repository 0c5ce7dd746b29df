#include "tests/rml1/mill.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::rml1 {
namespace {

class Witness : public ParserListener, public MachineListener {
 public:
  Witness(const Profile& profile, std::optional<jobs::Origin> origin, Diagnostics& diagnostics)
      : diagnostics_(diagnostics), machine_(profile, origin, diagnostics, *this) {}

  void execute(const Instruction& instruction) override {
    const auto errors = diagnostics_.count(Severity::error);
    machine_.execute(instruction);
    tell(instruction, diagnostics_.count(Severity::error) != errors);
  }
  void quit() override { machine_.quit(); }

  void moved(const Move& move) override { played.moves.push_back(move); }
  void waited(Wait what, double seconds, std::uint64_t) override {
    constexpr const char* kNames[] = {"spin up", "dwell", "turn"};
    played.waits.push_back(fmt::format("{} {}", kNames[static_cast<std::size_t>(what)], seconds));
  }
  void commanded(const jobs::Point&, const jobs::Point& target, bool, const Instruction&) override {
    played.commanded.push_back(target);
  }
  void lifted(double, const Instruction&) override {}

  void end() {
    played.final = machine_.tool();
    played.box = machine_.box();
    played.diagnostics = diagnostics_.kept();
    const auto by_place = [](const Diagnostic& a, const Diagnostic& b) { return a.place.offset < b.place.offset; };
    std::stable_sort(played.diagnostics.begin(), played.diagnostics.end(), by_place);
  }

  Played played;

 private:
  void tell(const Instruction& instruction, bool refused) {
    const Row& row = *instruction.row;
    const bool heights = row.operation == Operation::heights;
    if (refused && !heights) return;  // !ZM or !ZO outside the travel
    if (instruction.first || row.takes == Takes::axes) played.commands.emplace_back(row.name);
    std::string& line = played.commands.back();
    bool nothing = instruction.count > 0;
    for (std::size_t index = 0; index < instruction.count; ++index) {
      const bool missing = !instruction.given[index] || (refused && index == 0);
      nothing = nothing && missing;
      line += missing ? " -" : fmt::format(" {}", instruction.values[index]);
    }
    for (const AxisTarget& axis : instruction.axes) line += fmt::format(" {}{}", axis.letter, axis.value);
    if (nothing) played.commands.pop_back();
  }

  Diagnostics& diagnostics_;
  Machine machine_;
};

}  // namespace

Profile test_profile() {
  Profile profile;
  profile.name = "test mill";
  profile.step_mm = 0.01;
  profile.x_mm = profile.y_mm = 605;
  profile.z_mm = 60.5;
  profile.default_z1 = -100;
  profile.speed = {15, 15, 0.5, 15, 2, 0.5, 15, 2};
  profile.acceleration = {200, 100, 0.02};
  profile.spindle.minimum_rpm = profile.spindle.maximum_rpm = 6500;
  profile.spindle.spin_up_s = 2;
  profile.axes = "XYZ";
  profile.rotary = Rotary{'A', false, 10};
  profile.dialect.apart = {"YA"};
  return profile;
}

Played play(const std::string& job, const Profile& profile, std::optional<jobs::Origin> origin,
            std::span<const Row> more_rows, const std::vector<std::size_t>& cuts) {
  Diagnostics diagnostics;
  Witness witness(profile, origin, diagnostics);
  Parser parser(profile.dialect, diagnostics, witness, more_rows);
  std::size_t begin = 0;
  for (const std::size_t cut : cuts) {
    parser.feed(std::string_view(job).substr(begin, cut - begin));
    begin = cut;
  }
  parser.feed(std::string_view(job).substr(begin));
  parser.finish();
  witness.end();
  return witness.played;
}

double sum_of(const Timeline& timeline, float Step::*time) {
  double sum = 0;
  for (const Step& step : timeline.steps()) sum += step.*time;
  return sum;
}

}  // namespace axisgate::rml1
