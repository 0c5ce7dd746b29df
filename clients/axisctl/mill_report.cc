#include "clients/axisctl/mill_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

using nlohmann::ordered_json;
using namespace rml1;

std::vector<Diagnostic> in_order(const Diagnostics& diagnostics) {
  std::vector<Diagnostic> all = diagnostics.kept();
  const auto by_place = [](const Diagnostic& a, const Diagnostic& b) { return a.place.offset < b.place.offset; };
  std::stable_sort(all.begin(), all.end(), by_place);
  return all;
}

std::string counted(std::uint64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string reach_text(std::string_view axis, const Reach& reach, double step_mm) {
  if (!reach.any) return {};
  return fmt::format("{} {:.2f} to {:.2f} mm", axis, reach.lowest * step_mm, reach.highest * step_mm);
}

// -0.00 is shown as 0.00.
double plain(double value) { return std::abs(value) < 1e-9 ? 0 : value; }

ordered_json to_json(const Point& p) { return {{"x", plain(p.x)}, {"y", plain(p.y)}, {"z", plain(p.z)}}; }

ordered_json end_of(const Bounds& bounds, double Reach::*end) {
  ordered_json reported;
  for (const auto& [axis, reach] : {std::pair{"x", bounds.x}, {"y", bounds.y}, {"z", bounds.z}}) {
    reported[axis] = reach.any ? ordered_json(plain(reach.*end)) : ordered_json();
  }
  return reported;
}

}  // namespace

void print_diagnostics(const std::string& file, const Diagnostics& diagnostics) {
  for (const Diagnostic& one : in_order(diagnostics)) {
    const std::string number = one.number == 0 ? "" : fmt::format("error {}: ", one.number);
    print_line(fmt::format("{}:{}:{}: {}: {}{} [{}]", file, one.place.line, one.place.column, name(one.severity),
                           number, one.text, one.section));
  }
  if (diagnostics.omitted() > 0) print_line(fmt::format("and {} more", diagnostics.omitted()));
}

void print_summary(const Check& check, const Profile& profile, bool origin_known) {
  const Summary& job = check.summary();
  const double step = profile.step_mm;
  print_line(fmt::format("{} on the {}, steps of {} mm", counted(job.commands, "command"), profile.name, step));
  std::string reach;
  for (const std::string& part : {reach_text("X", job.bounds.x, step), reach_text("Y", job.bounds.y, step),
                                  reach_text("Z", job.bounds.z, step)}) {
    if (!part.empty()) reach += (reach.empty() ? "" : ", ") + part;
  }
  print_line(reach.empty() ? "nothing moves" : "reaches " + reach);
  print_line(fmt::format("drives {:.0f} mm, of them {:.0f} mm cutting; takes {}, by assumed accelerations",
                         job.distance_mm, job.cutting_mm, time_text(job)));
  print_line(fmt::format("ends at X {:.2f} mm, Y {:.2f} mm, Z {:.2f} mm; the spindle {}", plain(job.final.x) * step,
                         plain(job.final.y) * step, plain(job.final.z) * step,
                         job.spin_ups == 0   ? "never starts"
                         : job.spin_ups == 1 ? "starts once"
                                             : fmt::format("starts {} times", job.spin_ups)));
  if (job.rpm.any) print_line(fmt::format("cuts at {} rpm", to_string(job.rpm)));
  if (check.machine().lowered_by_default()) {
    print_line(fmt::format("lowers the tool before it sets Z1: Z {:.2f} mm is from the profile, a mill may differ",
                           profile.default_z1 * step));
  }
  if (!origin_known) print_line("without --origin the work area is not checked, and heights assume Z0 at the bottom");
  const Diagnostics& reported = check.diagnostics();
  if (reported.count(Severity::error) > job.commands) print_line("more errors than commands: is it a job in RML-1?");
  print_line(fmt::format("{}, {}, {}", counted(reported.count(Severity::error), "error"),
                         counted(reported.count(Severity::warning), "warning"),
                         counted(reported.count(Severity::note), "note")));
}

void print_json(const Check& check) {
  for (const Diagnostic& one : in_order(check.diagnostics())) {
    print_line(ordered_json{
        {"number", one.number},
        {"severity", name(one.severity)},
        {"offset", one.place.offset},
        {"line", one.place.line},
        {"column", one.place.column},
        {"section", one.section},
        {"text",
         one.text}}.dump());
  }
  const Summary& job = check.summary();
  const Diagnostics& reported = check.diagnostics();
  print_line(ordered_json{
      {"final", to_json(job.final)},
      {"bounds", job.bounds.z.any ? ordered_json{{"min", end_of(job.bounds, &Reach::lowest)},
                                                 {"max", end_of(job.bounds, &Reach::highest)}}
                                  : ordered_json()},
      {"seconds", {{"low", job.seconds_low}, {"high", job.seconds_high}}},
      {"distance_mm", job.distance_mm},
      {"cutting_mm", job.cutting_mm},
      {"rpm", job.rpm.any ? ordered_json{{"low", job.rpm.lowest}, {"high", job.rpm.highest}} : ordered_json()},
      {"spin_ups", job.spin_ups},
      {"commands", job.commands},
      {"errors", reported.count(Severity::error)},
      {"warnings", reported.count(Severity::warning)},
      {"notes", reported.count(Severity::note)},
      {"omitted", reported.omitted()}}
                 .dump());
}

}  // namespace axisgate::axisctl
