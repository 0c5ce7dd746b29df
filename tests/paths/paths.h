// Folders of this build that tests read. Only paths.cc knows where they are, so that the objects of all other tests are
// the same in every checkout and come out of a compiler cache.
#pragma once

#include <filesystem>

namespace axisgate::paths {

/// Returns the path of a file or folder of the project, for example "deploy/stages".
std::filesystem::path in_project(const std::filesystem::path& path);

/// Returns the folder of the jobs that tests/jobs writes when the tests are built, with their table jobs.tsv.
std::filesystem::path written_jobs();

}  // namespace axisgate::paths
