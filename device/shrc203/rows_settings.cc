// Rows of the command table that set something, and nothing moves: manual 45), 52), 53), 63), 64), 89), 93).
#include "device/shrc203/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr CommandRow kRows[] = {
    shifts_frame(command("PSET:", "PSET:<a>{<m><u><c>}", "make this the coordinate of where the axis stands", 45,
                         kCoordinates, Effect::setting, kReady)),
    command("C:", "C:<a><c>", "switch motor excitation", 52, kAxesAndExcitation, Effect::setting, kReady),
    command("BEC:", "BEC:[<a>]", "clear BUSY, limit, overflow and emergency errors", 53, kAxesOnly, Effect::setting,
            kNothing),
    shifts_frame(command("R:", "R:[<a>]", "set the logical origin: the coordinate becomes 0", 63, kAxesOnly,
                         Effect::setting, kReadyExcited)),
    shifts_frame(
        command("RC:", "RC:[<a>]", "take the logical origin back", 64, kAxesOnly, Effect::setting, kReadyExcited)),
    command("D:", "D:<a>{S<spds>F<spdf>R<r>| }", "set speeds S, F and time R", 89, kSpeeds, Effect::setting, kReady),
    command("JD:", "JD:<a>{<u><spd>}", "change the speed of a running jog", 93, kSpeedsWithUnit, Effect::setting,
            kExcited),
};

}  // namespace

std::span<const CommandRow> settings() { return kRows; }

}  // namespace axisgate::shrc203::rows
