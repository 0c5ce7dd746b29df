#include "axisgate/errors.h"

#include <utility>

namespace axisgate {
namespace {

std::string whole_text(const ErrorParts& parts) {
  return parts.reason + ": " + parts.message + (parts.hint.empty() ? "" : " (" + parts.hint + ")");
}

}  // namespace

Error::Error(ErrorParts parts) : std::runtime_error(whole_text(parts)), parts_(std::move(parts)) {}

}  // namespace axisgate
