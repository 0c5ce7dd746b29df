#include "tests/paths/paths.h"

namespace axisgate::paths {

std::filesystem::path in_project(const std::filesystem::path& path) { return AXISGATE_SOURCE_DIR / path; }

std::filesystem::path written_jobs() { return AXISGATE_WRITTEN_JOBS; }

}  // namespace axisgate::paths
