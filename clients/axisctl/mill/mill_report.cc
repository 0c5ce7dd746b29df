#include "clients/axisctl/mill/mill_report.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

using namespace rml1;

std::string counted(std::uint64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// Returns 0 for tiny values, so that -0.00 is shown as 0.00.
double plain(double value) { return std::abs(value) < 1e-9 ? 0 : value; }

std::string reach_text(std::string_view axis, const jobs::Reach& reach, double step_mm) {
  return fmt::format("{} {:.2f} to {:.2f} mm", axis, plain(reach.lowest) * step_mm, plain(reach.highest) * step_mm);
}

// Returns the range of Z. The height of the top is shown only if Z0 is known.
std::string height_text(const Check& check, double step_mm, bool origin_known) {
  const jobs::Reach& z = check.summary().bounds.z;
  if (z.highest < check.machine().box().highest.z) return reach_text("Z", z, step_mm);
  return origin_known ? reach_text("Z", z, step_mm) + " (the top)"
                      : fmt::format("Z {:.2f} mm to the top", plain(z.lowest) * step_mm);
}

void print_sections(const Check& check) {
  for (const Section& one : check.sections()) {
    const std::string speed =
        one.speed == 0 ? std::string("at further speeds") : fmt::format("at {:g} mm/s", one.speed);
    print_line(fmt::format("{} {} from line {} on: {:.0f} mm, to {:.2f} mm deep, up to {:.2f} mm per pass{}",
                           one.plunges ? "plunges" : "cuts", speed, one.first.line, one.cutting_mm, one.deepest_mm,
                           one.pass_mm, one.removed_mm3 ? fmt::format(", removes {:.1f} mm3", *one.removed_mm3) : ""));
  }
}

void print_end(const Check& check, double step_mm, bool origin_known) {
  const Summary& job = check.summary();
  const std::string_view last = check.machine().spindle_turns()        ? " and turns at the end"
                                : !check.machine().spindle_permitted() ? ", and is forbidden at the end"
                                                                       : "";
  const std::string starts = job.spin_ups == 0   ? "never starts"
                             : job.spin_ups == 1 ? "starts once"
                                                 : fmt::format("starts {} times", job.spin_ups);
  const bool unknown_top = !origin_known && job.final.z >= check.machine().box().highest.z;
  print_line(fmt::format("ends at X {:.2f} mm, Y {:.2f} mm, {}; the spindle {}{}", plain(job.final.x) * step_mm,
                         plain(job.final.y) * step_mm,
                         unknown_top ? "at the top" : fmt::format("Z {:.2f} mm", plain(job.final.z) * step_mm), starts,
                         last));
}

}  // namespace

void print_diagnostics(const std::string& file, const Diagnostics& diagnostics) {
  for (const Diagnostic& one : diagnostics.in_order()) {
    const std::string number = one.number == 0 ? "" : fmt::format(" {}", one.number);
    const std::string kind = one.warning ? fmt::format(" [{}]", name(*one.warning)) : "";
    print_line(fmt::format("{}:{}:{}: {}{}: {}{} [{}]", file, one.place.line, one.place.column, name(one.severity),
                           number, one.text, kind, one.section));
  }
  for (const Diagnostics::Omitted& one : diagnostics.omitted()) {
    print_line(fmt::format("{}: {} more like the {} of line {}, up to line {}", file, one.count,
                           name(one.first.severity), one.first.place.line, one.last.line));
  }
}

void print_summary(const Check& check, const Profile& profile, bool origin_known) {
  const Summary& job = check.summary();
  const double step = profile.step_mm;
  print_line(fmt::format("{} on the {}, steps of {} mm", counted(job.commands, "command"), profile.name, step));
  print_line(job.bounds.z.any ? fmt::format("reaches {}, {}, {}", reach_text("X", job.bounds.x, step),
                                            reach_text("Y", job.bounds.y, step), height_text(check, step, origin_known))
                              : "nothing moves");
  print_line(fmt::format("drives {:.0f} mm, of them {:.0f} mm cutting; takes {}", job.distance_mm, job.cutting_mm,
                         time_text(job)));
  print_line("time: " + time_reason(job, profile));
  print_sections(check);
  print_end(check, step, origin_known);
  if (job.rpm.any) print_line(fmt::format("cuts at {} rpm", to_string(job.rpm)));
  if (!origin_known) print_line("without --origin the work area is not checked, and heights assume Z0 at the bottom");
  const Diagnostics& reported = check.diagnostics();
  print_line(fmt::format("{}, {}, {}", counted(reported.count(Severity::error), "error"),
                         counted(reported.count(Severity::warning), "warning"),
                         counted(reported.count(Severity::note), "note")));
}

}  // namespace axisgate::axisctl
