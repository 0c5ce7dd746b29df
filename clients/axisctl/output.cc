#include "clients/axisctl/output.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "clients/axisctl/failure.h"

namespace axisgate::axisctl {

Output::Output(std::string path) : path_(std::move(path)) {
  if (path_.empty() || path_ == "-") return;
  file_ = std::fopen(path_.c_str(), "we");
  if (file_ == nullptr) {
    throw usage(fmt::format("{} cannot be written: {}", path_, std::strerror(errno)), "name another with --output");
  }
}

Output::~Output() {
  if (is_file()) std::fclose(file_);
}

void Output::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fflush(file_) == 0) return;
  throw Failure{
      kFailed, "NOT_WRITTEN",
      fmt::format("writing to {} has failed: {}", is_file() ? path_ : "the standard output", std::strerror(errno)),
      "what was written before stays"};
}

}  // namespace axisgate::axisctl
