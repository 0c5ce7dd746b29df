// Parsing of three lengths in mm that are typed as one word: "80,50,10.5".
#pragma once

#include <string>

#include "device/jobs/point.h"
#include "device/jobs/stock.h"

namespace axisgate::axisctl {

// Parses three lengths. `option` is the option's name, for messages. Throws Failure if the text is not valid, as does
// stock_of().
jobs::Point lengths(const std::string& text, const char* option);

// Parses the value of --stock, whose lengths must be above 0.
jobs::Stock stock_of(const std::string& text);

}  // namespace axisgate::axisctl
