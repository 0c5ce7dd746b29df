#include "server/api/mill/job_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "server/access/access.h"
#include "server/api/request/names.h"
#include "server/limits.h"
#include "server/spool/sha256.h"

namespace axisgate::api {

// An Unfinished is a job of which pieces are missing, that is being checked, or that was queued a short time ago. All
// members but `is_queued` are used under its mutex.
struct JobPieces::Unfinished {
  std::mutex mutex{};
  std::string header_digest{};
  std::shared_ptr<JobUpload> upload{};  // null once the last piece was taken
  server::spool::Sha256 bytes_digest{};
  std::uint64_t received = 0;
  std::vector<Answer<PieceTaken>> waiting{};  // for the end of the check; not empty while it runs
  std::optional<CurrentJob> job{};            // set once the job is queued
  std::unique_ptr<server::Timeout> timeout{};
  std::atomic<bool> is_queued = false;

  // Makes the next piece begin at 0.
  void drop() {
    upload = nullptr;
    received = 0;
  }
};

namespace {

Result<void> check_piece(const Call& call, const JobPiece& piece) {
  if (call.request_id.empty()) {
    return fail(Reason::invalid_request, "the header has no request_id",
                "choose one for the job, and send it with each piece");
  }
  if (piece.data.size() <= kPieceBytesMax) return {};
  return fail(Reason::invalid_request, fmt::format("a piece of {} bytes is too large", piece.data.size()),
              fmt::format("send at most {} bytes in one piece", kPieceBytesMax));
}

}  // namespace

// The forgotten job is destroyed without the lock, because its upload may have a file to remove.
void JobPieces::Kept::forget(const Key& key) {
  UnfinishedPtr forgotten;
  const std::lock_guard lock(mutex);
  const auto found = jobs.find(key);
  if (found == jobs.end()) return;
  forgotten = std::move(found->second);
  jobs.erase(found);
}

// Returns null if the daemon has no piece of the job, and this one is not the first.
Result<JobPieces::UnfinishedPtr> JobPieces::find_or_begin(const Key& key, const Call& call, std::string_view device,
                                                          const Result<JobToSend>& job, const JobPiece& piece) const {
  const std::lock_guard lock(kept_->mutex);
  if (const auto found = kept_->jobs.find(key); found != kept_->jobs.end()) return found->second;
  if (piece.offset != 0) return UnfinishedPtr();
  const auto of_caller = std::ranges::count_if(
      kept_->jobs, [&key](const auto& one) { return one.first.first == key.first && !one.second->is_queued; });
  if (static_cast<std::size_t>(of_caller) >= kUnfinishedJobsMax) {
    return fail(Reason::queue_full,
                fmt::format("the caller has begun {} jobs and not sent their last pieces", of_caller),
                "finish one of them, or wait until its pieces are dropped");
  }
  if (!job) return tl::unexpected(job.error());
  Call whole = call;
  whole.deadline.reset();  // it is that of the first piece only
  Result<std::unique_ptr<JobUpload>> upload = sending_.send(whole, device, *job);
  if (!upload) return tl::unexpected(upload.error());
  const auto begun = std::make_shared<Unfinished>();
  begun->header_digest = piece.header_digest;
  begun->upload = *std::move(upload);
  kept_->jobs.emplace(key, begun);
  return begun;
}

void JobPieces::take(const Call& call, std::string_view device, const Result<JobToSend>& job, const JobPiece& piece,
                     Answer<PieceTaken> answer) const {
  if (const Result<void> good = check_piece(call, piece); !good) return answer(tl::unexpected(good.error()));
  const auto admitted = pipeline_.admit({RequestKind::send_job_piece, call, find_mill(gateway_, device)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  const Key key(server::identity_of(admitted->caller.who), call.request_id);
  const Result<UnfinishedPtr> found = find_or_begin(key, call, device, job, piece);
  if (!found) return answer(tl::unexpected(found.error()));
  if (*found == nullptr) return answer(PieceTaken{});
  Unfinished& unfinished = **found;
  std::unique_lock lock(unfinished.mutex);
  if (unfinished.header_digest != piece.header_digest) {
    return answer(fail(Reason::request_id_reused, "the header differs from that of an earlier piece",
                       "send the same header with each piece; another job needs another request_id"));
  }
  unfinished.timeout = gateway_.timeouts().unless_dropped(server::kJobPiecesKept, [all = std::weak_ptr(kept_), key] {
    if (const auto kept = all.lock()) kept->forget(key);
  });
  if (!unfinished.waiting.empty() && piece.last) return unfinished.waiting.push_back(std::move(answer));
  if (unfinished.upload == nullptr || piece.offset != unfinished.received) {
    return answer(PieceTaken{unfinished.received, unfinished.job});
  }
  if (const Result<void> taken = unfinished.upload->append(piece.data); !taken) {
    unfinished.drop();
    lock.unlock();
    kept_->forget(key);
    return answer(tl::unexpected(taken.error()));
  }
  unfinished.bytes_digest.add(piece.data);
  unfinished.received += piece.data.size();
  if (!piece.last) return answer(PieceTaken{unfinished.received});
  unfinished.waiting.push_back(std::move(answer));
  finish(key, *found, piece);
}

// Called under the mutex of the job. The answer of the upload keeps the upload and the job alive.
void JobPieces::finish(const Key& key, const UnfinishedPtr& unfinished, const JobPiece& piece) const {
  const auto upload = std::exchange(unfinished->upload, nullptr);
  upload->finish(piece.digest_of_all(unfinished->bytes_digest.hexadecimal()), [kept = kept_, key, unfinished,
                                                                               upload](const Result<CurrentJob>& job) {
    if (!job) kept->forget(key);
    std::vector<Answer<PieceTaken>> waiting;
    {
      const std::lock_guard lock(unfinished->mutex);
      waiting.swap(unfinished->waiting);
      if (job) unfinished->job = *job;
      if (!job) unfinished->drop();
      unfinished->is_queued = true;
    }
    for (const Answer<PieceTaken>& answer : waiting) {
      answer(job.map([&](const CurrentJob& queued) { return PieceTaken{unfinished->received, queued}; }));
    }
  });
}

}  // namespace axisgate::api
