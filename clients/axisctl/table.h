// Rows of cells as lines.
#pragma once

#include <string>
#include <vector>

namespace axisgate::axisctl {

// Each column is as wide as its widest cell; the last one is not filled up. All rows have as many cells as the first.
std::vector<std::string> table_lines(const std::vector<std::vector<std::string>>& rows);

}  // namespace axisgate::axisctl
