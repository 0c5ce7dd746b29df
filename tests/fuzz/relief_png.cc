// Stands in for png.cc, whose library is not instrumented: a relief is computed, and not written.
#include "device/rml1/relief.h"

namespace axisgate::rml1 {

std::string png_of(const Relief& relief) { return std::string(relief.pixels().size() % 3, 'x'); }

}  // namespace axisgate::rml1
