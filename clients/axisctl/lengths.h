// Three lengths that are typed as one word: "80,50,10.5", in mm.
#pragma once

#include <string>

#include "device/rml1/check/stock.h"
#include "device/rml1/machine/point.h"

namespace axisgate::axisctl {

// `option`: where it was typed. Throws Failure, also below.
rml1::Point lengths(const std::string& text, const char* option);

// Of --stock: each is above 0.
rml1::Stock stock_of(const std::string& text);

}  // namespace axisgate::axisctl
