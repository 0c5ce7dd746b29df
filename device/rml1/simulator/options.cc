#include "device/rml1/simulator/options.h"

#include <array>
#include <string_view>

namespace axisgate::rml1::simulator {
namespace {

using Two = std::array<std::string_view, 2>;
using Three = std::array<std::string_view, 3>;

constexpr Three kEscapeK = {"toggle", "one-shot", "in-band"};
constexpr Two kEscapeKWhenFull = {"taken", "dropped"};
constexpr Two kViewTakesEffect = {"after-move", "at-once"};
constexpr Two kKeptOrDiscarded = {"kept", "discarded"};
constexpr Two kPausePosition = {"top", "stays"};
constexpr Three kCover = {"pauses", "ends", "ignored"};
constexpr Two kAtWithoutNumbers = {"panel", "profile"};
constexpr Two kInitializedHeights = {"profile", "panel"};
constexpr Two kDwell = {"command", "point"};
constexpr Three kAcceleration = {"none", "best", "worst"};

constexpr std::array kOptions = {
    OptionName{"escape_k", kEscapeK},
    OptionName{"escape_k_when_full", kEscapeKWhenFull},
    OptionName{"view_takes_effect", kViewTakesEffect},
    OptionName{"view_data", kKeptOrDiscarded},
    OptionName{"pause_position", kPausePosition},
    OptionName{"cover_open", kCover},
    OptionName{"at_without_numbers", kAtWithoutNumbers},
    OptionName{"initialized_heights", kInitializedHeights},
    OptionName{"dwell_per", kDwell},
    OptionName{"acceleration", kAcceleration},
};

}  // namespace

std::span<const OptionName> option_names() { return kOptions; }

Options::Options() : NamedOptions(option_names(), "simulated mill") {}

}  // namespace axisgate::rml1::simulator
