#include <cmath>
#include <nlohmann/json.hpp>

#include "clients/axisctl/mill/mill_report.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

using nlohmann::ordered_json;
using namespace rml1;

// Converts steps: `unit` is 1 for steps, or the length of a step for mm. Never returns -0.
ordered_json number(double steps, double unit) { return std::abs(steps) < 1e-9 ? 0 : steps * unit; }

ordered_json to_json(const jobs::Point& p, double unit) {
  return {{"x", number(p.x, unit)}, {"y", number(p.y, unit)}, {"z", number(p.z, unit)}};
}

// Returns null if nothing moves. Testing Z is enough: either all three axes have bounds, or none.
ordered_json to_json(const jobs::Bounds& bounds, double unit) {
  if (!bounds.z.any) return {};
  return {{"min", to_json(jobs::Point{bounds.x.lowest, bounds.y.lowest, bounds.z.lowest}, unit)},
          {"max", to_json(jobs::Point{bounds.x.highest, bounds.y.highest, bounds.z.highest}, unit)}};
}

ordered_json to_json(const Section& section) {
  return {{"kind", section.plunges ? "plunge" : "cut"},
          {"speed_mm_s", section.speed == 0 ? ordered_json() : ordered_json(section.speed)},
          {"line", section.first.line},
          {"cutting_mm", section.cutting_mm},
          {"deepest_mm", section.deepest_mm},
          {"pass_mm", section.pass_mm},
          {"removed_mm3", section.removed_mm3 ? ordered_json(*section.removed_mm3) : ordered_json()}};
}

ordered_json to_json(const std::vector<Section>& sections) {
  ordered_json all = ordered_json::array();
  for (const Section& one : sections) all.push_back(to_json(one));
  return all;
}

ordered_json to_json(const Diagnostic& one) {
  ordered_json json{{"number", one.number},   {"severity", name(one.severity)}, {"offset", one.place.offset},
                    {"line", one.place.line}, {"column", one.place.column},     {"section", one.section},
                    {"text", one.text}};
  if (one.warning) json["warning"] = name(*one.warning);
  return json;
}

}  // namespace

void print_json(const Check& check, const Profile& profile) {
  const Diagnostics& reported = check.diagnostics();
  for (const Diagnostic& one : reported.in_order()) print_line(to_json(one).dump());
  const Summary& job = check.summary();
  const bool top = job.bounds.z.any && job.bounds.z.highest >= check.machine().box().highest.z;
  print_line(ordered_json{
      {"step_mm", profile.step_mm},
      {"final", to_json(job.final, 1)},
      {"final_mm", to_json(job.final, profile.step_mm)},
      {"bounds", to_json(job.bounds, 1)},
      {"bounds_mm", to_json(job.bounds, profile.step_mm)},
      {"reaches_top", top},
      {"seconds", {{"low", job.seconds_low}, {"high", job.seconds_high}}},
      {"seconds_down", job.seconds_down},
      {"distance_mm", job.distance_mm},
      {"cutting_mm", job.cutting_mm},
      {"sections", to_json(check.sections())},
      {"rpm", job.rpm.any ? ordered_json{{"low", job.rpm.lowest}, {"high", job.rpm.highest}} : ordered_json()},
      {"spin_ups", job.spin_ups},
      {"spindle_turns", check.machine().spindle_turns()},
      {"spindle_permitted", check.machine().spindle_permitted()},
      {"commands", job.commands},
      {"errors", reported.count(Severity::error)},
      {"warnings", reported.count(Severity::warning)},
      {"notes", reported.count(Severity::note)},
      {"omitted", reported.omitted_count()}}
                 .dump());
}

}  // namespace axisgate::axisctl
