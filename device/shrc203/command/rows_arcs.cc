// Rows of the command table that set arcs and helices: manual 71) to 82). Points are relative to the present position.
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr Parameter kPlane{"a", "axes of the circle: A=1+2, B=1+3, C=2+3", Kind::choice, "A B C"};
constexpr Parameter kHelixPlane{"a", "axes of the circle: A=1+2; axis 3 goes along", Kind::choice, "A"};
constexpr Parameter kRotation{"d", "rotation: 0 clockwise, 1 counterclockwise", Kind::choice, "0 1"};
constexpr Parameter kTurns{"n", "number of rotations", Kind::integer, {}, 1, 1000, "rotations"};
constexpr Parameter kCenter1{
    "c1", "center from here, axis with the smaller number", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kCenter2{
    "c2", "center from here, axis with the larger number", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kPassing1{
    "p1", "passing point from here, axis with the smaller number", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kPassing2{
    "p2", "passing point from here, axis with the larger number", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kEnd1{"e1",    "end from here, axis with the smaller number", Kind::decimal, {}, 0, 999'999'999,
                          "pulses"};
constexpr Parameter kEnd2{"e2",    "end from here, axis with the larger number", Kind::decimal, {}, 0, 999'999'999,
                          "pulses"};
constexpr Parameter kAngle{"ae", "angle of the arc", Kind::angle, {}, 0, 360, "degrees"};
constexpr Parameter kHelixAngle{"ae", "angle of the helix", Kind::angle, {}, 0, 360'000, "degrees"};
constexpr Parameter kRiseOfTurn{"z",     "displacement of axis 3 in each rotation", Kind::decimal, {}, 0, 999'999'999,
                                "pulses"};
constexpr Parameter kRiseByAngle{
    "z", "displacement of axis 3, from 360 degrees on in each rotation", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kRise{"z", "displacement of axis 3", Kind::decimal, {}, 0, 999'999'999, "pulses"};

constexpr std::array kCircle{kPlane,   kRotation,     kSign,         kLineUnit,    kCenter1,
                             kCenter2, kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kArc{kPlane,   kRotation, kSign,         kLineUnit,     kCenter1,
                          kCenter2, kAngle,    kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kThrough{kPlane, kRotation, kSign,         kLineUnit,     kPassing1,    kPassing2,
                              kEnd1,  kEnd2,     kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kHelixOfTurns{kHelixPlane, kRotation,   kTurns,        kSign,         kLineUnit,    kCenter1,
                                   kCenter2,    kRiseOfTurn, kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kHelixByAngle{kHelixPlane, kRotation,    kSign,         kLineUnit,     kCenter1,     kCenter2,
                                   kHelixAngle, kRiseByAngle, kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kHelixThrough{kHelixPlane, kRotation, kSign, kLineUnit,     kPassing1,     kPassing2,
                                   kEnd1,       kEnd2,     kRise, kMinimumSpeed, kMaximumSpeed, kAcceleration};

// E: has no speed parameters: it uses S, F and R of D: (manual 71)).
constexpr std::span<const Parameter> without_speeds(std::span<const Parameter> parameters) {
  return parameters.first(parameters.size() - 3);
}

// "The axis not set by the arc interpolation axis becomes the linear motion axis" (manual 74)).
constexpr CommandRow third_axis(CommandRow row) {
  row.third_axis = true;
  return row;
}

// A setter() row whose curve form is the last character of the name.
constexpr CommandRow curve(std::string_view name, std::string_view format, std::string_view description, int section,
                           std::span<const Parameter> parameters, Register reg, Needs needs) {
  CommandRow row = setter(name, format, description, section, parameters, reg, needs);
  row.curve = static_cast<CurveForm>(name.back() - '0');
  return row;
}

constexpr CommandRow kArcsRows[] = {
    whole_controller(curve("E:0", "E:0<a><d><m><u><c1><m><u><c2>", "set a circle", 71, without_speeds(kCircle),
                           Register::e, kReadyExcitedNoLimit)),
    whole_controller(curve("E:1", "E:1<a><d><m><u><c1><m><u><c2>D<ae>", "set an arc by its angle", 72,
                           without_speeds(kArc), Register::e, kReadyExcitedNoLimit)),
    whole_controller(curve("E:2", "E:2<a><d><m><u><p1><m><u><p2><m><u><e1><m><u><e2>", "set an arc through a point", 73,
                           without_speeds(kThrough), Register::e, kReadyExcitedNoLimit)),
    third_axis(
        whole_controller(curve("E:3", "E:3<a><d>N<n><m><u><c1><m><u><c2><m><u><z>", "set a helix of whole rotations",
                               74, without_speeds(kHelixOfTurns), Register::e, kReadyExcitedNoLimit))),
    third_axis(whole_controller(curve("E:4", "E:4<a><d><m><u><c1><m><u><c2>D<ae><m><u><z>", "set a helix by its angle",
                                      75, without_speeds(kHelixByAngle), Register::e, kReadyExcitedNoLimit))),
    third_axis(whole_controller(curve("E:5", "E:5<a><d><m><u><p1><m><u><p2><m><u><e1><m><u><e2><m><u><z>",
                                      "set a helix through a point", 76, without_speeds(kHelixThrough), Register::e,
                                      kReadyExcitedNoLimit))),
    whole_controller(prebuffer(curve("EP:0", "EP:0<a><d><m><u><c1><m><u><c2>[,S<spds>F<spdf>R<r>]",
                                     "set a circle, prebuffer", 77, kCircle, Register::ep, kExcitedNoLimit))),
    whole_controller(prebuffer(curve("EP:1", "EP:1<a><d><m><u><c1><m><u><c2>D<ae>[,S<spds>F<spdf>R<r>]",
                                     "set an arc by its angle, prebuffer", 78, kArc, Register::ep, kExcitedNoLimit))),
    whole_controller(
        prebuffer(curve("EP:2", "EP:2<a><d><m><u><p1><m><u><p2><m><u><e1><m><u><e2>[,S<spds>F<spdf>R<r>]",
                        "set an arc through a point, prebuffer", 79, kThrough, Register::ep, kExcitedNoLimit))),
    third_axis(whole_controller(prebuffer(
        curve("EP:3", "EP:3<a><d>N<n><m><u><c1><m><u><c2><m><u><z>[,S<spds>F<spdf>R<r>]",
              "set a helix of whole rotations, prebuffer", 80, kHelixOfTurns, Register::ep, kExcitedNoLimit)))),
    third_axis(whole_controller(
        prebuffer(curve("EP:4", "EP:4<a><d><m><u><c1><m><u><c2>D<ae><m><u><z>[,S<spds>F<spdf>R<r>]",
                        "set a helix by its angle, prebuffer", 81, kHelixByAngle, Register::ep, kExcitedNoLimit)))),
    third_axis(whole_controller(
        prebuffer(curve("EP:5", "EP:5<a><d><m><u><p1><m><u><p2><m><u><e1><m><u><e2><m><u><z>[,S<spds>F<spdf>R<r>]",
                        "set a helix through a point, prebuffer", 82, kHelixThrough, Register::ep, kExcitedNoLimit)))),
};

}  // namespace

std::span<const CommandRow> arcs() { return kArcsRows; }

}  // namespace axisgate::shrc203::rows
