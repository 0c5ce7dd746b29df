#include "tests/shot/model.h"

#include "device/shot/command/row_forms.h"

namespace axisgate::shot2 {
namespace {

using namespace shot::rows;  // NOLINT(google-build-using-namespace)
using Kind = Parameter::Kind;

constexpr Parameter kAxes{"a", "axes: a number, or A=1+2", Kind::choice, "1 2 3 4 5 6 7 8 A"};
constexpr Parameter kSign{"m", "direction", Kind::choice, "+ -"};
constexpr Parameter kUnit{"u", "unit: P pulse", Kind::choice, "P"};
constexpr Parameter kTarget{"y", "target", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr std::array kAxesOnly{kAxes};
constexpr std::array kTargets{kAxes, kSign, kUnit, kTarget};

std::vector<CommandRow> all_rows() {
  return {
      question("*IDN?", "*IDN?", "vendor, model, serial number, firmware", 1, kNone, "identity"),
      question("!:", "!:", "whether any axis is busy", 2, kNone, "ready"),
      question("!:S", "!:S", "whether each axis is busy", 3, kNone, "ready*"),
      question("Q:SPC", "Q:SPC", "positions and status of each axis", 5, kNone, "amount*,hex*,ready*"),
      means(Meaning::line_before, question("?:CMD", "?:CMD", "the command before this one", 40, kNone, "echo")),
      completes(command("HRT:", "HRT:<a>", "find the origin", 60, kAxesOnly, Effect::motion, kReady)),
      command("L:", "L:<a>", "decelerate and stop", 65, kAxesOnly, Effect::stop, kNothing),
      prebuffer(setter("AP:", "AP:<a>{<m><u><y>}", "set a target", 70, kTargets, Register::ap, kNothing)),
      means(Meaning::go, completes(command("G:", "G:<a>", "start", 86, kAxesOnly, Effect::motion, kReady))),
  };
}

}  // namespace

const Model& model_of(int axis_count) {
  static const Model one("SHOT-1", 1, all_rows(), {}), two("SHOT-2", 2, all_rows(), {}),
      eight("SHOT-8", 8, all_rows(), {});
  return axis_count == 1 ? one : axis_count == 2 ? two : eight;
}

}  // namespace axisgate::shot2
