// Manual 71) to 84): arcs, helices and straight lines.
#include "tests/refusals/manual.h"

namespace axisgate::refusals {
namespace {

// Returns the sentence of an interpolation. `wrong` has the line with values that the section does not allow.
Sentence curve(int section, const std::string& command, const std::string& line, const std::string& third,
               Lines wrong = {}) {
  const bool helix = command.back() >= '3';
  const bool prebuffer = command.starts_with("EP");
  wrong.push_back(command + "A2" + line.substr(command.size() + 2));
  if (prebuffer) {
    wrong.push_back(line + ",S0F1000R50");
    wrong.push_back(line + ",S100F1000001R50");
    wrong.push_back(line + ",S2000F1000R50");
    wrong.push_back(line + ",S100F1000R1001");
  }
  return {.section = section,
          .command = command,
          .line = line,
          .ng = prebuffer ? "EL" : "BEL",
          .after = {helix ? "G:D" : "G:A"},
          .out_of_range = wrong,
          .malformed = command + "A0",
          .third = third,
          .moves = true};
}

}  // namespace

std::vector<Sentence> interpolations() {
  std::vector<Sentence> all;
  for (const bool prebuffer : {false, true}) {
    const std::string e = prebuffer ? "EP:" : "E:";
    const int section = prebuffer ? 77 : 71;
    all.push_back(curve(section, e + "0", e + "0A0+P100-P100", e + "0B0+P100-P100", {e + "0A0+P1000000000-P100"}));
    all.push_back(curve(section + 1, e + "1", e + "1A0+P100-P200D90", e + "1B0+P100-P200D90",
                        {e + "1A0+P100-P200D0", e + "1A0+P100-P200D361"}));
    all.push_back(curve(section + 2, e + "2", e + "2A0+P50+P30+P80+P120", e + "2B0+P50+P30+P80+P120",
                        {e + "2A0+P50+P30+P80+P1000000000"}));
    all.push_back(curve(section + 3, e + "3", e + "3A0N1+P0+P500+P200", e + "3A0N1+P0+P500+P200",
                        {e + "3A0N0+P0+P500+P200", e + "3A0N1001+P0+P500+P200"}));
    all.push_back(curve(section + 4, e + "4", e + "4A0+P0+P100D90+P50", e + "4A0+P0+P100D90+P50",
                        {e + "4A0+P0+P100D0+P50", e + "4A0+P0+P100D360001+P50"}));
    all.push_back(curve(section + 5, e + "5", e + "5A0-P50+P30-P80+P120+P100", e + "5A0-P50+P30-P80+P120+P100",
                        {e + "5A0-P50+P30-P80+P120+P1000000000"}));
  }
  all.push_back({.section = 83,
                 .command = "K:",
                 .line = "K:A+P1000+P200",
                 .ng = "BEL",
                 .after = {"G:A"},
                 .out_of_range = {"K:A+P1000000000+P200"},
                 .malformed = "K:A+P1000",
                 .third = "K:B+P1000+P200",
                 .moves = true});
  all.push_back(
      {.section = 84,
       .command = "KP:",
       .line = "KP:A+P1000+P200,S100F1000R200",
       .ng = "EL",
       .after = {"G:A"},
       .out_of_range = {"KP:A+P1000+P1000000000", "KP:A+P1000+P200,S0F1000R200", "KP:A+P1000+P200,S100F1000001R200",
                        "KP:A+P1000+P200,S2000F1000R200", "KP:A+P1000+P200,S100F1000R1001"},
       .malformed = "KP:A+P1000",
       .third = "KP:B+P1000+P200",
       .moves = true});
  return all;
}

}  // namespace axisgate::refusals
