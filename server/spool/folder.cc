#include "server/spool/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "device/core/explain.h"
#include "server/access/synced_file.h"
#include "server/events/wall_time.h"
#include "server/log.h"
#include "server/spool/record.h"
#include "server/spool/sha256.h"

namespace axisgate::server::spool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBytes = ".rml", kRecord = ".json", kUpload = "upload-";
constexpr mode_t kMode = 0600;

// Returns the number before the first dot or the end of the line.
std::optional<std::uint64_t> number_in(std::string_view text) {
  text = text.substr(0, text.find_first_of(".\n"));
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string file_name(std::uint64_t id, std::string_view suffix) { return fmt::format("{}{}", id, suffix); }

// Reports whether the file has the bytes of an upload that was interrupted before or while it got its number.
bool is_unfinished(const std::string& name, const std::set<std::string>& all) {
  if (name.starts_with(kUpload)) return true;
  const std::optional<std::uint64_t> id = number_in(name);
  return id && name == file_name(*id, kBytes) && !all.contains(file_name(*id, kRecord));
}

}  // namespace

Result<std::set<std::string>> names_in(const std::string& directory) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    names.insert(entry->path().filename().string());
  }
  if (!error || error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory) return names;
  return fail(Reason::internal, fmt::format("cannot read {}: {}", directory, error.message()),
              "let the daemon's user read it");
}

std::string Folder::file(std::uint64_t id, std::string_view suffix) const {
  return path_ + "/" + file_name(id, suffix);
}

Result<std::vector<Job>> Folder::read() {
  const auto names = names_in(path_);
  if (!names) return tl::unexpected(names.error());
  last_ = last_on_disk();
  std::vector<Job> jobs;
  for (const std::string& name : *names) {
    const std::optional<std::uint64_t> id = number_in(name);
    if (id) last_ = std::max(last_, *id);
    if (id && name == file_name(*id, kRecord)) {
      Result<Job> job = read_job(*id);
      if (job) jobs.push_back(*std::move(job));
      if (!job) move_aside(*id, job.error());
    } else if (is_unfinished(name, *names)) {
      log::info("{}/{}: its upload was not finished; it is removed", path_, name);
      const Result<void> removed = id ? remove(*id) : remove_upload(path_ + "/" + name);
      if (!removed) log::warn("{}", explain(removed.error()));
    }
  }
  return jobs;
}

std::uint64_t Folder::last_on_disk() const {
  const std::string path = path_ + "/last";
  const Result<std::string> text = read_state_file(path);
  if (text && text->empty()) return 0;
  const auto last = text ? number_in(*text) : std::nullopt;
  if (!last) {
    log::error("{}; the next job has the number after the highest in that directory",
               text ? fmt::format("{} has no number", path) : text.error().message);
  }
  return last.value_or(0);
}

Result<Job> Folder::read_job(std::uint64_t id) const {
  const std::string path = file(id, kRecord);
  const Result<std::string> text = read_state_file(path);
  if (!text) return tl::unexpected(text.error());
  std::optional<Job> job = job_in(*text);
  if (!job || job->id != id) return fail(Reason::internal, fmt::format("{} does not describe a job {}", path, id));
  const Result<void> same = read_bytes(*job, [](std::string_view) {});
  if (!same) return tl::unexpected(same.error());
  return *std::move(job);
}

void Folder::move_aside(std::uint64_t id, const Problem& why) const {
  const auto stamp = calendar_now().time_since_epoch().count();
  log::error("{}; job {} is not used, and its files are renamed to *.damaged-{}; upload it again", why.message, id,
             stamp);
  for (const std::string& path : {file(id, kRecord), bytes_path(id)}) {
    if (::rename(path.c_str(), fmt::format("{}.damaged-{}", path, stamp).c_str()) != 0 && errno != ENOENT) {
      log::error("{}", explain(cannot_write(path).value()));
    }
  }
}

Result<std::uint64_t> Folder::next_id() {
  const std::uint64_t id = last_ + 1;
  if (auto written = replace_synced(path_ + "/last", fmt::format("{}\n", id)); !written) {
    return tl::unexpected(written.error());
  }
  // Syncs the parent of a directory that was just made; otherwise a power cut could remove the directory, and the
  // number with it.
  if (auto synced = sync_directory(fs::path(path_).parent_path().string()); !synced) {
    return tl::unexpected(synced.error());
  }
  last_ = id;
  return id;
}

std::string Folder::next_upload_path() { return fmt::format("{}/{}{}", path_, kUpload, ++uploads_); }

Result<Descriptor> Folder::create(const std::string& upload) const {
  make_state_directory(path_);
  Descriptor file(::open(upload.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode));
  if (!file.valid()) return cannot_write(upload);
  return file;
}

Result<void> Folder::take(const std::string& upload, std::uint64_t id) const {
  const std::string path = bytes_path(id);
  if (::rename(upload.c_str(), path.c_str()) != 0) return cannot_write(path);
  return {};
}

Result<void> Folder::keep(const Job& job) const { return replace_synced(file(job.id, kRecord), record_text(job)); }

Result<std::string> Folder::bytes_of(const Job& job) const {
  std::string bytes;
  const Result<void> same = read_bytes(job, [&bytes](std::string_view piece) { bytes += piece; });
  if (!same) return tl::unexpected(same.error());
  return bytes;
}

Result<void> Folder::read_bytes(const Job& job, const std::function<void(std::string_view)>& take) const {
  const std::string path = bytes_path(job.id);
  const Result<Descriptor> file = open_state_file(path, O_RDONLY);
  if (!file) return tl::unexpected(file.error());
  struct stat status {};
  // Compares the size before reading, because the file may be of any size.
  bool same = file->valid() && ::fstat(file->get(), &status) == 0 && status.st_size == job.bytes;
  if (same) {
    Sha256 digest;
    const auto pass_on = [&](std::string_view piece) {
      digest.add(piece);
      take(piece);
    };
    if (Result<void> read = read_pieces(file->get(), path, pass_on); !read) return read;
    same = digest.hexadecimal() == job.sha256;
  }
  if (same) return {};
  return fail(Reason::internal, fmt::format("{} does not have the bytes that were uploaded", path),
              "upload them again");
}

Result<void> Folder::remove_upload(const std::string& upload) const {
  if (::unlink(upload.c_str()) != 0 && errno != ENOENT) return cannot_write(upload);
  return sync_directory(path_);
}

Result<void> Folder::remove(std::uint64_t id) const {
  // Removes the record first, because bytes without a record are removed at the next start.
  const std::string record = file(id, kRecord);
  for (const std::string& path : {record, record + ".new", bytes_path(id)}) {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) return cannot_write(path);
  }
  return sync_directory(path_);
}

}  // namespace axisgate::server::spool
