// The writes in which a job is sent.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "device/rml1/sending/cut.h"

namespace axisgate::rml1 {

inline std::vector<std::string> pieces(const std::string& job, std::size_t window = 64) {
  std::vector<std::string> all;
  for (Cutter cutter(job, window); cutter.begin() < job.size(); cutter.next()) {
    all.push_back(job.substr(cutter.begin(), cutter.end() - cutter.begin()));
  }
  return all;
}

}  // namespace axisgate::rml1
