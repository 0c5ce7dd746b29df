// Text tables.
#pragma once

#include <string>
#include <vector>

namespace axisgate::axisctl {

// Formats rows of cells as lines. Each column is as wide as its widest cell; the last column is not padded. All rows
// must have as many cells as the first row.
std::vector<std::string> table_lines(const std::vector<std::vector<std::string>>& rows);

}  // namespace axisgate::axisctl
