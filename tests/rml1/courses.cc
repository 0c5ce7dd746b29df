#include "tests/rml1/courses.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "device/rml1/simulator/seconds.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1 {
namespace {

using Kind = Course::Event::Kind;

constexpr double kSame = 5e-6;

class Model : public ParserListener, public MachineListener {
 public:
  explicit Model(const Profile& profile) : profile_(profile), machine_(profile, kWork, diagnostics_, *this) {}

  Course play(const std::string& job) {
    Parser parser(profile_.dialect, diagnostics_, *this);
    parser.feed(job);
    parser.finish();
    course_.final = place(machine_.tool());
    return course_;
  }

 private:
  void execute(const Instruction& instruction) override { machine_.execute(instruction); }
  void quit() override { machine_.quit(); }
  void moved(const Move& move) override {
    // Clipping can leave a tiny move that is only a rounding error.
    if (length(move.to - move.from) > kSame) course_.events.push_back({Kind::moved, place(move.to)});
  }
  void waited(Wait what, double seconds, std::uint64_t) override {
    if (what == Wait::turn) return course_.events.push_back({Kind::turn, {}, seconds * profile_.rotary->degrees_per_s});
    course_.events.push_back({what == Wait::dwell ? Kind::dwell : Kind::spin_up, {}, seconds});
  }
  void commanded(const jobs::Point&, const jobs::Point&, bool, const Instruction&) override {}
  void lifted(double, const Instruction&) override {}

  simulator::Position place(const jobs::Point& p) const {
    const Box box = machine_.box();
    return {p.x - box.lowest.x, p.y - box.lowest.y, p.z - box.highest.z};
  }

  const Profile& profile_;
  Diagnostics diagnostics_;
  Machine machine_;
  Course course_;
};

// Parses the numbers after the key: "...:[[1,2,3],[4,5,6]]}".
std::vector<double> numbers_after(const std::string& line, std::string_view key) {
  std::string text = line.substr(line.find(key) + key.size());
  std::ranges::replace_if(
      text, [](char c) { return c == '[' || c == ']' || c == ',' || c == '}'; }, ' ');
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double one = 0; in >> one;) numbers.push_back(one);
  return numbers;
}

// A mill at the work origin and at the top, where a job of the model begins.
class Mill : public simulator::MillBench {
 public:
  explicit Mill(const simulator::MillSetup& setup) : MillBench(setup), profile_(setup.profile) {
    mill.set_origin(std::round(profile_.steps(kWork.x)), std::round(profile_.steps(kWork.y)), now);
    mill.set_z0(profile_.top - profile_.up * std::round(profile_.steps(kWork.z)), now);
    send("H;!MC1;");
    finish();
    lines.clear();
    began_ = now;
  }

  Course course() {
    Course course;
    for (const std::string& line : lines) {
      const auto event = recorded_event(line);
      if (!event) continue;
      course.events.push_back(*event);
      if (event->kind == Kind::moved) tool_ = event->to;
      course.seconds = numbers_after(line, "\"t\":").at(0) - simulator::in_seconds(began_ - TimePoint{});
    }
    course.final = tool_;
    return course;
  }

 private:
  const Profile& profile_;
  TimePoint began_{};
  simulator::Position tool_{std::round(profile_.steps(kWork.x)), std::round(profile_.steps(kWork.y)), 0};
};

}  // namespace

std::optional<Course::Event> recorded_event(const std::string& line) {
  const auto has = [&line](std::string_view key) { return line.find(key) != std::string::npos; };
  if (has("\"path\":")) {
    const auto ends = numbers_after(line, "\"path\":");
    return Course::Event{Kind::moved, {ends.at(3), ends.at(4), ends.at(5)}};
  }
  if (has("\"wait\":")) {
    const double seconds = numbers_after(line, "\"seconds\":").at(0);
    return Course::Event{has("dwell") ? Kind::dwell : Kind::spin_up, {}, seconds};
  }
  if (!has("\"turn\":")) return std::nullopt;
  const double degrees = std::abs(numbers_after(line, "\"turn\":").at(0));
  return degrees > 0 ? std::optional(Course::Event{Kind::turn, {}, degrees}) : std::nullopt;
}

bool operator==(const Course::Event& a, const Course::Event& b) {
  const auto same = [](double one, double other) { return std::abs(one - other) <= kSame; };
  return a.kind == b.kind && same(a.to.x, b.to.x) && same(a.to.y, b.to.y) && same(a.to.h, b.to.h) &&
         same(a.amount, b.amount);
}

void PrintTo(const Course::Event& event, std::ostream* out) {
  constexpr const char* kNames[] = {"to", "spin up", "dwell", "turn"};
  *out << kNames[static_cast<std::size_t>(event.kind)];
  if (event.kind != Kind::moved) *out << fmt::format(" {}", event.amount);
  if (event.kind == Kind::moved) *out << fmt::format(" {} {} {}", event.to.x, event.to.y, event.to.h);
}

Course course_of_model(const std::string& job, const Profile& profile) { return Model(profile).play(job); }

Course course_of_mill(const std::string& job, const simulator::MillSetup& setup) {
  Mill mill(setup);
  for (const char byte : job) {
    mill.send({&byte, 1});
    mill.finish();
  }
  return mill.course();
}

Course course_of_mill(const std::string& job, const simulator::MillSetup& setup, int baud) {
  Mill mill(setup);
  for (const char byte : job) {
    mill.now += std::chrono::nanoseconds(std::chrono::seconds(10)) / baud;
    mill.send({&byte, 1});
  }
  mill.finish();
  return mill.course();
}

}  // namespace axisgate::rml1
