// Rows of the command table that change nothing: manual 1) to 44), 95).
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr CommandRow kQuestionsRows[] = {
    any_mode(question("*IDN?", "*IDN?", "vendor, model, serial number, firmware", 1, kNone, "identity")),
    question("!:", "!:", "whether any axis is busy", 2, kNone, "ready"),
    question("!:S", "!:[<a>]S", "whether each axis is busy", 3, kAxesOnly, "ready*"),
    question("Q:", "Q:", "coordinates and status", 4, kNone, "coordinate,coordinate,coordinate,error,stop,ready"),
    question("Q:S", "Q:S[<u>][<c>]", "coordinates and status of each axis", 5, kUnitAndCounter, "amount*,hex*,ready*"),
    question("SRQ:", "SRQ:", "status", 6, kNone, "error,stop,ready"),
    question("SRQ:S", "SRQ:[<a>]S", "status of each axis", 7, kAxesOnly, "hex*,ready*"),
    question("?:V", "?:V", "firmware version", 8, kNone, "version"),
    axis_question("?:R", "?:R[<a>]", "resolution of the scale in nm", 9, kAxesOnly, "decimal*"),
    axis_question("?:P", "?:P[<a>]", "resolution: displacement of one pulse in nm", 10, kAxesOnly, "decimal*"),
    axis_question("?:S", "?:S[<a>]", "divisions of the motor driver", 11, kAxesOnly, "number:1:8000*"),
    axis_question("?:AN", "?:AN[<a>]", "name of the axis in the memory switches", 12, kAxesOnly, "axis_name*"),
    question("?:D", "?:D[<a>]", "speeds S, F and time R", 13, kAxesOnly, "speed*"),
    axis_question("?:DS", "?:DS[<a>][,<u>]", "minimum speed S", 14, kAxesAndSpeedUnit, "decimal*"),
    axis_question("?:DF", "?:DF[<a>][,<u>]", "maximum speed F", 15, kAxesAndSpeedUnit, "decimal*"),
    axis_question("?:DR", "?:DR[<a>]", "acceleration and deceleration time R in ms", 16, kAxesOnly, "number:1:1000*"),
    question("?:B", "?:B[<a>]", "speeds S, F and time R of the mechanical origin return", 17, kAxesOnly, "speed*"),
    axis_question("?:M", "?:M[<a>][,<u>]", "relative movement set, execution buffer", 18, kAxesAndUnit, "setting*"),
    axis_question("?:MP", "?:MP[<a>][,<u>]", "relative movement set, prebuffer", 19, kAxesAndUnit, "setting*"),
    axis_question("?:A", "?:A[<a>][,<u>]", "absolute target set, execution buffer", 20, kAxesAndUnit, "setting*"),
    axis_question("?:AP", "?:AP[<a>][,<u>]", "absolute target set, prebuffer", 21, kAxesAndUnit, "setting*"),
    question("?:E", "?:E[,<u>]", "arc set, execution buffer", 22, kUnitOnly, "arc"),
    question("?:EP", "?:EP[,<u>]", "arc set, prebuffer", 23, kUnitOnly, "arc"),
    question("?:K", "?:K[,<u>]", "straight line set, execution buffer", 24, kUnitOnly, "line"),
    question("?:KP", "?:KP[,<u>]", "straight line set, prebuffer", 25, kUnitOnly, "line"),
    closed(number_question("?:O", "general-purpose outputs", 26, "number:0:63")),
    number_question("?:W", "wait before READY, in 0.1 s", 27, "number:0:2550"),
    axis_question("?:WT", "?:WT[<a>]", "wait set, prebuffer, in 0.1 s", 28, kAxesOnly, "number_or_NS:0:2550*"),
    axis_question("?:WI", "?:WI[<a>]", "input pattern waited for, prebuffer", 29, kAxesOnly, "number_or_NS:0:63*"),
    question("?:N", "?:N", "model name", 30, kNone, "model"),
    question("?:J", "?:J[<a>]", "jog direction set", 31, kAxesOnly, "direction*"),
    axis_question("?:ACS", "?:ACS[<a>]", "auto-config status", 32, kAxesOnly, "config*"),
    axis_question("?:C", "?:C[<a>]", "motor excitation", 33, kAxesOnly, "number:0:1*"),
    axis_question("?:F", "?:F[<a>]", "stage control: 0 closed loop, 1 open loop", 34, kAxesOnly, "number:0:1*"),
    number_question("?:SLEEP", "sleep", 35, "number:0:1"),
    number_question("?:BO", "display lighting", 36, "number:0:1"),
    any_mode(question("?:MODE", "?:MODE", "operation mode", 37, kNone, "mode")),
    question("?:FMT", "?:FMT", "command format", 38, kNone, "format"),
    number_question("?:BEEP", "beep", 39, "number:0:1"),
    means(Meaning::line_before,
          any_mode(question("?:CMD", "?:CMD", "the command received before this one", 40, kNone, "echo"))),
    question("?:L", "?:L", "program, its status, line and loops left", 41, kNone, "numbers"),
    question("?:T", "?:T", "trigger output: kind, axis, interval", 42, kNone, "trigger"),
    question("?:SN", "?:SN", "serial number", 43, kNone, "serial"),
    number_question("?:AXIS", "controllable axes", 44, "number:0:6"),
    closed(number_question("I:", "general-purpose inputs", 95, "number:0:63")),
};

}  // namespace

std::span<const CommandRow> questions() { return kQuestionsRows; }

}  // namespace axisgate::shrc203::rows
